#pragma once

#include <string>
#include <vector>

namespace vitruvian {

/// Name of a scan's output folder: the file's name without .gz and one extension. "a/b.c.PLY.gz" -> "b.c".
/// @throws Error(usage) when nothing is left that could name a folder.
std::string output_stem(const std::string& scan_path);

/// Output folder of each scan, DIR/STEM.
/// @throws Error(usage) when two scans would share one, or an output would overwrite one of the scans.
std::vector<std::string> output_folders(const std::vector<std::string>& scans, const std::string& out);

/// Every file name that a registration may write into its folder, whatever its settings.
const std::vector<std::string>& output_file_names();

/// Removes from a folder what an earlier registration left there and `kept` does not name.
/// @throws Error(cannot_write).
void remove_stale_outputs(const std::string& folder, const std::vector<std::string>& kept);

/// Folders searched for models and networks, in order: beside the program (`models` there, then the folder
/// itself),
/// ../share/vitruvian, and `data_variable` (the value of $VITRUVIAN_DATA) when it is not empty.
std::vector<std::string> data_folders(const std::string& program_folder, const std::string& data_variable);

/// Path of the first of the folders' files of that name.
/// @throws Error(cannot_read) listing the folders.
std::string find_data_file(const std::vector<std::string>& folders, const std::string& name);

/// Text with control characters replaced, fit for a terminal.
std::string printable(const std::string& text);

}  // namespace vitruvian
