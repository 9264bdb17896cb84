#pragma once

#include <string>
#include <vector>

namespace vitruvian {

/// A line of a plot. A point that is not finite interrupts it.
struct PlotLine {
  std::string name;
  std::vector<double> y;
};

/// What is plotted: lines over the same places.
struct Plot {
  std::string title, x_name, y_name;
  std::vector<double> x;  ///< ascending
  std::vector<PlotLine> lines;
};

/// An SVG picture of its own colours, sized by the page, with axes, grid and named lines. Empty where nothing
/// finite is to be drawn.
std::string to_svg(const Plot& plot);

}  // namespace vitruvian
