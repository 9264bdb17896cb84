#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "body/model.h"
#include "geometry/cut_volume.h"
#include "pipeline/edits.h"

namespace vitruvian {

enum class Method { ours, paper, paper_cpu };
enum class AlignMode { automatic, pca };
/// Where the fit starts. `file`: at the body of an earlier registration, Settings::start.
enum class InitMode { automatic, keypoints, tpose, file };
enum class SolverKind { fast, paper };
enum class DetailMode { off, vertex };
enum class Unit { automatic, metre, centimetre, millimetre, inch };
/// Signed axis of the scan file.
enum class Axis { automatic, x, y, z, minus_x, minus_y, minus_z };

/// Everything that decides a registration besides the scan and the models; written to registration.json so
/// that it can be run again.
struct Settings {
  Method method = Method::ours;
  AlignMode align = AlignMode::automatic;
  int views = 8;  ///< 2 as published, or 8
  double min_visibility = 0.0;
  InitMode init = InitMode::automatic;
  SolverKind solver = SolverKind::fast;
  int iterations = 6000;         ///< paper solver: of each stage
  int adam_iterations = 6000;    ///< paper solver: of these by Adam, the rest by L-BFGS
  bool one_directional = false;  ///< paper solver: distances from template to scan only
  int chunk = 0;                 ///< paper solver: points a side of a block of distances; 0: kd-trees
  Gender gender = Gender::neutral;
  int betas = 0;  ///< number of shape components used; 0 = all of the model's
  Unit unit = Unit::automatic;
  Axis up = Axis::automatic;
  Axis front = Axis::automatic;
  DetailMode detail = DetailMode::off;
  int threads = 0;  ///< 0 = as many as the machine has
  std::uint32_t seed = 1;
  std::optional<Mat4d> body_from_scan;   ///< given instead of found; unit factor included
  std::optional<KeypointSet> keypoints;  ///< given instead of detected
  std::optional<StartBody> start;        ///< with InitMode::file
  std::vector<CutVolume> crops;          ///< cut away from the scan before anything else
  std::optional<RegionSet> regions;      ///< pairs that are matched with each other only

  bool operator==(const Settings&) const = default;
};

/// Section 3.1.3's threshold, for which the paper gives no number: half of the least combined visibility that
/// a landmark of the default body's rest pose has in the two views (0.50, a hand that one view hides).
constexpr double kPaperMinVisibility = 0.25;

/// The settings that a method stands for; single stages are overridden in them.
Settings settings_of(Method method);

std::string to_string(Method value);
std::string to_string(AlignMode value);
std::string to_string(InitMode value);
std::string to_string(SolverKind value);
std::string to_string(DetailMode value);
std::string to_string(Unit value);  ///< "auto", "m", "cm", "mm", "in"
std::string to_string(Axis value);  ///< "auto", "x", "-x" ...
double metres_per_unit(Unit unit);  ///< of a fixed unit

}  // namespace vitruvian
