#pragma once

#include <cstdint>
#include <memory>
#include <nlohmann/json.hpp>
#include <vector>

#include "body/forward.h"
#include "geometry/mesh.h"
#include "io/scan.h"
#include "paint/canvas.h"
#include "pipeline/models.h"

namespace vitruvian::wasm {

/// What is painted on; lives in the session.
struct PaintContext {
  const Models& models;
  const Scan& scan;
  const DecimatedMesh& shown;  ///< the scan as the view draws it, relative to its origin
  const BodyState& posed;      ///< the body as the scan is known to stand, body frame
  Mat4d body_from_scan;
};

/// The page's painter: picks vertices of scan and template from the screen. The scan is picked vertex by
/// vertex of its file, however few of them the view draws. Requests and answers are JSON objects, typed in
/// web/src/paint/requests.ts; arrays of an answer stay valid until the next request.
class Painter {
 public:
  /// Whether a request is for the painter.
  static bool takes(const nlohmann::json& request);
  /// @param request  its member "do" names what is asked for.
  /// @throws Error(usage), Error(bad_file) naming what is wrong.
  nlohmann::json answer(const nlohmann::json& request, const PaintContext& context);
  /// Forgets what belongs to a scan or a model.
  void reset() { *this = {}; }

 private:
  /// A mesh to paint on, and the labels that parts are told by.
  struct Side {
    Points3f vertices;
    Faces faces;
    std::vector<int> source;  ///< number in the file of each vertex; empty: the same
    std::vector<std::uint8_t> segment;
    std::unique_ptr<PaintCanvas> canvas;
  };

  nlohmann::json show_scan(const nlohmann::json& request, const PaintContext& context);
  nlohmann::json show_template(const nlohmann::json& request, const PaintContext& context);
  nlohmann::json pick(const nlohmann::json& request, const PaintContext& context);
  nlohmann::json suggest(const PaintContext& context);
  const std::vector<std::uint8_t>& segments(const PaintContext& context);

  // Behind pointers: canvases refer to them.
  std::unique_ptr<Side> scan_, template_;
  DecimatedMesh rest_;  // of the shown scan, after cutting
  std::vector<int> picked_;
  std::vector<std::uint8_t> suggested_;
};

}  // namespace vitruvian::wasm
