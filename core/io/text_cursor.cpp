#include "io/text_cursor.h"

#include <fast_float/fast_float.h>

#include <algorithm>
#include <cstring>
#include <limits>

namespace vitruvian {

TextCursor::TextCursor(std::span<const std::byte> bytes)
    : begin_(reinterpret_cast<const char*>(bytes.data())), position_(begin_), end_(begin_ + bytes.size()) {
  const bool has_line_feed = !bytes.empty() && std::memchr(begin_, '\n', bytes.size()) != nullptr;
  line_end_ = has_line_feed ? '\n' : '\r';
  // A byte order mark, as some editors put in front of UTF-8.
  if (bytes.size() >= 3 && std::memcmp(begin_, "\xef\xbb\xbf", 3) == 0) position_ += 3;
}

void TextCursor::skip_line() {
  if (at_end()) return;
  const void* found = std::memchr(position_, line_end_, remaining());
  position_ = found ? static_cast<const char*>(found) + 1 : end_;
}

std::string_view TextCursor::take_line() {
  skip_blanks();
  const char* first = position_;
  skip_line();
  const char* last = position_;
  while (last != first && (is_blank(last[-1]) || last[-1] == line_end_)) --last;
  return {first, static_cast<std::size_t>(last - first)};
}

std::string_view TextCursor::take_word() {
  skip_blanks();
  const char* first = position_;
  while (!at_line_end() && !is_blank(*position_)) ++position_;
  return {first, static_cast<std::size_t>(position_ - first)};
}

std::optional<double> TextCursor::take_number(char also_ends) {
  skip_blanks();
  const char* first = position_;
  if (first != end_ && *first == '+') ++first;
  double value = 0;
  auto [after, error] = fast_float::from_chars(first, end_, value);
  if (error != std::errc()) return std::nullopt;
  if (after != end_ && !is_blank(*after) && *after != line_end_ && !(also_ends && *after == also_ends)) {
    // Microsoft's C library writes 1.#QNAN, -1.#IND and 1.#INF; glibc's -nan(0x...) is read above up to the
    // bracket.
    const char* word_end = after;
    while (word_end != end_ && !is_blank(*word_end) && *word_end != line_end_ && *word_end != also_ends)
      ++word_end;
    if (*after != '#' && !(*after == '(' && value != value)) return std::nullopt;
    value = std::numeric_limits<double>::quiet_NaN();
    after = word_end;
  }
  position_ = after;
  return value;
}

std::optional<std::int64_t> TextCursor::take_integer() {
  skip_blanks();
  const char* p = position_;
  const bool negative = p != end_ && *p == '-';
  if (p != end_ && (*p == '-' || *p == '+')) ++p;
  const char* digits = p;
  std::int64_t value = 0;
  for (; p != end_ && *p >= '0' && *p <= '9'; ++p) {
    if (p - digits >= 18) return std::nullopt;
    value = 10 * value + (*p - '0');
  }
  if (p == digits) return std::nullopt;
  position_ = p;
  return negative ? -value : value;
}

std::size_t TextCursor::line_number() const {
  return 1 + static_cast<std::size_t>(std::count(begin_, position_, line_end_));
}

std::string TextCursor::describe(const std::string& what) const {
  std::string text = "line " + std::to_string(line_number()) + ": " + what;
  if (at_end()) return text + " (the file ends here)";
  std::string excerpt;
  for (const char* p = position_; p != end_ && *p != line_end_ && excerpt.size() < 40; ++p) {
    excerpt += *p >= ' ' && *p < 127 ? *p : '?';
  }
  return excerpt.empty() ? text + " (the line ends here)" : text + " (here: '" + excerpt + "')";
}

std::string lower_case(std::string_view text) {
  std::string result(text);
  for (char& c : result) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return result;
}

}  // namespace vitruvian
