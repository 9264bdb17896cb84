#pragma once

#include <memory>

#include "base/types.h"

namespace vitruvian {

struct SurfacePoint {
  int face = -1;
  Vec3f position = Vec3f::Zero();
  Vec3f barycentric = Vec3f::Zero();  ///< weights of the face's three vertices
  float distance = 0;
};

/// Exact closest point on a triangle mesh by a bounding volume hierarchy. Keeps its own copy of the
/// triangles. Queries are const and may run in parallel.
class ClosestPointOnMesh {
 public:
  ClosestPointOnMesh(const Points3f& vertices, const Faces& faces);
  ClosestPointOnMesh(ClosestPointOnMesh&&) noexcept;
  ClosestPointOnMesh& operator=(ClosestPointOnMesh&&) noexcept;
  ~ClosestPointOnMesh();

  /// @param limit  give up beyond this distance: `face` is then -1 and `distance` is `limit`.
  SurfacePoint query(const Vec3f& point, float limit = 1e30f) const;

 private:
  struct Hierarchy;
  std::unique_ptr<Hierarchy> hierarchy_;
};

}  // namespace vitruvian
