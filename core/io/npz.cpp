#include "io/npz.h"

#include <algorithm>
#include <cstring>

#include "base/error.h"
#include "base/inflate.h"
#include "io/binary.h"
#include "io/pickle_text.h"

namespace vitruvian {
namespace {

constexpr std::size_t kEndRecord = 22, kDirectoryEntry = 46, kLocalHeader = 30;

/// What an .npy header says.
struct NpyHeader {
  NumpyType type;
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
  header.type = NumpyType::parse(type.substr(1));
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
  if (header.type.item_size != 0 && header.count > header.data.size() / header.type.item_size) {
    bad(name, "is cut short: its shape does not fit its size");
  }
  return header;
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
  const bool is_text = !item.text.empty();
  const bool is_float = item.doubles.empty() && item.integers.empty();
  const std::size_t given =
      item.floats.size() + item.doubles.size() + item.integers.size() + (is_text ? 1 : 0);
  if (given != count)
    throw Error(ErrorCode::internal, "array to write: " + item.name + " does not have the size of its shape");
  const std::string type = is_text                 ? "<U" + std::to_string(item.text.size())
                           : is_float              ? "<f4"
                           : item.integers.empty() ? "<f8"
                                                   : "<i4";
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
  for (const char c : item.text) append(out, static_cast<std::uint32_t>(static_cast<unsigned char>(c)));
  return out;
}

}  // namespace

NumericArray read_npy(std::span<const std::byte> bytes, const std::string& file_name) {
  const NpyHeader header = read_npy_header(bytes, file_name);
  return decode_numpy(header.type, header.shape, header.fortran_order, header.data, file_name);
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

std::vector<std::byte> NpzFile::bytes(std::string_view name) const { return unpack(name); }

std::vector<std::byte> NpzFile::python_object(std::string_view name) const {
  std::vector<std::byte> content = unpack(name);
  const NpyHeader header = read_npy_header(content, file_name_ + ": " + std::string(name));
  if (header.type.kind != 'O') return {};
  content.erase(content.begin(), content.end() - static_cast<std::ptrdiff_t>(header.data.size()));
  return content;
}

std::string NpzFile::text(std::string_view name) const {
  const std::vector<std::byte> content = unpack(name);
  const NpyHeader header = read_npy_header(content, file_name_ + ": " + std::string(name));
  if ((header.type.kind != 'U' && header.type.kind != 'S') || header.count != 1)
    fail(std::string(name) + ": is not a piece of text");
  std::string text;
  if (header.type.kind == 'S')
    text.assign(reinterpret_cast<const char*>(header.data.data()), header.type.item_size);
  for (std::size_t k = 0; header.type.kind == 'U' && k < header.type.item_size; k += 4) {
    append_utf8(text, load<std::uint32_t>(header.data.data() + k, header.type.swap));
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
