#include "cli/calibration_cache.h"

#include <filesystem>

#include "base/error.h"
#include "base/sha256.h"
#include "io/file.h"

namespace vitruvian {
namespace {

/// Raised when a calibration would come out otherwise: other networks, views or rules.
constexpr std::string_view kHeader = "vitruvian landmarks 1 ";
constexpr std::size_t kDigits = 64;

std::string digest(std::string_view text) {
  return to_hex(sha256(std::as_bytes(std::span(text.data(), text.size()))));
}

}  // namespace

std::string cache_folder(const char* xdg_cache_home, const char* home) {
  namespace fs = std::filesystem;
  // The XDG base directory specification: a relative path is to be ignored.
  if (xdg_cache_home && fs::path(xdg_cache_home).is_absolute())
    return (fs::path(xdg_cache_home) / "vitruvian").string();
  if (home && *home) return (fs::path(home) / ".cache" / "vitruvian").string();
  return {};
}

std::string CalibrationCache::path(const std::string& model_sha256) const {
  return (std::filesystem::path(folder_) / (model_sha256 + ".landmarks")).string();
}

std::optional<std::vector<LandmarkOffset>> CalibrationCache::find(const std::string& model_sha256) const {
  if (folder_.empty()) return std::nullopt;
  try {
    const FileBytes file(path(model_sha256));
    const std::string_view text(reinterpret_cast<const char*>(file.bytes().data()), file.bytes().size());
    if (text.size() <= kHeader.size() + kDigits || text.substr(0, kHeader.size()) != kHeader)
      return std::nullopt;
    const std::string_view content = text.substr(kHeader.size() + kDigits + 1);
    if (digest(content) != text.substr(kHeader.size(), kDigits)) return std::nullopt;
    return landmarks_from_json(std::string(content), path(model_sha256));
  } catch (const Error&) {
    return std::nullopt;
  }
}

void CalibrationCache::keep(const std::string& model_sha256,
                            const std::vector<LandmarkOffset>& landmarks) const {
  if (folder_.empty()) return;
  const std::string content = landmarks_to_json(landmarks);
  try {
    make_folders(folder_);
    write_file(path(model_sha256), std::string(kHeader) + digest(content) + "\n" + content);
  } catch (const Error&) {
    // It will be learnt again.
  }
}

}  // namespace vitruvian
