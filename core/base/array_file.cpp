#include "base/array_file.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "base/error.h"
#include "base/inflate.h"
#include "base/sha256.h"

namespace vitruvian {
namespace {

constexpr std::size_t kHeaderSize = 64, kHashedFrom = 56, kEntrySize = 88, kNameSize = 32;
/// Deflate's largest expansion; a stored size that would need more is a lie, found before anything is
/// allocated.
constexpr std::size_t kLargestRatio = 1032;

/// Little-endian number of the size of T at `position`; the core's targets are little-endian.
template <class T>
T number_at(std::span<const std::byte> bytes, std::size_t position) {
  T value;
  std::memcpy(&value, bytes.data() + position, sizeof value);
  return value;
}

std::string text_of(std::span<const std::byte> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

std::string to_text(std::span<const std::size_t> shape) {
  std::string text = "[";
  for (std::size_t k = 0; k < shape.size(); ++k) text += (k ? "," : "") + std::to_string(shape[k]);
  return text + "]";
}

constexpr std::size_t kTypeSizes[] = {1, 1, 2, 2, 4, 4, 2, 4, 8};

double half_to_double(std::uint16_t half) {
  const int exponent = half >> 10 & 31;
  const int fraction = half & 1023;
  double magnitude;
  if (exponent == 31) {
    magnitude = fraction ? std::numeric_limits<double>::quiet_NaN() : std::numeric_limits<double>::infinity();
  } else if (exponent == 0) {
    magnitude = std::ldexp(fraction, -24);
  } else {
    magnitude = std::ldexp(1024 + fraction, exponent - 25);
  }
  return half & 0x8000 ? -magnitude : magnitude;
}

template <class T>
void convert(std::span<const std::byte> bytes, std::vector<double>& values) {
  for (std::size_t i = 0; i < values.size(); ++i) {
    values[i] = static_cast<double>(number_at<T>(bytes, i * sizeof(T)));
  }
}

}  // namespace

ArrayFile::ArrayFile(std::span<const std::byte> bytes, std::string_view kind, std::string name)
    : name_(std::move(name)) {
  if (bytes.size() < kHeaderSize)
    fail("too short for an array file (" + std::to_string(bytes.size()) + " bytes)");
  if (text_of(bytes.first(8)) != "VITRUARR")
    fail("not an array file: the first eight bytes are not VITRUARR");
  const auto version = number_at<std::uint32_t>(bytes, 8);
  if (version != 1)
    fail("version " + std::to_string(version) + " of the array file format; this program reads 1");
  if (text_of(bytes.subspan(12, 4)) != kind) {
    fail("wrong kind of array file; one of kind " + std::string(kind) + " is needed");
  }
  const auto size = number_at<std::uint64_t>(bytes, 16);
  if (size != bytes.size()) {
    fail("cut short or extended: " + std::to_string(bytes.size()) + " bytes instead of " +
         std::to_string(size));
  }
  const Sha256::Digest digest = sha256(bytes.subspan(kHashedFrom));
  if (std::memcmp(digest.data(), bytes.data() + 24, digest.size()) != 0)
    fail("damaged: its SHA-256 does not match");

  const std::size_t array_count = number_at<std::uint32_t>(bytes, 56);
  if (number_at<std::uint32_t>(bytes, 60) != 0) fail("reserved bytes 60..63 are not zero");
  if (array_count > (bytes.size() - kHeaderSize) / kEntrySize) {
    fail("announces " + std::to_string(array_count) + " arrays, more than fit into it");
  }
  const std::size_t payload_begin = kHeaderSize + array_count * kEntrySize;
  entries_.reserve(array_count);
  for (std::size_t a = 0; a < array_count; ++a) {
    const auto raw = bytes.subspan(kHeaderSize + a * kEntrySize, kEntrySize);
    const std::string entry_number = "array " + std::to_string(a);
    Entry entry;
    entry.name = text_of(raw.first(kNameSize));
    entry.name.erase(std::min(entry.name.find('\0'), kNameSize));
    const auto printable = [](char c) { return c > ' ' && c < 127; };
    const auto padding = raw.subspan(entry.name.size(), kNameSize - entry.name.size());
    const auto zero = [](std::byte byte) { return byte == std::byte{0}; };
    if (entry.name.empty() || !std::all_of(entry.name.begin(), entry.name.end(), printable) ||
        !std::all_of(padding.begin(), padding.end(), zero)) {
      fail(entry_number + ": its name is not plain text");
    }
    if (has(entry.name)) fail("two arrays are called " + entry.name);
    const auto type = number_at<std::uint32_t>(raw, 32);
    if (type > 8) fail(entry.name + ": unknown type " + std::to_string(type));
    entry.type = static_cast<Type>(type);
    const auto rank = number_at<std::uint32_t>(raw, 36);
    if (rank < 1 || rank > 4) fail(entry.name + ": rank " + std::to_string(rank) + " is not in 1..4");
    const std::size_t element_size = kTypeSizes[type];
    entry.count = 1;
    for (std::uint32_t k = 0; k < 4; ++k) {
      const std::size_t extent = number_at<std::uint32_t>(raw, 40 + 4 * k);
      if (k >= rank && extent != 1) fail(entry.name + ": unused extents are not 1");
      if (k < rank) entry.shape.push_back(extent);
      if (extent != 0 && entry.count > std::numeric_limits<std::size_t>::max() / 16 / extent) {
        fail(entry.name + ": its shape is impossibly large");
      }
      entry.count *= extent;
    }
    const auto encoding = number_at<std::uint32_t>(raw, 56);
    if (encoding > 1) fail(entry.name + ": unknown encoding " + std::to_string(encoding));
    entry.compressed = encoding == 1;
    if (number_at<std::uint32_t>(raw, 60) != 0 || number_at<std::uint64_t>(raw, 80) != 0) {
      fail(entry.name + ": reserved bytes are not zero");
    }
    const auto offset = number_at<std::uint64_t>(raw, 64);
    const auto stored = number_at<std::uint64_t>(raw, 72);
    if (offset < payload_begin || offset > bytes.size() || stored > bytes.size() - offset) {
      fail(entry.name + ": its bytes lie outside the file");
    }
    const std::size_t element_bytes = entry.count * element_size;
    if (entry.compressed ? element_bytes / kLargestRatio > stored : element_bytes != stored) {
      fail(entry.name + ": " + std::to_string(stored) + " stored bytes do not match its shape " +
           to_text(entry.shape));
    }
    entry.payload = bytes.subspan(static_cast<std::size_t>(offset), static_cast<std::size_t>(stored));
    entries_.push_back(std::move(entry));
  }
}

bool ArrayFile::has(std::string_view array) const {
  return std::any_of(entries_.begin(), entries_.end(),
                     [&](const Entry& entry) { return entry.name == array; });
}

std::vector<std::size_t> ArrayFile::shape(std::string_view array) const { return find(array).shape; }

std::vector<float> ArrayFile::floats(std::string_view array,
                                     std::span<const std::size_t> expected_shape) const {
  const Entry& entry = checked(array, expected_shape);
  std::vector<double> numbers = values(entry);
  const std::string scale_name = entry.name + ".scale";
  const bool is_integer = entry.type < Type::f16;
  if (is_integer && has(scale_name)) {
    const Entry& scale_entry = find(scale_name);
    const std::vector<double> scale = values(scale_entry);
    if (scale_entry.type < Type::f16 || scale_entry.shape.size() != 1 ||
        (scale.size() != 1 && scale.size() != entry.shape[0])) {
      fail(scale_name + ": must be one number, or one for each index of the first axis of " + entry.name);
    }
    const std::size_t run =
        scale.size() == 1 ? numbers.size() : numbers.size() / std::max<std::size_t>(1, scale.size());
    for (std::size_t i = 0; i < numbers.size(); ++i) numbers[i] *= scale[i / run];
  }
  std::vector<float> result(numbers.size());
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    if (!(std::abs(numbers[i]) <= std::numeric_limits<float>::max())) {
      fail(entry.name + ": element " + std::to_string(i) + " is not a finite number");
    }
    result[i] = static_cast<float>(numbers[i]);
  }
  return result;
}

std::vector<std::int32_t> ArrayFile::integers(std::string_view array,
                                              std::span<const std::size_t> expected_shape, std::int32_t low,
                                              std::int32_t high) const {
  const Entry& entry = checked(array, expected_shape);
  if (entry.type >= Type::f16) fail(entry.name + ": holds floating-point numbers where integers are needed");
  const std::vector<double> numbers = values(entry);
  std::vector<std::int32_t> result(numbers.size());
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    if (numbers[i] < low || numbers[i] > high) {
      fail(entry.name + ": element " + std::to_string(i) + " is outside " + std::to_string(low) + ".." +
           std::to_string(high));
    }
    result[i] = static_cast<std::int32_t>(numbers[i]);
  }
  return result;
}

std::string ArrayFile::text(std::string_view array) const {
  const Entry& entry = find(array);
  if (entry.type != Type::u8 || entry.shape.size() != 1) fail(entry.name + ": is not text");
  return text_of(elements(entry));
}

const ArrayFile::Entry& ArrayFile::find(std::string_view array) const {
  const auto found =
      std::find_if(entries_.begin(), entries_.end(), [&](const Entry& entry) { return entry.name == array; });
  if (found == entries_.end()) fail("has no array " + std::string(array));
  return *found;
}

std::vector<std::byte> ArrayFile::elements(const Entry& entry) const {
  const std::size_t element_size = kTypeSizes[static_cast<std::size_t>(entry.type)];
  if (!entry.compressed) return {entry.payload.begin(), entry.payload.end()};
  std::vector<std::byte> planes;
  try {
    planes = inflate_zlib(entry.payload, entry.count * element_size);
  } catch (const Error& error) {
    fail(entry.name + ": " + error.what());
  }
  if (element_size == 1) return planes;
  std::vector<std::byte> result(planes.size());
  for (std::size_t k = 0; k < element_size; ++k) {
    const std::byte* plane = planes.data() + k * entry.count;
    for (std::size_t i = 0; i < entry.count; ++i) result[i * element_size + k] = plane[i];
  }
  return result;
}

std::vector<double> ArrayFile::values(const Entry& entry) const {
  const std::vector<std::byte> bytes = elements(entry);
  std::vector<double> result(entry.count);
  switch (entry.type) {
    case Type::u8:
      convert<std::uint8_t>(bytes, result);
      break;
    case Type::i8:
      convert<std::int8_t>(bytes, result);
      break;
    case Type::u16:
      convert<std::uint16_t>(bytes, result);
      break;
    case Type::i16:
      convert<std::int16_t>(bytes, result);
      break;
    case Type::u32:
      convert<std::uint32_t>(bytes, result);
      break;
    case Type::i32:
      convert<std::int32_t>(bytes, result);
      break;
    case Type::f32:
      convert<float>(bytes, result);
      break;
    case Type::f64:
      convert<double>(bytes, result);
      break;
    case Type::f16:
      for (std::size_t i = 0; i < result.size(); ++i) {
        result[i] = half_to_double(number_at<std::uint16_t>(bytes, 2 * i));
      }
      break;
  }
  return result;
}

const ArrayFile::Entry& ArrayFile::checked(std::string_view array,
                                           std::span<const std::size_t> expected_shape) const {
  const Entry& entry = find(array);
  if (!std::equal(entry.shape.begin(), entry.shape.end(), expected_shape.begin(), expected_shape.end())) {
    fail(entry.name + ": its shape is " + to_text(entry.shape) + ", expected " + to_text(expected_shape));
  }
  return entry;
}

void ArrayFile::fail(const std::string& what) const {
  throw Error(ErrorCode::bad_model, name_ + ": " + what);
}

}  // namespace vitruvian
