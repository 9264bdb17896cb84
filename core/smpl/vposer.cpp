#include "smpl/vposer.h"

#include <cmath>

#include "base/error.h"
#include "smpl/torch_archive.h"

namespace vitruvian {
namespace {

constexpr double kNegativeSlope = 0.01;     // torch.nn.LeakyReLU
constexpr double kBatchNormEpsilon = 1e-5;  // torch.nn.BatchNorm1d
constexpr Index kPoseNumbers = 3 * PoseVae::kJoints;
constexpr std::size_t kMostWidth = 8192;

/// Affine map of single numbers: y = scale x + shift.
struct Affine {
  Eigen::VectorXd scale, shift;
};

class Reader {
 public:
  Reader(std::span<const std::byte> bytes, const std::string& file_name)
      : archive_(bytes, file_name), file_name_(file_name), state_(archive_.root()) {
    if (const auto inner = state_.find("state_dict")) state_ = *inner;
    for (const char* prefix : {"", "vp_model.", "module.", "model."}) {
      if (!state_.find(std::string(prefix) + "decoder_net.0.weight")) continue;
      prefix_ = prefix;
      return;
    }
    throw Error(ErrorCode::bad_model,
                file_name + ": has no decoder_net.0.weight: it is no checkpoint of VPoser version 2");
  }

  /// encoder: BatchNorm, Linear, LeakyReLU, BatchNorm, Linear, Linear, mean; decoder: Linear, LeakyReLU,
  /// Linear, LeakyReLU, Linear. Dropout does nothing after training.
  PoseVae read() const {
    PoseVae vae;
    const DenseLayer code = linear("encoder_net.8.mu", 0, 1);
    const Index latent = code.weight.rows();
    vae.encoder.push_back(after(batch_norm("encoder_net.1", kPoseNumbers),
                                linear("encoder_net.2", kPoseNumbers, kNegativeSlope)));
    Index width = vae.encoder.back().weight.rows();
    vae.encoder.push_back(after(batch_norm("encoder_net.4", width), linear("encoder_net.6", width, 1)));
    vae.encoder.push_back(linear("encoder_net.7", vae.encoder.back().weight.rows(), 1));
    vae.encoder.push_back(linear("encoder_net.8.mu", vae.encoder.back().weight.rows(), 1));
    vae.decoder.push_back(linear("decoder_net.0", latent, kNegativeSlope));
    vae.decoder.push_back(linear("decoder_net.3", vae.decoder.back().weight.rows(), kNegativeSlope));
    vae.decoder.push_back(linear("decoder_net.5", vae.decoder.back().weight.rows(), 1));
    if (vae.decoder.back().weight.rows() != 6 * PoseVae::kJoints)
      fail("decoder_net.5.weight", "must have " + std::to_string(6 * PoseVae::kJoints) + " rows");
    return vae;
  }

 private:
  [[noreturn]] void fail(const std::string& name, const std::string& what) const {
    throw Error(ErrorCode::bad_model, file_name_ + ": " + name + ": " + what);
  }

  NumericArray tensor(const std::string& name) const {
    const auto found = state_.find(prefix_ + name);
    if (!found) fail(name, "is missing: it is no checkpoint of VPoser version 2");
    NumericArray array = archive_.tensor(*found, name);
    for (const double value : array.values) {
      if (!std::isfinite(value)) fail(name, "holds a value that is not finite");
    }
    return array;
  }

  Eigen::VectorXd vector(const std::string& name, Index size) const {
    const NumericArray array = tensor(name);
    if (static_cast<Index>(array.values.size()) != size || array.shape.size() != 1)
      fail(name, "must have " + std::to_string(size) + " numbers");
    return Eigen::Map<const Eigen::VectorXd>(array.values.data(), size);
  }

  /// @param inputs  0: any number.
  DenseLayer linear(const std::string& name, Index inputs, double slope) const {
    const NumericArray array = tensor(name + ".weight");
    if (array.shape.size() != 2 || array.shape[0] < 1 || array.shape[0] > kMostWidth || array.shape[1] < 1 ||
        array.shape[1] > kMostWidth || (inputs > 0 && static_cast<Index>(array.shape[1]) != inputs)) {
      fail(name + ".weight", "does not fit the layer before it");
    }
    using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
    DenseLayer layer;
    layer.weight = Eigen::Map<const RowMajor>(array.values.data(), static_cast<Index>(array.shape[0]),
                                              static_cast<Index>(array.shape[1]));
    layer.bias = vector(name + ".bias", layer.weight.rows());
    layer.negative_slope = slope;
    return layer;
  }

  Affine batch_norm(const std::string& name, Index size) const {
    const Eigen::VectorXd mean = vector(name + ".running_mean", size);
    const Eigen::VectorXd variance = vector(name + ".running_var", size);
    if (!(variance.minCoeff() >= 0)) fail(name + ".running_var", "holds a negative variance");
    Affine affine;
    affine.scale = vector(name + ".weight", size).array() / (variance.array() + kBatchNormEpsilon).sqrt();
    affine.shift = vector(name + ".bias", size) - affine.scale.cwiseProduct(mean);
    return affine;
  }

  static DenseLayer after(const Affine& first, DenseLayer layer) {
    layer.bias += layer.weight * first.shift;
    layer.weight = (layer.weight * first.scale.asDiagonal()).eval();
    return layer;
  }

  TorchArchive archive_;
  std::string file_name_;
  PickleValue state_;
  std::string prefix_;
};

}  // namespace

PoseVae read_vposer(std::span<const std::byte> bytes, const std::string& file_name) {
  return Reader(bytes, file_name).read();
}

}  // namespace vitruvian
