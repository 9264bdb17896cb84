#include "cli/paths.h"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <map>
#include <system_error>

#include "base/error.h"

namespace vitruvian {
namespace {

namespace fs = std::filesystem;

bool ends_with_gz(const std::string& name) {
  return name.size() >= 3 && name[name.size() - 3] == '.' && std::tolower(name[name.size() - 2]) == 'g' &&
         std::tolower(name[name.size() - 1]) == 'z';
}

/// The path without links and dots as far as it exists.
fs::path settled(const fs::path& path) {
  std::error_code ignored;
  const fs::path result = fs::weakly_canonical(fs::absolute(path, ignored), ignored);
  return ignored ? path.lexically_normal() : result;
}

}  // namespace

std::string output_stem(const std::string& scan_path) {
  std::string name = fs::path(scan_path).filename().string();
  if (ends_with_gz(name)) name.resize(name.size() - 3);
  const std::size_t dot = name.rfind('.');
  if (dot != std::string::npos && dot > 0) name.resize(dot);
  if (name.empty() || name == "." || name == "..") {
    throw Error(ErrorCode::usage, "\"" + scan_path + "\" does not name a scan file");
  }
  return name;
}

std::vector<std::string> output_folders(const std::vector<std::string>& scans, const std::string& out) {
  std::vector<std::string> folders;
  std::map<std::string, std::string> owners;
  for (const std::string& scan : scans) {
    const std::string stem = output_stem(scan);
    const auto [owner, fresh] = owners.try_emplace(stem, scan);
    if (!fresh) {
      throw Error(ErrorCode::usage, "\"" + owner->second + "\" and \"" + scan + "\" would both write to " +
                                        (fs::path(out) / stem).string() +
                                        ": register them into different folders");
    }
    folders.push_back((fs::path(out) / stem).string());
  }
  for (const std::string& scan : scans) {
    const fs::path path = settled(scan);
    const std::vector<std::string>& names = output_file_names();
    if (std::find(names.begin(), names.end(), path.filename().string()) == names.end()) continue;
    for (const std::string& folder : folders) {
      if (settled(folder) == path.parent_path()) {
        throw Error(ErrorCode::usage,
                    "\"" + scan + "\" would be overwritten by a result: choose another --out");
      }
    }
  }
  return folders;
}

const std::vector<std::string>& output_file_names() {
  static const std::vector<std::string> names = {"registration.json", "registered.ply", "registered.obj",
                                                 "registered.glb",    "errors.csv",     "offsets.npz"};
  return names;
}

void remove_stale_outputs(const std::string& folder, const std::vector<std::string>& kept) {
  for (const std::string& name : output_file_names()) {
    if (std::find(kept.begin(), kept.end(), name) != kept.end()) continue;
    const fs::path path = fs::path(folder) / name;
    std::error_code error;
    fs::remove(path, error);
    if (error && error != std::errc::not_a_directory && error != std::errc::no_such_file_or_directory) {
      throw Error(ErrorCode::cannot_write,
                  path.string() + ": an earlier result cannot be removed: " + error.message());
    }
  }
}

std::vector<std::string> data_folders(const std::string& program_folder, const std::string& data_variable) {
  const fs::path beside(program_folder);
  std::vector<std::string> folders = {(beside / "models").string(), beside.string(),
                                      (beside / ".." / "share" / "vitruvian").lexically_normal().string()};
  if (!data_variable.empty()) folders.push_back(data_variable);
  return folders;
}

std::string find_data_file(const std::vector<std::string>& folders, const std::string& name) {
  std::string searched;
  for (const std::string& folder : folders) {
    const fs::path path = fs::path(folder) / name;
    std::error_code ignored;
    if (fs::is_regular_file(path, ignored)) return path.string();
    searched += (searched.empty() ? "" : ", ") + folder;
  }
  throw Error(ErrorCode::cannot_read,
              name + " was not found in " + searched +
                  ": build the models with scripts/start, or set VITRUVIAN_DATA to their folder");
}

std::string printable(const std::string& text) {
  std::string result = text;
  for (char& c : result) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte < 0x20 || byte == 0x7f) c = '?';
  }
  return result;
}

}  // namespace vitruvian
