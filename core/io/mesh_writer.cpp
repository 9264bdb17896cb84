#include "io/mesh_writer.h"

#include <cmath>
#include <cstdio>
#include <cstring>

#include "base/error.h"
#include "io/mesh_check.h"

namespace vitruvian {
namespace {

template <class T>
void append(std::string& out, T value) {
  char raw[sizeof value];
  std::memcpy(raw, &value, sizeof value);
  out.append(raw, sizeof raw);
}

/// True when rounding to float32 moves no coordinate by more than a millionth of the mesh's extent.
bool float_is_enough(const Points3d& vertices) {
  if (vertices.cols() == 0) return true;
  const double extent = (vertices.rowwise().maxCoeff() - vertices.rowwise().minCoeff()).maxCoeff();
  return vertices.cwiseAbs().maxCoeff() * 6e-8 <= 1e-6 * extent;
}

void append_number(std::string& out, double value, int digits) {
  char text[40];
  int length = std::snprintf(text, sizeof text, "%.*g", digits, value);
  // The decimal point of the caller's locale must not reach the file.
  for (int k = 0; k < length; ++k) {
    if (text[k] == ',') text[k] = '.';
  }
  out.append(text, static_cast<std::size_t>(length));
}

}  // namespace

void check_mesh(const MeshView& mesh) {
  const auto count = static_cast<std::size_t>(mesh.vertices.cols());
  const auto fail = [](const char* what) {
    throw Error(ErrorCode::internal, std::string("mesh to write: ") + what);
  };
  if (!mesh.vertices.allFinite()) fail("a coordinate is not finite");
  if (mesh.faces.cols() > 0 && (mesh.faces.minCoeff() < 0 || mesh.faces.maxCoeff() >= mesh.vertices.cols())) {
    fail("a face uses a vertex that does not exist");
  }
  if (!mesh.colours.empty() && mesh.colours.size() != 3 * count)
    fail("the number of colours is not that of the vertices");
  if (!mesh.values.empty() && mesh.values.size() != count)
    fail("the number of values is not that of the vertices");
  for (const float value : mesh.values) {
    if (!std::isfinite(value)) fail("a value is not finite");
  }
}

std::string to_ply(const MeshView& mesh) {
  check_mesh(mesh);
  const bool as_float = float_is_enough(mesh.vertices);
  const std::string type = as_float ? "float" : "double";
  std::string out =
      "ply\nformat binary_little_endian 1.0\nelement vertex " + std::to_string(mesh.vertices.cols()) + "\n";
  for (const char* axis : {"x", "y", "z"}) out += "property " + type + " " + axis + "\n";
  if (!mesh.colours.empty()) out += "property uchar red\nproperty uchar green\nproperty uchar blue\n";
  if (!mesh.values.empty()) out += "property float " + mesh.value_name + "\n";
  out += "element face " + std::to_string(mesh.faces.cols()) +
         "\nproperty list uchar int vertex_indices\nend_header\n";
  out.reserve(out.size() + static_cast<std::size_t>(mesh.vertices.cols()) * 31 +
              static_cast<std::size_t>(mesh.faces.cols()) * 13);
  for (Index v = 0; v < mesh.vertices.cols(); ++v) {
    for (int axis = 0; axis < 3; ++axis) {
      if (as_float) {
        append(out, static_cast<float>(mesh.vertices(axis, v)));
      } else {
        append(out, mesh.vertices(axis, v));
      }
    }
    for (std::size_t c = 0; c < 3 && !mesh.colours.empty(); ++c)
      append(out, mesh.colours[3 * static_cast<std::size_t>(v) + c]);
    if (!mesh.values.empty()) append(out, mesh.values[static_cast<std::size_t>(v)]);
  }
  for (Index f = 0; f < mesh.faces.cols(); ++f) {
    append(out, std::uint8_t{3});
    for (int k = 0; k < 3; ++k) append(out, mesh.faces(k, f));
  }
  return out;
}

std::string to_obj(const MeshView& mesh) {
  check_mesh(mesh);
  const int digits = float_is_enough(mesh.vertices) ? 9 : 15;
  std::string out;
  out.reserve(static_cast<std::size_t>(mesh.vertices.cols()) * 40 +
              static_cast<std::size_t>(mesh.faces.cols()) * 22);
  for (Index v = 0; v < mesh.vertices.cols(); ++v) {
    out += 'v';
    for (int axis = 0; axis < 3; ++axis) {
      out += ' ';
      append_number(out, mesh.vertices(axis, v), digits);
    }
    for (std::size_t c = 0; c < 3 && !mesh.colours.empty(); ++c) {
      out += ' ';
      append_number(out, mesh.colours[3 * static_cast<std::size_t>(v) + c] / 255.0, 6);
    }
    out += '\n';
  }
  for (Index f = 0; f < mesh.faces.cols(); ++f) {
    out += 'f';
    for (int k = 0; k < 3; ++k) out += ' ' + std::to_string(mesh.faces(k, f) + 1);
    out += '\n';
  }
  return out;
}

}  // namespace vitruvian
