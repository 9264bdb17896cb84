#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace vitruvian {

/// The number that a whole line of a text pickle says ("12", "-3", "1.5e-3", "inf"); none when it is none.
std::optional<double> parse_text_number(std::string_view line);

/// Content of a Python 2 string literal without its quotes: \n, \\, \', \x41, \101 and so on become bytes;
/// unknown escapes stay.
std::string unescaped_string(std::string_view literal);

/// UTF-8 of Python's raw-unicode-escape: bytes are Latin-1, \uXXXX and \UXXXXXXXX are code points.
std::string unescaped_unicode(std::string_view raw);

/// Appends a code point as UTF-8; what is none is left out.
void append_utf8(std::string& text, std::uint32_t code);

/// The bytes of UTF-8 text whose code points are all below 256, as Python's latin1 encoding gives them; none
/// when the text is no such.
std::optional<std::string> latin1_from_utf8(std::string_view text);

}  // namespace vitruvian
