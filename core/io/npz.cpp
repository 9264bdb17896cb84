#include "io/npz.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "base/error.h"
#include "base/inflate.h"
#include "io/binary.h"

namespace vitruvian {
namespace {

constexpr std::size_t kEndRecord = 22, kDirectoryEntry = 46, kLocalHeader = 30;

/// What an .npy header says.
struct NpyHeader {
  char kind = 0;  ///< f, i, u, b, U, S ...
  std::size_t item_size = 0;
  bool swap = false;
  bool fortran_order = false;
  std::vector<std::size_t> shape;
  std::size_t count = 1;
  std::span<const std::byte> data;
};

[[noreturn]] void bad(const std::string& name, const std::string& what) {
  throw Error(ErrorCode::bad_file, name + ": " + what);
}

/// The text behind `'key':` in the header's Python dictionary.
std::string_view value_of(std::string_view header, std::string_view key, const std::string& name) {
  const std::string quoted = "'" + std::string(key) + "'";
  std::size_t position = header.find(quoted);
  if (position == std::string_view::npos) bad(name, "its NumPy header has no " + quoted);
  position = header.find_first_not_of(" :", position + quoted.size());
  return position == std::string_view::npos ? std::string_view() : header.substr(position);
}

NpyHeader read_npy_header(std::span<const std::byte> bytes, const std::string& name) {
  if (bytes.size() < 12 || std::memcmp(bytes.data(), "\x93NUMPY", 6) != 0) bad(name, "is not a NumPy array");
  const int major = std::to_integer<int>(bytes[6]);
  const std::size_t prefix = major == 1 ? 10 : 12;
  const std::size_t header_size =
      major == 1 ? load<std::uint16_t>(bytes.data() + 8) : load<std::uint32_t>(bytes.data() + 8);
  if (major < 1 || major > 3 || header_size > bytes.size() - prefix) bad(name, "its NumPy header is damaged");
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()) + prefix, header_size);

  NpyHeader header;
  const std::string_view type = value_of(text, "descr", name);
  if (type.size() < 4 || type[0] != '\'') {
    throw Error(ErrorCode::unsupported_format, name + ": records are not read; save plain numeric arrays");
  }
  header.swap = type[1] == '>';
  header.kind = type[2];
  for (std::size_t k = 3; k < type.size() && type[k] >= '0' && type[k] <= '9' && header.item_size < 1'000'000;
       ++k) {
    header.item_size = 10 * header.item_size + static_cast<std::size_t>(type[k] - '0');
  }
  if (header.kind == 'U') header.item_size *= 4;
  header.fortran_order = value_of(text, "fortran_order", name).substr(0, 4) == "True";

  std::string_view shape = value_of(text, "shape", name);
  const std::size_t close = shape.find(')');
  if (shape.empty() || shape[0] != '(' || close == std::string_view::npos)
    bad(name, "its NumPy header has no shape");
  shape = shape.substr(1, close - 1);
  while (!shape.empty()) {
    std::size_t extent = 0, digits = 0;
    for (; digits < shape.size() && shape[digits] >= '0' && shape[digits] <= '9' && digits < 10; ++digits) {
      extent = 10 * extent + static_cast<std::size_t>(shape[digits] - '0');
    }
    const std::size_t comma = shape.find(',');
    const std::string_view rest =
        shape.substr(digits, comma == std::string_view::npos ? comma : comma - digits);
    if (digits == 0 || header.shape.size() == 32 || rest.find_first_not_of(" L") != std::string_view::npos) {
      bad(name, "its NumPy shape cannot be read");
    }
    header.shape.push_back(extent);
    if (extent != 0 && header.count > bytes.size() / extent)
      bad(name, "is cut short: its shape does not fit its size");
    header.count *= extent;
    if (comma == std::string_view::npos) break;
    shape.remove_prefix(std::min(shape.size(), std::max(comma + 1, shape.find_first_not_of(' ', comma + 1))));
  }
  header.data = bytes.subspan(prefix + header_size);
  if (header.item_size != 0 && header.count > header.data.size() / header.item_size) {
    bad(name, "is cut short: its shape does not fit its size");
  }
  return header;
}

double half_at(const std::byte* bytes, bool swap) {
  const auto half = load<std::uint16_t>(bytes, swap);
  const int exponent = half >> 10 & 31, fraction = half & 1023;
  double magnitude = exponent == 0 ? std::ldexp(fraction, -24) : std::ldexp(1024 + fraction, exponent - 25);
  if (exponent == 31)
    magnitude = fraction ? std::numeric_limits<double>::quiet_NaN() : std::numeric_limits<double>::infinity();
  return half & 0x8000 ? -magnitude : magnitude;
}

double number_at(const NpyHeader& header, std::size_t index, const std::string& name) {
  const std::byte* at = header.data.data() + index * header.item_size;
  const auto is = [&](char kind, std::size_t size) {
    return header.kind == kind && header.item_size == size;
  };
  if (is('f', 4)) return load_number(Scalar::f32, at, header.swap);
  if (is('f', 8)) return load_number(Scalar::f64, at, header.swap);
  if (is('i', 1)) return load_number(Scalar::i8, at);
  if (is('i', 2)) return load_number(Scalar::i16, at, header.swap);
  if (is('i', 4)) return load_number(Scalar::i32, at, header.swap);
  if (is('i', 8)) return load_number(Scalar::i64, at, header.swap);
  if (is('u', 1) || is('b', 1)) return load_number(Scalar::u8, at);
  if (is('u', 2)) return load_number(Scalar::u16, at, header.swap);
  if (is('u', 4)) return load_number(Scalar::u32, at, header.swap);
  if (is('u', 8)) return load_number(Scalar::u64, at, header.swap);
  if (is('f', 2)) return half_at(at, header.swap);
  throw Error(ErrorCode::unsupported_format, name + ": NumPy type " + header.kind +
                                                 std::to_string(header.item_size) + " is not a plain number");
}

/// Fortran order to C order.
std::vector<double> transposed(const std::vector<double>& values, const std::vector<std::size_t>& shape) {
  std::vector<double> result(values.size());
  std::vector<std::size_t> index(shape.size());
  for (double& value : result) {
    std::size_t position = 0;
    for (std::size_t k = shape.size(); k-- > 0;) position = position * shape[k] + index[k];
    value = values[position];
    for (std::size_t k = shape.size(); k-- > 0;) {
      if (++index[k] < shape[k]) break;
      index[k] = 0;
    }
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

template <class T>
void append(std::string& out, T value) {
  char raw[sizeof value];
  std::memcpy(raw, &value, sizeof value);
  out.append(raw, sizeof raw);
}

std::span<const std::byte> as_bytes(const std::string& text) {
  return std::as_bytes(std::span(text.data(), text.size()));
}

std::string to_npy(const NpzItem& item) {
  std::size_t count = 1;
  std::string shape;
  for (const std::size_t extent : item.shape) {
    count *= extent;
    shape += std::to_string(extent) + ",";
  }
  const bool is_float = item.doubles.empty() && item.integers.empty();
  const std::size_t given = item.floats.size() + item.doubles.size() + item.integers.size();
  if (given != count)
    throw Error(ErrorCode::internal, "array to write: " + item.name + " does not have the size of its shape");
  const char* type = is_float ? "<f4" : item.integers.empty() ? "<f8" : "<i4";
  std::string header =
      std::string("{'descr': '") + type + "', 'fortran_order': False, 'shape': (" + shape + "), }";
  // NumPy aligns the data to 64 bytes; the header ends with a newline.
  header.append(63 - (10 + header.size()) % 64, ' ');
  header += '\n';
  std::string out("\x93NUMPY\x01\x00", 8);
  append(out, static_cast<std::uint16_t>(header.size()));
  out += header;
  const auto add = [&](const auto& values) {
    if (!values.empty()) out.append(reinterpret_cast<const char*>(values.data()), values.size_bytes());
  };
  add(item.floats);
  add(item.doubles);
  add(item.integers);
  return out;
}

}  // namespace

NumericArray read_npy(std::span<const std::byte> bytes, const std::string& file_name) {
  const NpyHeader header = read_npy_header(bytes, file_name);
  NumericArray array;
  array.shape = header.shape;
  if (header.item_size == 0 || header.kind == 'O') {
    throw Error(ErrorCode::unsupported_format,
                file_name + ": holds Python objects; save plain numeric arrays");
  }
  array.values.resize(header.count);
  for (std::size_t i = 0; i < header.count; ++i) array.values[i] = number_at(header, i, file_name);
  if (header.fortran_order && header.shape.size() > 1) array.values = transposed(array.values, header.shape);
  return array;
}

NpzFile::NpzFile(std::span<const std::byte> bytes, std::string file_name) : file_name_(std::move(file_name)) {
  if (bytes.size() < kEndRecord || load<std::uint16_t>(bytes.data()) != 0x4b50)
    fail("is not an .npz file (a zip archive)");
  // The end record is followed by a comment of at most 65535 bytes, nearly always an empty one.
  std::size_t end = bytes.size() - kEndRecord;
  const std::size_t first = end - std::min<std::size_t>(end, 65535);
  while (end > first && load<std::uint32_t>(bytes.data() + end) != 0x06054b50) --end;
  if (load<std::uint32_t>(bytes.data() + end) != 0x06054b50)
    fail("is cut short: the zip directory is missing");
  const std::size_t count = load<std::uint16_t>(bytes.data() + end + 10);
  std::size_t position = load<std::uint32_t>(bytes.data() + end + 16);
  for (std::size_t k = 0; k < count; ++k) {
    if (position > bytes.size() || bytes.size() - position < kDirectoryEntry ||
        load<std::uint32_t>(bytes.data() + position) != 0x02014b50) {
      fail("its zip directory is damaged");
    }
    const std::byte* entry = bytes.data() + position;
    const auto flags = load<std::uint16_t>(entry + 8), method = load<std::uint16_t>(entry + 10);
    const std::size_t stored_size = load<std::uint32_t>(entry + 20), size = load<std::uint32_t>(entry + 24);
    const std::size_t name_size = load<std::uint16_t>(entry + 28), local = load<std::uint32_t>(entry + 42);
    const std::size_t extra_size =
        std::size_t{load<std::uint16_t>(entry + 30)} + load<std::uint16_t>(entry + 32);
    if (bytes.size() - position - kDirectoryEntry < name_size) fail("its zip directory is damaged");
    Member member;
    member.name.assign(reinterpret_cast<const char*>(entry) + kDirectoryEntry, name_size);
    position += kDirectoryEntry + name_size + extra_size;
    const std::string shown = "member '" + member.name.substr(0, 60) + "' ";
    if (stored_size == 0xffffffff || size == 0xffffffff) fail(shown + "is larger than 4 GiB");
    if ((flags & 1) != 0 || (method != 0 && method != 8))
      fail(shown + "is encrypted or compressed in an unusual way");
    if (local > bytes.size() || bytes.size() - local < kLocalHeader ||
        load<std::uint32_t>(bytes.data() + local) != 0x04034b50) {
      fail(shown + "is damaged");
    }
    const std::size_t data = local + kLocalHeader + load<std::uint16_t>(bytes.data() + local + 26) +
                             std::size_t{load<std::uint16_t>(bytes.data() + local + 28)};
    if (data > bytes.size() || stored_size > bytes.size() - data) fail(shown + "is cut short");
    member.deflated = method == 8;
    member.crc = load<std::uint32_t>(entry + 16);
    member.size = size;
    member.stored = bytes.subspan(data, stored_size);
    if (member.name.size() > 4 && member.name.compare(member.name.size() - 4, 4, ".npy") == 0) {
      member.name.resize(member.name.size() - 4);
    }
    members_.push_back(std::move(member));
  }
}

std::vector<std::string> NpzFile::names() const {
  std::vector<std::string> names;
  for (const Member& member : members_) names.push_back(member.name);
  return names;
}

bool NpzFile::has(std::string_view name) const {
  return std::any_of(members_.begin(), members_.end(),
                     [&](const Member& member) { return member.name == name; });
}

std::vector<std::byte> NpzFile::unpack(std::string_view name) const {
  const auto found = std::find_if(members_.begin(), members_.end(),
                                  [&](const Member& member) { return member.name == name; });
  if (found == members_.end()) fail("has no array '" + std::string(name) + "'");
  if (!found->deflated && found->size != found->stored.size())
    fail(found->name + ": sizes contradict each other");
  std::vector<std::byte> content;
  try {
    content = found->deflated ? inflate_raw(found->stored, found->size)
                              : std::vector<std::byte>(found->stored.begin(), found->stored.end());
  } catch (const Error& error) {
    fail(found->name + ": " + error.what());
  }
  if (crc32(content) != found->crc) fail(found->name + ": fails its checksum: the file is damaged");
  return content;
}

NumericArray NpzFile::array(std::string_view name) const {
  return read_npy(unpack(name), file_name_ + ": " + std::string(name));
}

std::string NpzFile::text(std::string_view name) const {
  const std::vector<std::byte> content = unpack(name);
  const NpyHeader header = read_npy_header(content, file_name_ + ": " + std::string(name));
  if ((header.kind != 'U' && header.kind != 'S') || header.count != 1)
    fail(std::string(name) + ": is not a piece of text");
  std::string text;
  if (header.kind == 'S') text.assign(reinterpret_cast<const char*>(header.data.data()), header.item_size);
  for (std::size_t k = 0; header.kind == 'U' && k < header.item_size; k += 4) {
    append_utf8(text, load<std::uint32_t>(header.data.data() + k, header.swap));
  }
  text.erase(text.find_last_not_of('\0') + 1);
  return text;
}

void NpzFile::fail(const std::string& what) const {
  throw Error(ErrorCode::bad_file, file_name_ + ": " + what);
}

std::string to_npz(std::span<const NpzItem> items) {
  constexpr std::uint16_t kDosDate = 33;  // 1980-01-01, zip's zero
  std::string out, directory;
  for (const NpzItem& item : items) {
    const std::string content = to_npy(item);
    const std::string name = item.name + ".npy";
    if (out.size() + content.size() > 0xfff00000)
      throw Error(ErrorCode::internal, "array file to write: larger than 4 GiB");
    const auto offset = static_cast<std::uint32_t>(out.size());
    const auto size = static_cast<std::uint32_t>(content.size());
    std::string common;  // the fields that the local header and the directory share
    append(common, std::uint16_t{20});
    append(common, std::uint16_t{0x0800});  // names are UTF-8
    append(common, std::uint16_t{0});       // stored
    append(common, std::uint16_t{0});
    append(common, kDosDate);
    append(common, crc32(as_bytes(content)));
    append(common, size);
    append(common, size);
    append(common, static_cast<std::uint16_t>(name.size()));
    append(common, std::uint16_t{0});
    append(out, std::uint32_t{0x04034b50});
    out += common + name + content;
    append(directory, std::uint32_t{0x02014b50});
    append(directory, std::uint16_t{20});
    directory += common;
    directory.append(10, '\0');  // comment size, disk, internal and external attributes
    append(directory, offset);
    directory += name;
  }
  const auto directory_offset = static_cast<std::uint32_t>(out.size());
  const auto count = static_cast<std::uint16_t>(items.size());
  out += directory;
  append(out, std::uint32_t{0x06054b50});
  append(out, std::uint32_t{0});
  append(out, count);
  append(out, count);
  append(out, static_cast<std::uint32_t>(directory.size()));
  append(out, directory_offset);
  append(out, std::uint16_t{0});
  return out;
}

}  // namespace vitruvian
