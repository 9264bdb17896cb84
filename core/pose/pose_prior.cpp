#include "pose/pose_prior.h"

#include <Eigen/Cholesky>
#include <cmath>
#include <numbers>
#include <vector>

#include "base/array_file.h"
#include "base/error.h"
#include "base/sha256.h"

namespace vitruvian {
namespace {

constexpr std::size_t kMostConfigurations = 10000, kMostWidth = 8192, kMostLatent = 1024;
/// Of VPoser's layers (the default of torch.nn.LeakyReLU).
constexpr double kNegativeSlope = 0.01;
/// A rotation vector's angle never exceeds a half turn; f32 rounding aside.
constexpr double kLargestAngle = std::numbers::pi + 1e-3;

class Reader {
 public:
  Reader(std::span<const std::byte> bytes, const std::string& name)
      : file_(bytes, "POSE", name), name_(name) {}

  [[noreturn]] void fail(const std::string& array, const std::string& what) const {
    throw Error(ErrorCode::bad_model,
                name_ + ": array " + array + " " + what +
                    "; the pose prior is damaged or of another version: make it again with "
                    "scripts/models/pose/make_prior.py");
  }

  bool has(const std::string& array) const { return file_.has(array); }
  std::string text(const std::string& array) const { return file_.text(array); }

  /// A rank-2 array (rank 1 as one column).
  Eigen::MatrixXd matrix(const std::string& array, const std::vector<std::size_t>& shape) const {
    const std::vector<float> values = file_.floats(array, shape);
    const Index rows = static_cast<Index>(shape[0]),
                cols = shape.size() > 1 ? static_cast<Index>(shape[1]) : 1;
    using RowMajor = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
    return Eigen::Map<const RowMajor>(values.data(), rows, cols).cast<double>();
  }

  LimbLibrary limb(const std::string& array, int upper_joint, int lower_joint) const {
    const std::vector<std::size_t> shape = file_.shape(array);
    if (shape.size() != 3 || shape[0] < 1 || shape[0] > kMostConfigurations) {
      fail(array, "must have the shape [n,2,3] with n from 1 to " + std::to_string(kMostConfigurations));
    }
    const std::vector<float> values = file_.floats(array, std::vector<std::size_t>{shape[0], 2, 3});
    LimbLibrary library;
    library.upper_joint = upper_joint;
    library.lower_joint = lower_joint;
    library.configurations = Eigen::Map<const Eigen::Matrix<float, 6, Eigen::Dynamic>>(
                                 values.data(), 6, static_cast<Index>(shape[0]))
                                 .cast<double>();
    for (Index i = 0; i < library.configurations.cols(); ++i) {
      const auto pair = library.configurations.col(i);
      if (pair.head<3>().norm() > kLargestAngle || pair.tail<3>().norm() > kLargestAngle) {
        fail(array, "holds a rotation of more than a half turn in row " + std::to_string(i));
      }
    }
    return library;
  }

  /// A layer of `inputs` columns; `outputs` 0 accepts any number up to kMostWidth.
  DenseLayer layer(const std::string& name, std::size_t inputs, std::size_t outputs,
                   double negative_slope) const {
    const std::string array = "vae_" + name + "_weight";
    const std::vector<std::size_t> shape = file_.shape(array);
    if (shape.size() != 2 || shape[0] < 1 || shape[0] > kMostWidth || shape[1] != inputs ||
        (outputs && shape[0] != outputs)) {
      fail(array, "must have the shape [" + (outputs ? std::to_string(outputs) : std::string("n")) + "," +
                      std::to_string(inputs) + "]");
    }
    DenseLayer layer;
    layer.weight = matrix(array, shape);
    layer.bias = matrix("vae_" + name + "_bias", {shape[0]});
    layer.negative_slope = negative_slope;
    return layer;
  }

  PoseVae vae() const {
    constexpr std::size_t kPose = 3 * PoseVae::kJoints;
    const std::vector<std::size_t> code = file_.shape("vae_mean_weight");
    if (code.empty() || code[0] < 1 || code[0] > kMostLatent) {
      fail("vae_mean_weight",
           "must have from 1 to " + std::to_string(kMostLatent) + " rows, the latent numbers");
    }
    PoseVae vae;
    const auto width = [](const DenseLayer& layer) { return static_cast<std::size_t>(layer.weight.rows()); };
    vae.encoder.push_back(layer("encoder_0", kPose, 0, kNegativeSlope));
    vae.encoder.push_back(layer("encoder_1", width(vae.encoder.back()), 0, kNegativeSlope));
    vae.encoder.push_back(layer("mean", width(vae.encoder.back()), code[0], 1));
    vae.decoder.push_back(layer("decoder_0", code[0], 0, kNegativeSlope));
    vae.decoder.push_back(layer("decoder_1", width(vae.decoder.back()), 0, kNegativeSlope));
    vae.decoder.push_back(layer("decoder_2", width(vae.decoder.back()), 6 * PoseVae::kJoints, 1));
    return vae;
  }

 private:
  ArrayFile file_;
  std::string name_;
};

}  // namespace

PosePrior read_pose_prior(std::span<const std::byte> bytes, const std::string& name) {
  const Reader reader(bytes, name);
  PosePrior prior;
  prior.sha256 = to_hex(sha256(bytes));
  prior.mean = reader.matrix("gaussian_mean", {PosePrior::kSize});
  prior.precision = reader.matrix("gaussian_precision", {PosePrior::kSize, PosePrior::kSize});
  const double asymmetry = (prior.precision - prior.precision.transpose()).cwiseAbs().maxCoeff();
  if (asymmetry > 1e-4 * prior.precision.cwiseAbs().maxCoeff()) {
    reader.fail("gaussian_precision", "is not symmetric");
  }
  prior.precision = (0.5 * (prior.precision + prior.precision.transpose())).eval();
  if (prior.precision.llt().info() != Eigen::Success) {
    reader.fail("gaussian_precision", "is not positive definite");
  }
  prior.limit_low = reader.matrix("limit_low", {PosePrior::kSize});
  prior.limit_high = reader.matrix("limit_high", {PosePrior::kSize});
  for (int k = 0; k < PosePrior::kSize; ++k) {
    if (!(prior.limit_low[k] < prior.limit_high[k])) {
      reader.fail("limit_low", "is not below limit_high at number " + std::to_string(k));
    }
  }
  prior.limbs = {reader.limb("limb_left_arm", 16, 18), reader.limb("limb_right_arm", 17, 19),
                 reader.limb("limb_left_leg", 1, 4), reader.limb("limb_right_leg", 2, 5)};
  if (reader.has("vae_mean_weight") || reader.has("vae_decoder_0_weight")) prior.vae = reader.vae();
  prior.metadata = reader.text("metadata");
  return prior;
}

}  // namespace vitruvian
