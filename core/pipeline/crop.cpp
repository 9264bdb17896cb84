#include "pipeline/crop.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "base/error.h"

namespace vitruvian {
namespace {

using nlohmann::ordered_json;

constexpr std::size_t kMostCorners = 10'000;
constexpr int kLeastVertices = 4;

Mat4d invertible(const JsonValue& value) {
  const Mat4d matrix = value.matrix4();
  if (!Eigen::FullPivLU<Mat4d>(matrix).isInvertible()) value.fail("the matrix flattens the scan");
  return matrix;
}

Mat4d box_between(const JsonValue& value) {
  const Vec3d low = value.at("min").vector3(), high = value.at("max").vector3();
  if (!((high - low).minCoeff() > 0))
    value.fail("each number of \"max\" must be larger than that of \"min\"");
  Mat4d box_from_scan = Mat4d::Identity();
  for (int i = 0; i < 3; ++i) {
    const double half = (high[i] - low[i]) / 2;
    box_from_scan(i, i) = 1 / half;
    box_from_scan(i, 3) = -(low[i] + high[i]) / 2 / half;
  }
  return box_from_scan;
}

std::vector<Eigen::Vector2d> corners(const JsonValue& value) {
  if (value.size() < 3 || value.size() > kMostCorners)
    value.fail("3 to " + std::to_string(kMostCorners) + " corners are expected");
  std::vector<Eigen::Vector2d> polygon;
  for (std::size_t i = 0; i < value.size(); ++i) {
    const Eigen::VectorXd corner = value.at(i).numbers();
    if (corner.size() != 2) value.at(i).fail("two numbers [x, y] are expected");
    polygon.emplace_back(corner);
  }
  return polygon;
}

template <typename Matrix>
Matrix columns_kept(const Matrix& columns, const std::vector<int>& kept) {
  Matrix result(columns.rows(), static_cast<Index>(kept.size()));
  for (std::size_t i = 0; i < kept.size(); ++i) result.col(static_cast<Index>(i)) = columns.col(kept[i]);
  return result;
}

}  // namespace

CutVolume crop_from_json(const JsonValue& value) {
  CutVolume crop;
  const JsonValue remove = value.at("remove");
  const std::string side = remove.text();
  if (side != "inside" && side != "outside") remove.fail("inside or outside is expected");
  crop.remove = side == "inside" ? CutVolume::Remove::inside : CutVolume::Remove::outside;
  const int shapes = static_cast<int>(value.has("box")) + static_cast<int>(value.has("box_from_scan")) +
                     static_cast<int>(value.has("clip_from_scan"));
  if (shapes != 1) value.fail("one of box, box_from_scan, clip_from_scan is expected");
  if (value.has("clip_from_scan")) {
    crop.shape = CutVolume::Shape::lasso;
    crop.volume_from_scan = invertible(value.at("clip_from_scan"));
    crop.polygon = corners(value.at("polygon"));
    return crop;
  }
  if (value.has("box")) {
    crop.volume_from_scan = box_between(value.at("box"));
    return crop;
  }
  crop.volume_from_scan = invertible(value.at("box_from_scan"));
  if (crop.volume_from_scan.row(3) != Eigen::RowVector4d(0, 0, 0, 1))
    value.at("box_from_scan").fail("the last row must be 0 0 0 1");
  return crop;
}

ordered_json crop_to_json(const CutVolume& crop) {
  ordered_json result;
  result["remove"] = crop.remove == CutVolume::Remove::inside ? "inside" : "outside";
  if (crop.shape == CutVolume::Shape::box) {
    result["box_from_scan"] = rows(crop.volume_from_scan);
    return result;
  }
  result["clip_from_scan"] = rows(crop.volume_from_scan);
  result["polygon"] = ordered_json::array();
  for (const Eigen::Vector2d& corner : crop.polygon) result["polygon"].push_back(numbers(corner));
  return result;
}

std::vector<CutVolume> crops_from_json(const JsonValue& array) {
  std::vector<CutVolume> crops;
  for (std::size_t i = 0; i < array.size(); ++i) crops.push_back(crop_from_json(array.at(i)));
  return crops;
}

ordered_json crops_to_json(const std::vector<CutVolume>& crops) {
  ordered_json result = ordered_json::array();
  for (const CutVolume& crop : crops) result.push_back(crop_to_json(crop));
  return result;
}

std::vector<CutVolume> parse_crops(std::string_view text, const std::string& file_name) {
  const nlohmann::json json = parse_json(text, file_name);
  const JsonValue crops = JsonValue(json, file_name, "").at("crops");
  if (crops.size() == 0) crops.fail("there is no crop");
  return crops_from_json(crops);
}

CroppedScan crop_scan(const std::shared_ptr<const Scan>& scan, const std::vector<CutVolume>& crops) {
  if (crops.empty()) return {scan, {}};
  const std::vector<std::uint8_t> kept = uncut_points(crops, scan->vertices, scan->origin);
  CroppedScan result;
  for (std::size_t i = 0; i < kept.size(); ++i) {
    if (kept[i]) result.kept.push_back(static_cast<int>(i));
  }
  if (result.kept.size() < kLeastVertices) {
    throw Error(ErrorCode::usage, "--crop: it leaves " + std::to_string(result.kept.size()) +
                                      " vertices of " + scan->file_name + "; cut less away");
  }
  Scan rest;
  rest.file_name = scan->file_name;
  rest.format = scan->format;
  rest.sha256 = scan->sha256;
  rest.origin = scan->origin;
  rest.metres_per_unit = scan->metres_per_unit;
  rest.notes = scan->notes;
  rest.vertices = columns_kept(scan->vertices, result.kept);
  rest.faces = uncut_faces(scan->faces, kept);
  if (scan->faces.cols() > 0 && rest.faces.cols() == 0) {
    throw Error(ErrorCode::usage,
                "--crop: it leaves no face of " + scan->file_name + " whole; cut less away");
  }
  if (scan->normals.cols() == scan->vertices.cols()) rest.normals = columns_kept(scan->normals, result.kept);
  result.scan = std::make_shared<const Scan>(std::move(rest));
  return result;
}

}  // namespace vitruvian
