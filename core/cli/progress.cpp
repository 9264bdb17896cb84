#include "cli/progress.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "cli/paths.h"

namespace vitruvian {
namespace {

struct Stage {
  std::string_view name;
  double begin, end;
};
constexpr std::array<Stage, 9> kStages = {{{"read", 0.0, 0.05},
                                           {"align", 0.05, 0.20},
                                           {"project", 0.20, 0.30},
                                           {"detect", 0.30, 0.60},
                                           {"pose", 0.60, 0.65},
                                           {"fit", 0.65, 0.85},
                                           {"refine", 0.85, 0.95},
                                           {"detail", 0.95, 0.98},
                                           {"write", 0.98, 1.0}}};
constexpr int kBarWidth = 30;

}  // namespace

double overall_fraction(std::string_view stage, double fraction) {
  for (const Stage& candidate : kStages) {
    if (candidate.name != stage) continue;
    const double done = std::isfinite(fraction) ? std::clamp(fraction, 0.0, 1.0) : 0.0;
    return candidate.begin + (candidate.end - candidate.begin) * done;
  }
  return 0;
}

void Progress::begin_scan(int number, const std::string& name) {
  title_ = printable(name);
  if (scans_ > 1) title_ = "[" + std::to_string(number) + "/" + std::to_string(scans_) + "] " + title_;
  stage_.clear();
  percent_ = -1;
}

void Progress::update(std::string_view stage, double fraction) {
  const int percent = std::max(percent_, static_cast<int>(100 * overall_fraction(stage, fraction)));
  if (style_ == ProgressStyle::bar && (percent != percent_ || stage != stage_)) draw(percent, stage);
  if (style_ == ProgressStyle::lines && stage != stage_) stream_ << title_ << ": " << stage << std::endl;
  percent_ = percent;
  stage_ = stage;
}

void Progress::draw(int percent, std::string_view stage) {
  const int filled = kBarWidth * percent / 100;
  stream_ << "\r\x1b[K" << title_ << " [" << std::string(static_cast<std::size_t>(filled), '#')
          << std::string(static_cast<std::size_t>(kBarWidth - filled), '.') << "] " << percent << " % "
          << stage << std::flush;
}

void Progress::end_scan(const std::string& line) {
  if (style_ == ProgressStyle::none) return;
  if (style_ == ProgressStyle::bar) stream_ << "\r\x1b[K";
  stream_ << title_ << ": " << line << std::endl;
}

}  // namespace vitruvian
