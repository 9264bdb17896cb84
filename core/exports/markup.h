#pragma once

#include <string>
#include <string_view>

namespace vitruvian {

/// Text as HTML and SVG want it, in elements and in attributes.
std::string escaped(std::string_view text);

/// A number with a point whatever the locale, `decimals` after it.
std::string fixed_text(double value, int decimals);

}  // namespace vitruvian
