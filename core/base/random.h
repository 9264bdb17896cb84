#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>

namespace vitruvian {

/// Random numbers that are the same with every standard library: mt19937 is specified exactly, the standard
/// distributions are not, so these are our own.
class Random {
 public:
  explicit Random(std::uint32_t seed) : engine_(seed) {}

  /// Uniform in [0, 1), 53 random bits.
  double uniform() {
    const std::uint64_t high = engine_() >> 5, low = engine_() >> 6;
    return static_cast<double>(high * 67108864u + low) / 9007199254740992.0;
  }
  double uniform(double low, double high) { return low + (high - low) * uniform(); }
  /// Uniform integer in [0, count); count > 0.
  std::uint32_t below(std::uint32_t count) { return static_cast<std::uint32_t>(uniform() * count); }
  /// Standard normal (Box-Muller; one draw a call, the second value is dropped to keep the stream simple).
  double normal() {
    const double u = 1.0 - uniform(), v = uniform();
    return std::sqrt(-2.0 * std::log(u)) * std::cos(2.0 * std::numbers::pi * v);
  }

 private:
  std::mt19937 engine_;
};

}  // namespace vitruvian
