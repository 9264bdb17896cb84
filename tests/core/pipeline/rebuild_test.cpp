#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <numbers>

#include "base/random.h"
#include "body/forward.h"
#include "core/body/random_model.h"
#include "core/pipeline/sample_registration.h"
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

}  // namespace
}  // namespace vitruvian
