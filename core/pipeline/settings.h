#pragma once

#include <cstdint>
#include <string>

#include "body/model.h"

namespace vitruvian {

enum class Method { ours, paper, paper_cpu };
enum class AlignMode { automatic, pca };
enum class InitMode { automatic, keypoints, tpose };
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
  Gender gender = Gender::neutral;
  int betas = 0;  ///< number of shape components used; 0 = all of the model's
  Unit unit = Unit::automatic;
  Axis up = Axis::automatic;
  Axis front = Axis::automatic;
  DetailMode detail = DetailMode::off;
  int threads = 0;  ///< 0 = as many as the machine has
  std::uint32_t seed = 1;

  bool operator==(const Settings&) const = default;
};

std::string to_string(Method value);
std::string to_string(AlignMode value);
std::string to_string(InitMode value);
std::string to_string(SolverKind value);
std::string to_string(DetailMode value);
std::string to_string(Unit value);  ///< "auto", "m", "cm", "mm", "in"
std::string to_string(Axis value);  ///< "auto", "x", "-x" ...
double metres_per_unit(Unit unit);  ///< of a fixed unit

}  // namespace vitruvian
