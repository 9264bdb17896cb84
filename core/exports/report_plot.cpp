#include "exports/report_plot.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "exports/markup.h"

namespace vitruvian {
namespace {

constexpr double kWidth = 360, kHeight = 220, kLeft = 44, kRight = 10, kTop = 24, kBottom = 34;
constexpr int kTicks = 5;
/// Told apart in grey print too, by their dashes.
constexpr std::array<const char*, 4> kColours = {"#c2185b", "#1565c0", "#2e7d32", "#6a1b9a"};
constexpr std::array<const char*, 4> kDashes = {"", "6 3", "2 3", "8 3 2 3"};

struct Range {
  double low = std::numeric_limits<double>::infinity(), high = -std::numeric_limits<double>::infinity();

  void add(double value) {
    if (!std::isfinite(value)) return;
    low = std::min(low, value);
    high = std::max(high, value);
  }
  bool empty() const { return !(low <= high); }
};

/// 1, 2 or 5 times a power of ten, such that about kTicks of them span the range.
double tick_step(const Range& range) {
  const double rough = std::max(1e-9, (range.high - range.low) / kTicks);
  const double power = std::pow(10, std::floor(std::log10(rough)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * power >= rough) return factor * power;
  }
  return 10 * power;
}

class Drawing {
 public:
  Drawing(const Plot& plot, Range x, Range y) : plot_(plot), x_(x), y_(y) {
    if (x_.high - x_.low < 1e-9) x_.high = x_.low + 1;
    y_.low = std::min(0.0, y_.low);  // lengths: bars of comparison begin at nothing
    if (y_.high - y_.low < 1e-9) y_.high = y_.low + 1;
  }

  std::string svg() const {
    std::string out = "<svg class=\"plot\" viewBox=\"0 0 " + fixed_text(kWidth, 0) + " " +
                      fixed_text(kHeight, 0) + "\" role=\"img\" aria-label=\"" + escaped(plot_.title) +
                      "\"><text x=\"" + fixed_text(kLeft, 0) + "\" y=\"12\" class=\"t\">" +
                      escaped(plot_.title) + "</text>";
    out += grid();
    for (std::size_t i = 0; i < plot_.lines.size(); ++i) out += line(i);
    return out + "</svg>";
  }

 private:
  double across(double x) const {
    return kLeft + (x - x_.low) / (x_.high - x_.low) * (kWidth - kLeft - kRight);
  }
  double down(double y) const {
    return kHeight - kBottom - (y - y_.low) / (y_.high - y_.low) * (kHeight - kTop - kBottom);
  }
  static std::string text(double x, double y, const char* anchor, const std::string& words) {
    return "<text x=\"" + fixed_text(x, 1) + "\" y=\"" + fixed_text(y, 1) + "\" text-anchor=\"" + anchor +
           "\">" + escaped(words) + "</text>";
  }

  std::string grid() const {
    std::string out = "<g class=\"grid\">";
    std::string labels;
    const double bottom = down(y_.low), right = kWidth - kRight;
    for (double y = std::ceil(y_.low / tick_step(y_)) * tick_step(y_); y <= y_.high; y += tick_step(y_)) {
      const std::string at = fixed_text(down(y), 1);
      out += "<path d=\"M" + fixed_text(kLeft, 1) + " " + at + "H" + fixed_text(right, 1) + "\"/>";
      labels += text(kLeft - 4, down(y) + 3, "end", fixed_text(y, 0));
    }
    for (double x = std::ceil(x_.low / tick_step(x_)) * tick_step(x_); x <= x_.high; x += tick_step(x_)) {
      out += "<path d=\"M" + fixed_text(across(x), 1) + " " + fixed_text(kTop, 1) + "V" +
             fixed_text(bottom, 1) + "\"/>";
      labels += text(across(x), bottom + 12, "middle", fixed_text(x, 0));
    }
    labels += text(right, kHeight - 6, "end", plot_.x_name);
    labels += text(right, 12, "end", plot_.y_name);
    return out + "</g>" + labels;
  }

  /// The line, and its name in a legend below the plot.
  std::string line(std::size_t i) const {
    const PlotLine& one = plot_.lines[i];
    const std::string style = std::string("fill=\"none\" stroke=\"") + kColours[i % kColours.size()] +
                              "\" stroke-width=\"1.6\" stroke-dasharray=\"" + kDashes[i % kDashes.size()] +
                              "\"";
    std::string d;
    bool down_pen = false;
    for (std::size_t k = 0; k < one.y.size() && k < plot_.x.size(); ++k) {
      if (!std::isfinite(one.y[k]) || !std::isfinite(plot_.x[k])) {
        down_pen = false;
        continue;
      }
      d += (down_pen ? "L" : "M") + fixed_text(across(plot_.x[k]), 1) + " " + fixed_text(down(one.y[k]), 1);
      down_pen = true;
    }
    const double at = kLeft + 58 * static_cast<double>(i), level = kHeight - 9;
    return "<path d=\"" + d + "\" " + style + "/><path d=\"M" + fixed_text(at, 1) + " " +
           fixed_text(level, 1) + "h18\" " + style + "/>" + text(at + 22, level + 3, "start", one.name);
  }

  const Plot& plot_;
  Range x_, y_;
};

}  // namespace

std::string to_svg(const Plot& plot) {
  Range x, y;
  for (const double value : plot.x) x.add(value);
  for (const PlotLine& line : plot.lines) {
    for (const double value : line.y) y.add(value);
  }
  if (x.empty() || y.empty()) return "";
  return Drawing(plot, x, y).svg();
}

}  // namespace vitruvian
