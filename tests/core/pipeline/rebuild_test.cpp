#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <numbers>

#include "base/random.h"
#include "body/forward.h"
#include "core/body/random_model.h"
#include "core/pipeline/sample_registration.h"
#include "io/npz.h"
#include "pipeline/report.h"
#include "pipeline/result_json.h"

namespace vitruvian {
namespace {

/// A rotation whose angle is anything up to and including pi, where axis-angle is at its worst.
Mat3d random_rotation(Random& random) {
  const Vec3d axis = Vec3d(random.normal(), random.normal(), random.normal()).normalized();
  const double angle =
      random.below(4) == 0 ? std::numbers::pi - 1e-7 * random.uniform() : random.uniform(0, 3);
  return Eigen::AngleAxisd(angle, axis).toRotationMatrix();
}

// The contract: the registered mesh follows from registration.json and the model alone, to 0.01 mm.
TEST(Rebuild, MeshFollowsFromTheJsonAlone) {
  for (std::uint32_t seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    const BodyModel body = testing::random_model(seed, 24, 80, 6, 4);
    BodyState state = BodyState::rest(body);
    for (Mat3d& rotation : state.rotation) rotation = random_rotation(random);
    for (Index k = 0; k < state.betas.size(); ++k) state.betas[k] = 2 * random.normal();
    state.translation = Vec3d(random.normal(), random.normal(), random.normal());

    Registration r = sample_registration();
    r.parameters = BodyParameters{state.betas, state.axis_angle(), state.translation};
    const double metres_per_unit = seed % 2 == 0 ? 0.001 : 0.0254;
    r.alignment.body_from_scan.setIdentity();
    r.alignment.body_from_scan.topLeftCorner<3, 3>() = metres_per_unit * random_rotation(random);
    // Scans come from far away: survey coordinates in millimetres.
    r.alignment.body_from_scan.topRightCorner<3, 1>() =
        1e3 * Vec3d(random.normal(), random.normal(), random.normal());
    const Mat4d scan_from_body = r.alignment.body_from_scan.inverse();
    const Points3d posed = posed_vertices<double>(body, state);
    const Points3d registered =
        (scan_from_body.topLeftCorner<3, 3>() * posed).colwise() + scan_from_body.topRightCorner<3, 1>();

    const Registration back =
        parse_registration(registration_json(r, "1", JsonStyle::pretty), "registration.json");
    const Points3d again =
        posed_vertices<double>(body, BodyState::from_axis_angle(back.parameters->pose, back.parameters->betas,
                                                                back.parameters->translation_m));
    const Mat4d inverse = back.alignment.body_from_scan.inverse();
    const Points3d rebuilt =
        (inverse.topLeftCorner<3, 3>() * again).colwise() + inverse.topRightCorner<3, 1>();
    EXPECT_LT(1e3 * metres_per_unit * (rebuilt - registered).colwise().norm().maxCoeff(), 0.01);
  }
}

// With vertex offsets: from registration.json, offsets.npz and the model.
TEST(Rebuild, MeshWithOffsetsFollowsFromJsonAndOffsets) {
  for (std::uint32_t seed = 1; seed <= 10; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    const BodyModel body = testing::random_model(seed, 24, 80, 6, 4);
    const BodyState state = testing::random_state(body, seed);
    Registration r = sample_registration();
    r.parameters = BodyParameters{state.betas, state.axis_angle(), state.translation, kOffsetsFile};
    r.offsets.resize(3, body.vertex_count());
    for (Index i = 0; i < r.offsets.size(); ++i)
      r.offsets.data()[i] = static_cast<float>(0.02 * random.normal());
    const Points3d registered = posed_vertices<double>(body, state, r.offsets);

    const Registration back =
        parse_registration(registration_json(r, "1", JsonStyle::compact), "registration.json");
    EXPECT_EQ(back.parameters->offsets_file, "offsets.npz");
    const std::string file = offsets_npz(r.offsets);
    const NumericArray read =
        NpzFile(std::as_bytes(std::span(std::string_view(file))), "offsets.npz").array("offsets");
    ASSERT_EQ(read.shape, (std::vector<std::size_t>{static_cast<std::size_t>(body.vertex_count()), 3}));
    const Points3f offsets =
        Eigen::Map<const Points3d>(read.values.data(), 3, body.vertex_count()).cast<float>();
    const Points3d rebuilt =
        posed_vertices<double>(body,
                               BodyState::from_axis_angle(back.parameters->pose, back.parameters->betas,
                                                          back.parameters->translation_m),
                               offsets);
    EXPECT_LT(1e3 * (rebuilt - registered).colwise().norm().maxCoeff(), 0.01);
    EXPECT_GT((registered - posed_vertices<double>(body, state)).colwise().norm().mean(), 0.005);
  }
}

}  // namespace
}  // namespace vitruvian
