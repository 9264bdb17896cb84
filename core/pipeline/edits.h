#pragma once

#include <map>
#include <string>
#include <vector>

#include "base/types.h"

namespace vitruvian {

/// Frame of contract.md ("Frames and units") that positions are given in.
enum class KeypointFrame { scan, body, canonical };

/// Joints placed by hand or exported: keypoints JSON of contract.md.
struct KeypointSet {
  struct Joint {
    Vec3d position = Vec3d::Zero();  ///< scan units in the scan frame, else metres
    double confidence = 1;           ///< 0..1
    bool operator==(const Joint&) const = default;
  };
  KeypointFrame frame = KeypointFrame::scan;
  std::map<std::string, Joint> joints;  ///< by SMPL name; a joint that is missing is not used
  bool operator==(const KeypointSet&) const = default;
};

/// Parameters of a body, body frame.
struct BodyParameters {
  Eigen::VectorXd betas;
  Points3d pose;  ///< 3 x J axis-angle, root first
  Vec3d translation_m = Vec3d::Zero();
  std::string offsets_file{};    ///< file beside registration.json that holds the vertex offsets; empty: none
  Eigen::VectorXd expression{};  ///< empty for models without a face
  Eigen::VectorXd dmpl{};        ///< soft tissue; empty without --dmpl
  bool operator==(const BodyParameters& other) const {
    return betas.size() == other.betas.size() && pose.cols() == other.pose.cols() && betas == other.betas &&
           expression.size() == other.expression.size() && expression == other.expression &&
           dmpl.size() == other.dmpl.size() && dmpl == other.dmpl && pose == other.pose &&
           translation_m == other.translation_m && offsets_file == other.offsets_file;
  }
};

/// The body of an earlier registration, to start a fit from.
struct StartBody {
  BodyParameters parameters;
  std::string model_sha256;  ///< of the model that it was fitted with
  bool operator==(const StartBody&) const = default;
};

/// Pairs of regions that belong together: regions JSON of contract.md.
struct RegionSet {
  struct Pair {
    std::string name;
    std::vector<int> scan_vertices;  ///< in file order, before any merging
    std::vector<int> template_vertices;
    bool operator==(const Pair&) const = default;
  };
  std::string scan_sha256, model_sha256;
  std::vector<Pair> pairs;
  bool operator==(const RegionSet&) const = default;
};

}  // namespace vitruvian
