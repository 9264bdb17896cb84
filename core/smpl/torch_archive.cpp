#include "smpl/torch_archive.h"

#include <cmath>

#include "base/error.h"

namespace vitruvian {
namespace {

constexpr std::size_t kMostElements = std::size_t{1} << 26, kMostAxes = 8;

bool ends_with(const std::string& text, std::string_view end) {
  return text.size() >= end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

/// Refuses what is no zip with the mend for the most likely reason.
std::span<const std::byte> checked(std::span<const std::byte> bytes, const std::string& name) {
  if (bytes.size() < 4 || bytes[0] != std::byte{'P'} || bytes[1] != std::byte{'K'}) {
    throw Error(
        ErrorCode::unsupported_format,
        name + ": is no PyTorch archive; a file of PyTorch before 1.6 must be saved again with torch.save()");
  }
  return bytes;
}

}  // namespace

TorchArchive::TorchArchive(std::span<const std::byte> bytes, std::string file_name)
    : file_name_(std::move(file_name)), zip_(checked(bytes, file_name_), file_name_) {
  for (const std::string& name : zip_.names()) {
    if (name != "data.pkl" && !ends_with(name, "/data.pkl")) continue;
    folder_ = name.substr(0, name.size() - 8);
    pickle_bytes_ = zip_.bytes(name);
    pickle_ = std::make_unique<PickleFile>(pickle_bytes_, file_name_);
    if (zip_.has(folder_ + "byteorder")) {
      const std::vector<std::byte> order = zip_.bytes(folder_ + "byteorder");
      big_endian_ = !order.empty() && order[0] == std::byte{'b'};
    }
    return;
  }
  throw Error(ErrorCode::bad_file, file_name_ + ": is no PyTorch archive: it has no data.pkl");
}

void TorchArchive::fail(const std::string& name, const std::string& what) const {
  throw Error(ErrorCode::bad_file, file_name_ + ": " + name + ": " + what);
}

NumericArray TorchArchive::tensor(const PickleValue& value, const std::string& name) const {
  PickleValue made = value;
  if (ends_with(made.class_name(), "_rebuild_parameter") && made.arguments().size() > 0)
    made = made.arguments().at(0);
  const PickleValue arguments = made.arguments();
  if (!ends_with(made.class_name(), "_rebuild_tensor_v2") || arguments.size() < 4) {
    throw Error(ErrorCode::unsupported_format, file_name_ + ": " + name + ": is no plain tensor");
  }
  const PickleValue storage = arguments.at(0), identifier = storage.state();
  if (storage.kind() != PickleKind::persistent || identifier.kind() != PickleKind::list ||
      identifier.size() < 5)
    fail(name, "its storage is damaged");
  const std::string kind = identifier.at(1).class_name();
  NumpyType type{'f', 0, big_endian_};
  if (ends_with(kind, ".FloatStorage")) type.item_size = 4;
  if (ends_with(kind, ".DoubleStorage")) type.item_size = 8;
  if (ends_with(kind, ".HalfStorage")) type.item_size = 2;
  if (type.item_size == 0) {
    throw Error(ErrorCode::unsupported_format, file_name_ + ": " + name + ": is stored as " + kind +
                                                   "; only float, double and half are read");
  }
  const std::vector<std::byte> raw = zip_.bytes(folder_ + "data/" + std::string(identifier.at(2).text()));
  const std::size_t stored = raw.size() / type.item_size;
  const NumericArray all = decode_numpy(type, {stored}, false, raw, file_name_ + ": " + name);

  const auto whole = [&](const PickleValue& number) {
    const double n = number.number().value_or(-1);
    if (!(n >= 0 && n <= static_cast<double>(kMostElements)) || n != std::floor(n))
      fail(name, "its shape is damaged");
    return static_cast<std::size_t>(n);
  };
  const PickleValue shape = arguments.at(2), strides = arguments.at(3);
  if (shape.kind() != PickleKind::list || shape.size() > kMostAxes || strides.size() != shape.size())
    fail(name, "its shape is damaged");
  NumericArray result;
  std::vector<std::size_t> stride;
  std::size_t count = 1, last = whole(arguments.at(1));
  for (std::size_t k = 0; k < shape.size(); ++k) {
    result.shape.push_back(whole(shape.at(k)));
    stride.push_back(whole(strides.at(k)));
    if (result.shape[k] != 0 && count > kMostElements / result.shape[k]) fail(name, "it is too large");
    count *= result.shape[k];
    if (result.shape[k] > 1) {
      if (stride[k] > kMostElements / result.shape[k]) fail(name, "its shape is damaged");
      last += (result.shape[k] - 1) * stride[k];
    }
  }
  if (count > 0 && last >= stored) fail(name, "it is longer than its storage");
  result.values.reserve(count);
  std::vector<std::size_t> index(result.shape.size(), 0);
  for (std::size_t n = 0; n < count; ++n) {
    std::size_t place = whole(arguments.at(1));
    for (std::size_t k = 0; k < index.size(); ++k) place += index[k] * stride[k];
    result.values.push_back(all.values[place]);
    for (std::size_t k = index.size(); k-- > 0;) {
      if (++index[k] < result.shape[k]) break;
      index[k] = 0;
    }
  }
  return result;
}

}  // namespace vitruvian
