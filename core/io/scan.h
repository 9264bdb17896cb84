#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/execution.h"
#include "base/types.h"

namespace vitruvian {

enum class ScanFormat { ply, obj, stl, off, glb, gltf, xyz, pcd };
/// Lower-case name of a format, e.g. "ply".
std::string_view name_of(ScanFormat format) noexcept;

/// A body scan as its file gives it: a triangle mesh, or a bare point cloud when `faces` is empty. File
/// units, file axes.
struct Scan {
  std::string file_name;  ///< as given, any .gz included
  ScanFormat format = ScanFormat::ply;
  std::string sha256;  ///< of the file's bytes as given (compressed ones when it is gzipped), hexadecimal
  Vec3d origin = Vec3d::Zero();  ///< file units; position in the scan frame = origin + vertices.col(i)
  Points3f
      vertices;  ///< 3 x N, file order, unmerged (STL: 3 x facet + corner; GLB: primitives in scene order)
  Faces faces;   ///< 3 x F, polygons cut into fans; every index is valid, no corner twice in a face
  std::vector<std::uint8_t> colours;  ///< 3N, RGB of each vertex; or empty
  Points3f normals;  ///< 3 x N as in the file (zero where it has none that is finite); or 3 x 0
  std::optional<double> metres_per_unit;  ///< known only when the format says so (glTF: 1)
  std::vector<std::string> notes;         ///< what was repaired or left out, in plain words
};

/// Reads a scan. The format is found by content first, by the name's extension second; every format may be
/// gzipped.
///
/// Vertices whose coordinates are not finite: up to 1 % of them keep their index, are put on the finite
/// vertex before them (the first finite one if there is none before) and lose their faces, with a note; more
/// are an error that names the first. PCD files mark missing measurements in this way, so there (no faces
/// refer to them) they are left out.
/// @param file_name  shown in errors; only its extension has a meaning. No file is opened.
/// @throws Error(unsupported_format) for kinds of files that are not read, with the mend;
///         Error(bad_file) naming the line or byte; Error(no_geometry) with fewer than four distinct points;
///         Error(cancelled).
Scan read_scan(std::span<const std::byte> bytes, const std::string& file_name, const Execution& execution);

}  // namespace vitruvian
