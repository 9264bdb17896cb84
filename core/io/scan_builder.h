#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>

#include "base/error.h"
#include "io/block_array.h"
#include "io/scan.h"

namespace vitruvian {

/// Collects what a format reader finds and makes a valid Scan of it. Readers push in file order; all checks
/// that the formats share (indices, finite coordinates, matching counts) happen here.
class ScanBuilder {
 public:
  /// @param place_name  what the `place` numbers of faces count, for errors: "line", "byte", "face".
  ScanBuilder(ScanFormat format, std::string place_name, const Execution& execution)
      : format_(format), place_name_(std::move(place_name)), execution_(execution) {}

  void add_vertex(double x, double y, double z);
  void add_normal(double x, double y, double z);
  void add_colour(std::uint8_t red, std::uint8_t green, std::uint8_t blue);
  /// Colour in floating point, 0..1; files that use 0..255 are recognised by their first value above 1.
  void add_float_colour(double red, double green, double blue);
  /// A polygon of any number of corners, cut into a fan; one of fewer than three is counted and left out.
  /// @param place  of the face in the file, for errors.
  void add_polygon(std::span<const std::int64_t> corners, std::size_t place);
  void add_triangle(std::int64_t a, std::int64_t b, std::int64_t c, std::size_t place);
  void add_note(std::string note) { notes_.push_back(std::move(note)); }
  void drop_normals() { normals_.clear(); }
  /// Leaves vertices without finite coordinates out altogether; only for clouds.
  void leave_out_missing() { leave_out_missing_ = true; }

  std::size_t vertex_count() const { return coordinates_.size() / 3; }
  std::size_t face_count() const { return faces_.size() / 3; }
  /// Throws Error(cancelled) when asked to stop; readers call it every few thousand rows.
  void check() const { execution_.check(); }

  Scan finish();

 private:
  void place_coordinates(Scan& scan);
  void take_faces(Scan& scan);
  void take_attributes(Scan& scan);

  ScanFormat format_;
  std::string place_name_;
  const Execution& execution_;
  BlockArray<double> coordinates_;
  BlockArray<float> normals_;
  BlockArray<std::uint8_t> colours_;
  BlockArray<std::int32_t> faces_;
  std::vector<std::string> notes_;
  std::vector<std::uint8_t> missing_;  ///< by vertex; empty when every coordinate is finite
  bool colours_are_bytes_ = false;
  bool leave_out_missing_ = false;
  std::int64_t highest_index_ = -1;
  std::size_t highest_place_ = 0;
  std::size_t repeated_corner_count_ = 0, short_polygon_count_ = 0;
};

/// "1 face" or "3 faces".
std::string counted(std::size_t count, const std::string& one, const std::string& many);

}  // namespace vitruvian
