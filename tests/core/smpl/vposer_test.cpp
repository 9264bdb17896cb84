#include "smpl/vposer.h"

#include <Eigen/Geometry>

#include "core/smpl/smpl_fixtures.h"

namespace vitruvian {
namespace {

using testing::as_vector;
using testing::smpl_file;

TEST(Vposer, DecodesAndEncodesAsPublished) {
  const FileBytes file(smpl_file("V02_05_epoch=08.ckpt")), known(smpl_file("vposer.expected.npz"));
  const PoseVae vae = read_vposer(file.bytes(), "vposer.ckpt");
  EXPECT_EQ(vae.latent_count(), 32);
  const NpzFile expected(known.bytes(), "expected");
  const Eigen::VectorXd z = as_vector(expected.array("z")), flat = as_vector(expected.array("rotations"));
  const DecodedPose decoded(vae, z);
  for (int j = 0; j < PoseVae::kJoints; ++j) {
    const Mat3d rotation =
        Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(flat.data() + 9 * j);
    EXPECT_LT((decoded.rotations()[j] - rotation).cwiseAbs().maxCoeff(), 1e-6) << "joint " << j;
  }
  const Eigen::VectorXd code = encode(vae, as_vector(expected.array("pose")));
  EXPECT_LT((code - as_vector(expected.array("code"))).cwiseAbs().maxCoeff(), 1e-5);
}

TEST(Vposer, OtherFilesAreRefusedByName) {
  const auto error_of = [](const std::string& name) {
    const FileBytes file(smpl_file(name));
    try {
      read_vposer(file.bytes(), name);
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find(name), std::string::npos) << error.what();
      return error.code();
    }
    ADD_FAILURE() << name;
    return ErrorCode::internal;
  };
  EXPECT_EQ(error_of("protocol2.pkl"), ErrorCode::unsupported_format);
  EXPECT_EQ(error_of("dmpl.npz"), ErrorCode::bad_file);
  const FileBytes whole(smpl_file("V02_05_epoch=08.ckpt"));
  for (std::size_t share = 0; share < 20; ++share)
    EXPECT_THROW(read_vposer(whole.bytes().first(whole.bytes().size() * share / 20), "cut.ckpt"), Error);
}

}  // namespace
}  // namespace vitruvian
