#include "cli/table.h"

#include <algorithm>
#include <cstddef>

namespace vitruvian {
namespace {

std::size_t characters(const std::string& text) {
  return static_cast<std::size_t>(std::count_if(
      text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xc0) != 0x80; }));
}

}  // namespace

std::string text_table(const std::vector<std::vector<std::string>>& rows) {
  std::vector<std::size_t> widths;
  for (const std::vector<std::string>& row : rows) {
    widths.resize(std::max(widths.size(), row.size()));
    for (std::size_t c = 0; c < row.size(); ++c) widths[c] = std::max(widths[c], characters(row[c]));
  }
  std::string out;
  for (const std::vector<std::string>& row : rows) {
    for (std::size_t c = 0; c < row.size(); ++c) {
      const std::string padding(widths[c] - characters(row[c]), ' ');
      const bool last = c + 1 == row.size();
      if (c > 0) out += "  ";
      if (c == 0)
        out += row[c] + padding;
      else if (last)
        out += row[c];
      else
        out += padding + row[c];
    }
    out += "\n";
  }
  return out;
}

}  // namespace vitruvian
