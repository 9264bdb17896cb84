#include "painter.h"

#include <string>
#include <utility>

#include "base/error.h"
#include "paint/parts.h"
#include "pipeline/crop.h"
#include "pipeline/regions.h"
#include "session_json.h"

namespace vitruvian::wasm {
namespace {

using nlohmann::json;

/// Within which a scan's vertex may belong to the nearest part of the posed body: a coat's distance.
constexpr float kReach_m = 0.08f;
/// Of the pointer, in pixels: coarse scans have vertices far from each other.
constexpr double kPointerReach = 40;

JsonValue value_of(const json& request) { return {request, "painter", ""}; }

template <typename Array>
json reference(const Array& array) {
  return array_reference(array.data(), static_cast<std::ptrdiff_t>(array.size()));
}

std::vector<ScreenPoint> way_of(const JsonValue& points) {
  std::vector<ScreenPoint> way;
  for (std::size_t i = 0; i < points.size(); ++i) {
    way.emplace_back(points.at(i).at(0).number(), points.at(i).at(1).number());
  }
  if (way.empty()) points.fail("a point of the screen is expected");
  return way;
}

PaintCamera camera_of(const JsonValue& value) {
  constexpr int kMostPixels = 16384;
  return {value.at("clip_from_mesh").matrix4(), static_cast<int>(value.at("width").whole(1, kMostPixels)),
          static_cast<int>(value.at("height").whole(1, kMostPixels))};
}

/// What `crops` leave of a mesh, with the numbers that its vertices had.
struct Rest {
  Points3f vertices;
  Faces faces;
  std::vector<int> kept;
};
Rest uncut(const std::vector<CutVolume>& crops, const Points3f& vertices, const Faces& faces,
           const Vec3d& origin) {
  const std::vector<std::uint8_t> kept = uncut_points(crops, vertices, origin);
  Rest rest;
  rest.faces = uncut_faces(faces, kept);
  for (std::size_t i = 0; i < kept.size(); ++i) {
    if (kept[i]) rest.kept.push_back(static_cast<int>(i));
  }
  rest.vertices = vertices(Eigen::all, rest.kept);
  return rest;
}

json import_regions(const json& request, const PaintContext& context) {
  const RegionSet regions =
      parse_regions(value_of(request).at("text").text(), value_of(request).at("name").text());
  region_labels(regions, context.scan, context.models.body);  // refuses those of another scan or model
  return {{"regions", regions_to_json(regions)}};
}

}  // namespace

bool Painter::takes(const json& request) {
  const std::string what = value_of(request).at("do").text();
  return what.rfind("paint_", 0) == 0 || what == "import_regions";
}

json Painter::show_scan(const json& request, const PaintContext& context) {
  const std::vector<CutVolume> crops = crops_from_json(value_of(request).at("crops"));
  const Scan& scan = context.scan;
  scan_ = std::make_unique<Side>();
  if (crops.empty()) {
    rest_ = context.shown;
    scan_->canvas = std::make_unique<PaintCanvas>(scan.vertices, scan.faces);
  } else {
    Rest whole = uncut(crops, scan.vertices, scan.faces, scan.origin);
    scan_->vertices = std::move(whole.vertices);
    scan_->faces = std::move(whole.faces);
    scan_->source = std::move(whole.kept);
    scan_->canvas = std::make_unique<PaintCanvas>(scan_->vertices, scan_->faces);
    const DecimatedMesh& shown = context.shown;
    Rest drawn = uncut(crops, shown.vertices, shown.faces, scan.origin);
    rest_.vertices = std::move(drawn.vertices);
    rest_.faces = std::move(drawn.faces);
    rest_.normals = shown.normals(Eigen::all, drawn.kept);
    rest_.source.clear();
    for (const int i : drawn.kept) rest_.source.push_back(shown.source[static_cast<std::size_t>(i)]);
  }
  return {{"positions", reference(rest_.vertices)}, {"normals", reference(rest_.normals)},
          {"indices", reference(rest_.faces)},      {"source", reference(rest_.source)},
          {"vertices", scan.vertices.cols()},       {"sha256", scan.sha256}};
}

json Painter::show_template(const json& request, const PaintContext& context) {
  const BodyModel& body = context.models.body;
  BodyState state = context.posed;
  const JsonValue stance = value_of(request).at("stance");
  if (stance.text() == "rest") {
    const BodyState rest = BodyState::rest(body);
    state.rotation = rest.rotation;
    state.translation = rest.translation;
  } else if (stance.text() != "posed") {
    stance.fail("\"posed\" or \"rest\" is expected");
  }
  template_ = std::make_unique<Side>();
  template_->vertices = posed_vertices<float>(body, state);
  template_->canvas = std::make_unique<PaintCanvas>(template_->vertices, body.faces);
  return {{"positions", reference(template_->vertices)},
          {"indices", reference(body.faces)},
          {"vertices", body.vertex_count()},
          {"sha256", body.sha256}};
}

const std::vector<std::uint8_t>& Painter::segments(const PaintContext& context) {
  if (scan_->segment.empty()) {
    const BodyModel& body = context.models.body;
    const Points3f& vertices = scan_->source.empty() ? context.scan.vertices : scan_->vertices;
    const Mat4d& m = context.body_from_scan;
    const Vec3d shift =
        m.topLeftCorner<3, 3>() * context.scan.origin + m.topRightCorner<3, 1>();  // of vertices' origin
    const Points3f in_body =
        (m.topLeftCorner<3, 3>().cast<float>() * vertices).colwise() + shift.cast<float>();
    scan_->segment =
        scan_segments(in_body, posed_vertices<float>(body, context.posed), body.segment, kReach_m);
  }
  return scan_->segment;
}

json Painter::pick(const json& request, const PaintContext& context) {
  const JsonValue value = value_of(request);
  const JsonValue side = value.at("side");
  const bool on_scan = side.text() == "scan";
  if (!on_scan && side.text() != "template") side.fail("\"scan\" or \"template\" is expected");
  Side* const painted = on_scan ? scan_.get() : template_.get();
  if (!painted) throw Error(ErrorCode::internal, "the painter was not opened");
  const PaintCamera camera = camera_of(value.at("camera"));
  const std::vector<ScreenPoint> way = way_of(value.at("way"));
  const JsonValue tool = value.at("with");
  if (tool.text() == "brush") {
    picked_ = painted->canvas->brush(camera, way, value.at("radius").number());
  } else if (tool.text() == "lasso") {
    picked_ = painted->canvas->lasso(camera, way);
  } else if (tool.text() == "part") {
    const std::vector<std::uint8_t>& segment = on_scan ? segments(context) : context.models.body.segment;
    picked_ = painted->canvas->part(camera, way.back(), kPointerReach, segment);
  } else {
    tool.fail("\"brush\", \"lasso\" or \"part\" is expected");
  }
  if (!painted->source.empty()) {
    for (int& i : picked_) i = painted->source[static_cast<std::size_t>(i)];
  }
  return {{"vertices", reference(picked_)}};
}

json Painter::suggest(const PaintContext& context) {
  if (!scan_) throw Error(ErrorCode::internal, "the painter was not opened");
  const std::vector<std::uint8_t>& segment = segments(context);
  suggested_.assign(static_cast<std::size_t>(context.scan.vertices.cols()), kNoSegment);
  for (std::size_t i = 0; i < segment.size(); ++i) {
    suggested_[scan_->source.empty() ? i : static_cast<std::size_t>(scan_->source[i])] = segment[i];
  }
  return {{"names", kSegmentNames},
          {"scan", reference(suggested_)},
          {"template", reference(context.models.body.segment)}};
}

json Painter::answer(const json& request, const PaintContext& context) {
  const std::string what = value_of(request).at("do").text();
  if (what == "paint_scan") return show_scan(request, context);
  if (what == "paint_template") return show_template(request, context);
  if (what == "paint_pick") return pick(request, context);
  if (what == "paint_suggest") return suggest(context);
  if (what == "import_regions") return import_regions(request, context);
  throw Error(ErrorCode::internal, "the painter does not know \"" + what + "\"");
}

}  // namespace vitruvian::wasm
