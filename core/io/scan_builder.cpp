#include "io/scan_builder.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace vitruvian {
namespace {

/// Squares of lengths up to this stay finite in float.
constexpr double kLargestExtent = 1e15;
constexpr std::size_t kLargestCount = std::numeric_limits<std::int32_t>::max();

bool finite(double x, double y, double z) { return std::isfinite(x) && std::isfinite(y) && std::isfinite(z); }

bool has_four_distinct_points(const Points3f& points) {
  std::array<Vec3f, 3> found;
  std::size_t count = 0;
  for (Index i = 0; i < points.cols(); ++i) {
    const Vec3f point = points.col(i);
    if (std::find(found.begin(), found.begin() + count, point) != found.begin() + count) continue;
    if (count == found.size()) return true;
    found[count++] = point;
  }
  return false;
}

}  // namespace

std::string counted(std::size_t count, const std::string& one, const std::string& many) {
  return std::to_string(count) + " " + (count == 1 ? one : many);
}

void ScanBuilder::add_vertex(double x, double y, double z) {
  if (vertex_count() >= kLargestCount) throw Error(ErrorCode::bad_file, "more than 2147483647 vertices");
  coordinates_.push(x);
  coordinates_.push(y);
  coordinates_.push(z);
}

void ScanBuilder::add_normal(double x, double y, double z) {
  const bool usable = finite(x, y, z) && std::max({std::abs(x), std::abs(y), std::abs(z)}) < kLargestExtent;
  normals_.push(usable ? static_cast<float>(x) : 0.0f);
  normals_.push(usable ? static_cast<float>(y) : 0.0f);
  normals_.push(usable ? static_cast<float>(z) : 0.0f);
}

void ScanBuilder::add_colour(std::uint8_t red, std::uint8_t green, std::uint8_t blue) {
  colours_.push(red);
  colours_.push(green);
  colours_.push(blue);
}

void ScanBuilder::add_float_colour(double red, double green, double blue) {
  if (!colours_are_bytes_ && std::max({red, green, blue}) > 1.0) {
    colours_are_bytes_ = true;
    for (std::size_t i = 0; i < colours_.size(); ++i) colours_[i] = colours_[i] >= 128 ? 1 : 0;
  }
  const double factor = colours_are_bytes_ ? 1.0 : 255.0;
  for (const double value : {red, green, blue}) {
    const double scaled = value * factor;
    colours_.push(scaled > 0 ? static_cast<std::uint8_t>(std::min(scaled + 0.5, 255.0)) : std::uint8_t{0});
  }
}

void ScanBuilder::add_triangle(std::int64_t a, std::int64_t b, std::int64_t c, std::size_t place) {
  if (a < 0 || b < 0 || c < 0) {
    throw Error(ErrorCode::bad_file, place_name_ + " " + std::to_string(place) + ": a face uses vertex " +
                                         std::to_string(std::min({a, b, c})) +
                                         "; vertices are counted from 0");
  }
  const std::int64_t highest = std::max({a, b, c});
  if (highest > highest_index_) {
    if (highest >= static_cast<std::int64_t>(kLargestCount)) {
      throw Error(ErrorCode::bad_file, place_name_ + " " + std::to_string(place) + ": a face uses vertex " +
                                           std::to_string(highest) + ", which cannot be");
    }
    highest_index_ = highest;
    highest_place_ = place;
  }
  if (a == b || b == c || c == a) {
    ++repeated_corner_count_;
    return;
  }
  if (face_count() >= kLargestCount) throw Error(ErrorCode::bad_file, "more than 2147483647 triangles");
  faces_.push(static_cast<std::int32_t>(a));
  faces_.push(static_cast<std::int32_t>(b));
  faces_.push(static_cast<std::int32_t>(c));
}

void ScanBuilder::add_polygon(std::span<const std::int64_t> corners, std::size_t place) {
  if (corners.size() < 3) {
    ++short_polygon_count_;
    return;
  }
  for (std::size_t k = 2; k < corners.size(); ++k)
    add_triangle(corners[0], corners[k - 1], corners[k], place);
}

Scan ScanBuilder::finish() {
  if (vertex_count() == 0) throw Error(ErrorCode::no_geometry, "holds no vertices");
  if (highest_index_ >= static_cast<std::int64_t>(vertex_count())) {
    throw Error(ErrorCode::bad_file, place_name_ + " " + std::to_string(highest_place_) +
                                         ": a face uses vertex " + std::to_string(highest_index_) +
                                         " (counted from 0), but there are only " +
                                         std::to_string(vertex_count()));
  }
  Scan scan;
  scan.format = format_;
  place_coordinates(scan);
  take_attributes(scan);
  take_faces(scan);
  scan.notes = std::move(notes_);
  return scan;
}

void ScanBuilder::place_coordinates(Scan& scan) {
  const std::size_t count = vertex_count();
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  Vec3d low = Vec3d::Constant(kInfinity), high = Vec3d::Constant(-kInfinity);
  std::size_t missing_count = 0, first_missing = 0, first_finite = count;
  for (std::size_t i = 0; i < count; ++i) {
    const Vec3d point(coordinates_[3 * i], coordinates_[3 * i + 1], coordinates_[3 * i + 2]);
    if (finite(point.x(), point.y(), point.z())) {
      if (first_finite == count) first_finite = i;
      low = low.cwiseMin(point);
      high = high.cwiseMax(point);
    } else {
      if (missing_count++ == 0) first_missing = i;
      missing_.resize(count);
      missing_[i] = 1;
    }
  }
  if (missing_count > 0 && (first_finite == count || (!leave_out_missing_ && missing_count > count / 100))) {
    const std::string text = std::to_string(missing_count) + " of " + counted(count, "vertex", "vertices");
    if (first_finite == count && leave_out_missing_) {
      throw Error(ErrorCode::no_geometry, text + " have no measured position");
    }
    throw Error(ErrorCode::bad_file,
                text + " have coordinates that are not finite numbers, the first is vertex " +
                    std::to_string(first_missing) + " (counted from 0): export the scan again");
  }
  const double extent = (high - low).maxCoeff();
  if (!(extent < kLargestExtent)) {
    throw Error(ErrorCode::bad_file,
                "coordinates span more than 1e15 units: the file is damaged or not a body scan");
  }
  scan.origin = 0.5 * low + 0.5 * high;
  const std::size_t kept = leave_out_missing_ ? count - missing_count : count;
  scan.vertices.resize(3, static_cast<Index>(kept));
  std::size_t last_finite = first_finite, next = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const bool absent = !missing_.empty() && missing_[i];
    if (absent && leave_out_missing_) continue;
    // Past `first_finite`, the source is at most one run of missing vertices behind; its position is kept
    // aside.
    if (!absent) last_finite = i;
    if (absent && next > 0) {
      scan.vertices.col(static_cast<Index>(next)) = scan.vertices.col(static_cast<Index>(next) - 1);
    } else {
      for (int axis = 0; axis < 3; ++axis) {
        scan.vertices(axis, static_cast<Index>(next)) =
            static_cast<float>(coordinates_[3 * last_finite + axis] - scan.origin[axis]);
      }
    }
    ++next;
    if (i > first_finite) coordinates_.release_before(3 * i);
  }
  coordinates_.clear();
  if (missing_count > 0) {
    notes_.push_back(
        counted(missing_count, "vertex", "vertices") + " without finite coordinates, " +
        (leave_out_missing_ ? "left out" : "put on the vertex before and taken out of the faces"));
  }
  if (!has_four_distinct_points(scan.vertices)) {
    throw Error(ErrorCode::no_geometry, "holds fewer than four distinct points");
  }
}

void ScanBuilder::take_attributes(Scan& scan) {
  const std::size_t count = leave_out_missing_ && !missing_.empty()
                                ? missing_.size()
                                : static_cast<std::size_t>(scan.vertices.cols());
  if (colours_.size() == 3 * count) {
    scan.colours.resize(3 * count);
    colours_.take(scan.colours.data());
  } else if (colours_.size() > 0) {
    notes_.push_back("colours left out: only " + std::to_string(colours_.size() / 3) + " of " +
                     counted(count, "vertex has one", "vertices have one"));
  }
  if (normals_.size() == 3 * count) {
    scan.normals.resize(3, static_cast<Index>(count));
    normals_.take(scan.normals.data());
  } else if (normals_.size() > 0) {
    notes_.push_back("normals left out: their number is not that of the vertices");
  }
  if (!leave_out_missing_ || missing_.empty()) return;
  std::size_t next = 0;
  for (std::size_t i = 0; i < count; ++i) {
    if (missing_[i]) continue;
    if (!scan.colours.empty()) std::copy_n(scan.colours.begin() + 3 * i, 3, scan.colours.begin() + 3 * next);
    if (scan.normals.cols() > 0)
      scan.normals.col(static_cast<Index>(next)) = scan.normals.col(static_cast<Index>(i)).eval();
    ++next;
  }
  if (!scan.colours.empty()) scan.colours.resize(3 * next);
  if (scan.normals.cols() > 0) scan.normals.conservativeResize(3, static_cast<Index>(next));
}

void ScanBuilder::take_faces(Scan& scan) {
  scan.faces.resize(3, static_cast<Index>(face_count()));
  faces_.take(scan.faces.data());
  if (!missing_.empty() && !leave_out_missing_) {
    Index kept = 0;
    for (Index f = 0; f < scan.faces.cols(); ++f) {
      const Eigen::Vector3i face = scan.faces.col(f);
      if (missing_[face[0]] || missing_[face[1]] || missing_[face[2]]) continue;
      scan.faces.col(kept++) = face;
    }
    scan.faces.conservativeResize(3, kept);
  }
  if (repeated_corner_count_ > 0) {
    notes_.push_back(counted(repeated_corner_count_, "face", "faces") + " with repeated vertices dropped");
  }
  if (short_polygon_count_ > 0) {
    notes_.push_back(counted(short_polygon_count_, "face", "faces") +
                     " with fewer than three corners dropped");
  }
}

}  // namespace vitruvian
