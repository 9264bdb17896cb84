#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace vitruvian {

/// A reading position in a text file held in memory. Blanks are space, tab and carriage return; lines end
/// with \n (or with \r in files that have no \n at all). Line numbers are counted only when one is asked for.
class TextCursor {
 public:
  explicit TextCursor(std::span<const std::byte> bytes);
  explicit TextCursor(std::string_view text)
      : TextCursor(std::as_bytes(std::span(text.data(), text.size()))) {}

  bool at_end() const { return position_ == end_; }
  /// True at a line's end or the text's.
  bool at_line_end() const { return position_ == end_ || *position_ == line_end_; }
  void skip_blanks() {
    while (position_ != end_ && is_blank(*position_)) ++position_;
  }
  /// Skips blanks and line ends.
  void skip_space() {
    while (position_ != end_ && (is_blank(*position_) || *position_ == line_end_)) ++position_;
  }
  /// Goes to the first character of the next line.
  void skip_line();
  /// The rest of the line, blanks at both ends removed; goes to the next line.
  std::string_view take_line();
  /// The next run of characters that are neither blank nor line end; empty at the line's end. Skips blanks
  /// first.
  std::string_view take_word();
  /// The next number of the line; none (and the position unchanged but for blanks) if there is none. Reads
  /// nan and inf in the spellings of common C libraries. A number must be followed by a blank, a line end or
  /// `also_ends`.
  std::optional<double> take_number(char also_ends = '\0');
  /// The next decimal integer; it may be followed by anything. None if there is none or it has more than 18
  /// digits.
  std::optional<std::int64_t> take_integer();
  /// The character here, 0 at the end of the text.
  char peek() const { return position_ == end_ ? '\0' : *position_; }
  void advance() { ++position_; }

  const char* position() const { return position_; }
  void set_position(const char* position) { position_ = position; }
  std::size_t remaining() const { return static_cast<std::size_t>(end_ - position_); }
  std::size_t offset() const { return static_cast<std::size_t>(position_ - begin_); }
  /// 1 for the first line.
  std::size_t line_number() const;
  /// "line 12: what (here: 'text')" for an error at the position.
  std::string describe(const std::string& what) const;

 private:
  bool is_blank(char c) const {
    return c == ' ' || c == '\t' || (c == '\r' && line_end_ != '\r') || c == '\v' || c == '\f';
  }

  const char* begin_;
  const char* position_;
  const char* end_;
  char line_end_;
};

/// ASCII letters in lower case.
std::string lower_case(std::string_view text);

}  // namespace vitruvian
