#include "paint/canvas.h"

#include <algorithm>

#include "paint/parts.h"

namespace vitruvian {

const ScreenSelection& PaintCanvas::seen_by(const PaintCamera& camera) {
  if (!seen_ || camera_ != camera) {
    seen_.reset();
    seen_.emplace(*vertices_, *faces_, camera.clip_from_mesh, camera.width, camera.height);
    camera_ = camera;
  }
  return *seen_;
}

std::vector<int> PaintCanvas::brush(const PaintCamera& camera, const std::vector<ScreenPoint>& way,
                                    double radius) {
  const ScreenSelection& seen = seen_by(camera);
  std::vector<int> touched;
  for (std::size_t i = 0; i < way.size(); ++i) {
    const ScreenPoint& from = way[i == 0 ? 0 : i - 1];
    const std::vector<int> piece = seen.brush(from, way[i], radius);
    touched.insert(touched.end(), piece.begin(), piece.end());
  }
  std::sort(touched.begin(), touched.end());
  touched.erase(std::unique(touched.begin(), touched.end()), touched.end());
  return touched;
}

std::vector<int> PaintCanvas::lasso(const PaintCamera& camera, const std::vector<ScreenPoint>& outline) {
  return seen_by(camera).lasso(outline);
}

std::vector<int> PaintCanvas::part(const PaintCamera& camera, const ScreenPoint& point, double reach,
                                   std::span<const std::uint8_t> label) {
  const int start = seen_by(camera).nearest(point, reach);
  if (start < 0) return {};
  if (faces_->cols() > 0) return flood(*faces_, label, start);
  std::vector<int> same;
  for (int i = 0; i < static_cast<int>(label.size()); ++i) {
    if (label[static_cast<std::size_t>(i)] == label[static_cast<std::size_t>(start)]) same.push_back(i);
  }
  return same;
}

}  // namespace vitruvian
