#pragma once

#include <string>
#include <vector>

namespace vitruvian {

/// Text table with columns as wide as their widest cell: the first row is the heading, the first and the last
/// column are set to the left, the others to the right. Widths count UTF-8 characters.
std::string text_table(const std::vector<std::vector<std::string>>& rows);

}  // namespace vitruvian
