#pragma once

#include <ostream>
#include <string>
#include <string_view>

namespace vitruvian {

enum class ProgressStyle {
  none,
  lines,  ///< a line when a stage begins; for files and pipes
  bar,    ///< one line drawn over again; for terminals
};

/// Shows how far the registration of a list of scans has come.
class Progress {
 public:
  Progress(std::ostream& stream, ProgressStyle style, int scans)
      : stream_(stream), style_(style), scans_(scans) {}

  /// @param number  of the scan, from 1.
  void begin_scan(int number, const std::string& name);
  /// A stage of registration.json's `timing_ms` has come to `fraction` (0..1). The bar never runs backward,
  /// though stages may repeat.
  void update(std::string_view stage, double fraction);
  /// Clears the bar and prints a line about the scan.
  void end_scan(const std::string& line);

 private:
  void draw(int percent, std::string_view stage);

  std::ostream& stream_;
  ProgressStyle style_;
  int scans_;
  std::string title_;
  std::string stage_;
  int percent_ = -1;
};

/// Share of a registration's usual time that has passed when `fraction` of `stage` is done; unknown stages
/// give 0.
double overall_fraction(std::string_view stage, double fraction);

}  // namespace vitruvian
