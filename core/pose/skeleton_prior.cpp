#include "pose/skeleton_prior.h"

#include <Eigen/LU>
#include <algorithm>
#include <string_view>

namespace vitruvian {
namespace {

constexpr int kBodyNumbers = 63;  // joints 1..21
constexpr int kHandNumbers = 45;
// rad, standard deviations; limits lie three of them and a little from the mean
constexpr double kStiffFinger = 0.05, kBesidesComponents = 0.02, kJaw = 0.1, kEye = 0.1, kSlack = 0.1;

/// Index of the first joint of that name; -1 when there is none.
int joint_named(const BodyModel& body, std::string_view name) {
  const auto found = std::find(body.joint_names.begin(), body.joint_names.end(), name);
  return found == body.joint_names.end() ? -1 : static_cast<int>(found - body.joint_names.begin());
}

}  // namespace

PosePrior prior_for_skeleton(const PosePrior& prior, const BodyModel& body) {
  const int size = 3 * (body.joint_count() - 1);
  if (size == prior.mean.size() || size < kBodyNumbers) return prior;
  PosePrior result = prior;
  result.mean = Eigen::VectorXd::Zero(size);
  result.mean.head(kBodyNumbers) = prior.mean.head(kBodyNumbers);
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(size, size);
  covariance.topLeftCorner(kBodyNumbers, kBodyNumbers) =
      Eigen::MatrixXd(prior.precision.inverse()).topLeftCorner(kBodyNumbers, kBodyNumbers);
  for (int i = kBodyNumbers; i < size; ++i) {
    const std::string& name = body.joint_names[1 + i / 3];
    const double deviation = name == "jaw"                            ? kJaw
                             : name.find("_eye") != std::string::npos ? kEye
                                                                      : kStiffFinger;
    covariance(i, i) = deviation * deviation;
  }
  for (int side = 0; side < 2; ++side) {
    const HandPoses& hand = body.hands[side];
    const int first = joint_named(body, side == 0 ? "left_index1" : "right_index1");
    const int begin = 3 * (first - 1);
    if (hand.mean.size() != kHandNumbers || first < 1 || begin + kHandNumbers > size) continue;
    result.mean.segment(begin, kHandNumbers) = hand.mean;
    const Eigen::MatrixXd spread = hand.components * hand.deviation.asDiagonal();
    covariance.block(begin, begin, kHandNumbers, kHandNumbers) =
        spread * spread.transpose() +
        kBesidesComponents * kBesidesComponents * Eigen::MatrixXd::Identity(kHandNumbers, kHandNumbers);
  }
  // Body and hands are independent here, so their blocks are inverted one by one.
  result.precision = Eigen::MatrixXd::Zero(size, size);
  result.precision.topLeftCorner(kBodyNumbers, kBodyNumbers) =
      covariance.topLeftCorner(kBodyNumbers, kBodyNumbers).inverse();
  const int rest = size - kBodyNumbers;
  const Eigen::MatrixXd others = covariance.bottomRightCorner(rest, rest).inverse();
  result.precision.bottomRightCorner(rest, rest) = 0.5 * (others + others.transpose());

  result.limit_low.resize(size);
  result.limit_high.resize(size);
  for (int i = 0; i < size; ++i) {
    const double reach = 3 * std::sqrt(covariance(i, i)) + kSlack;
    result.limit_low[i] = i < kBodyNumbers ? prior.limit_low[i] : result.mean[i] - reach;
    result.limit_high[i] = i < kBodyNumbers ? prior.limit_high[i] : result.mean[i] + reach;
  }
  return result;
}

}  // namespace vitruvian
