#include "io/pickle_text.h"

#include <fast_float/fast_float.h>

#include <cstdint>
#include <system_error>

namespace vitruvian {
namespace {

int hexadecimal(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

/// The number of exactly `digits` hexadecimal digits at `position`.
std::optional<std::uint32_t> hexadecimal_at(std::string_view text, std::size_t position, std::size_t digits) {
  if (position > text.size() || text.size() - position < digits) return std::nullopt;
  std::uint32_t value = 0;
  for (std::size_t k = 0; k < digits; ++k) {
    const int digit = hexadecimal(text[position + k]);
    if (digit < 0) return std::nullopt;
    value = 16 * value + static_cast<std::uint32_t>(digit);
  }
  return value;
}

}  // namespace

std::optional<double> parse_text_number(std::string_view line) {
  while (!line.empty() && (line.back() == '\r' || line.back() == ' ')) line.remove_suffix(1);
  double value = 0;
  const auto [end, error] = fast_float::from_chars(line.data(), line.data() + line.size(), value);
  if (end != line.data() + line.size() || line.empty()) return std::nullopt;
  // Numbers too large for a double are read as infinity, as Python's float() does.
  if (error != std::errc() && error != std::errc::result_out_of_range) return std::nullopt;
  return value;
}

std::string unescaped_string(std::string_view literal) {
  std::string result;
  result.reserve(literal.size());
  for (std::size_t k = 0; k < literal.size(); ++k) {
    if (literal[k] != '\\' || k + 1 == literal.size()) {
      result += literal[k];
      continue;
    }
    const char c = literal[++k];
    static constexpr std::string_view kNames = "ntrabfv\\'\"", kBytes = "\n\t\r\a\b\f\v\\'\"";
    if (const std::size_t known = kNames.find(c); known != std::string_view::npos) {
      result += kBytes[known];
    } else if (const auto code = c == 'x' ? hexadecimal_at(literal, k + 1, 2) : std::nullopt) {
      result += static_cast<char>(*code);
      k += 2;
    } else if (c >= '0' && c <= '7') {
      int value = 0;
      std::size_t digits = 0;
      for (; digits < 3 && k + digits < literal.size(); ++digits) {
        const char digit = literal[k + digits];
        if (digit < '0' || digit > '7') break;
        value = 8 * value + (digit - '0');
      }
      result += static_cast<char>(value);
      k += digits - 1;
    } else {
      result += '\\';
      result += c;
    }
  }
  return result;
}

std::string unescaped_unicode(std::string_view raw) {
  std::string result;
  result.reserve(raw.size());
  for (std::size_t k = 0; k < raw.size(); ++k) {
    if (raw[k] == '\\' && k + 1 < raw.size() && (raw[k + 1] == 'u' || raw[k + 1] == 'U')) {
      const std::size_t digits = raw[k + 1] == 'u' ? 4 : 8;
      if (const auto code = hexadecimal_at(raw, k + 2, digits)) {
        append_utf8(result, *code);
        k += 1 + digits;
        continue;
      }
    }
    append_utf8(result, static_cast<unsigned char>(raw[k]));
  }
  return result;
}

void append_utf8(std::string& text, std::uint32_t code) {
  if (code < 0x80) {
    text += static_cast<char>(code);
  } else if (code < 0x800) {
    text += static_cast<char>(0xc0 | code >> 6);
    text += static_cast<char>(0x80 | (code & 63));
  } else if (code < 0x10000) {
    text += static_cast<char>(0xe0 | code >> 12);
    text += static_cast<char>(0x80 | (code >> 6 & 63));
    text += static_cast<char>(0x80 | (code & 63));
  } else if (code < 0x110000) {
    text += static_cast<char>(0xf0 | code >> 18);
    text += static_cast<char>(0x80 | (code >> 12 & 63));
    text += static_cast<char>(0x80 | (code >> 6 & 63));
    text += static_cast<char>(0x80 | (code & 63));
  }
}

std::optional<std::string> latin1_from_utf8(std::string_view text) {
  std::string result;
  result.reserve(text.size());
  for (std::size_t k = 0; k < text.size(); ++k) {
    const auto byte = static_cast<unsigned char>(text[k]);
    if (byte < 0x80) {
      result += text[k];
    } else if ((byte == 0xc2 || byte == 0xc3) && k + 1 < text.size() &&
               (static_cast<unsigned char>(text[k + 1]) & 0xc0) == 0x80) {
      result += static_cast<char>((byte & 3) << 6 | (static_cast<unsigned char>(text[++k]) & 63));
    } else {
      return std::nullopt;
    }
  }
  return result;
}

}  // namespace vitruvian
