#pragma once

#include <memory>
#include <nlohmann/json.hpp>

#include "editor/pose_preview.h"
#include "geometry/mesh.h"
#include "io/scan.h"
#include "pipeline/models.h"
#include "pipeline/pipeline.h"
#include "pipeline/settings.h"

namespace vitruvian::wasm {

/// What the editor works on; lives in the session.
struct EditorContext {
  const Models& models;
  const Scan& scan;
  const DecimatedMesh& shown;  ///< the scan as the view draws it, relative to its origin
  const Settings& settings;
  const RegistrationPipeline* pipeline;  ///< null before anything was worked
};

/// The page's editors: sight lines, left and right, the live preview, project files. Requests and answers are
/// JSON objects, typed in web/src/editor/requests.ts; arrays of an answer stay valid until the next request.
class Editor {
 public:
  /// @param request  its member "do" names what is asked for.
  /// @throws Error(usage), Error(bad_file) naming what is wrong.
  nlohmann::json answer(const nlohmann::json& request, const EditorContext& context);
  /// Forgets what belongs to a scan or a model.
  void reset() { preview_.reset(); }

 private:
  nlohmann::json preview(const nlohmann::json& request, const EditorContext& context);
  nlohmann::json cut(const nlohmann::json& request, const EditorContext& context);

  std::unique_ptr<PosePreview> preview_;
  VertexMatrix<float> body_;
  DecimatedMesh rest_;  // of the shown scan, after cutting
};

}  // namespace vitruvian::wasm
