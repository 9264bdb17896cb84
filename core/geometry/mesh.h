#pragma once

#include <vector>

#include "base/execution.h"
#include "base/types.h"

namespace vitruvian {

/// Area-weighted vertex normals, unit length; zero for vertices without a face of positive area. Faces
/// counter-clockwise seen from outside give outward normals.
Points3f vertex_normals(const Points3f& vertices, const Faces& faces);

/// Third of the area of the incident triangles, a vertex.
Eigen::VectorXf vertex_areas(const Points3f& vertices, const Faces& faces);

/// Vertices on the rims of an open mesh, in rising order: those of edges that one triangle alone has. Rims
/// whose bounding box has a diagonal below `least_extent` are cracks and left out.
std::vector<int> rim_vertices(const Points3f& vertices, const Faces& faces, float least_extent);

/// Volume enclosed by a closed mesh, signed: positive when faces are counter-clockwise seen from outside.
double signed_volume(const Points3f& vertices, const Faces& faces);

/// Normals of a bare point cloud: PCA of `neighbours` nearest points, oriented outward by a majority that
/// propagates from the hull inwards along a minimum spanning tree of the neighbour graph.
Points3f point_cloud_normals(const Points3f& points, int neighbours, const Execution& execution);

/// Points on a surface with normals and the triangle (or point) each came from.
struct SurfaceSamples {
  Points3f points;
  Points3f normals;
  std::vector<int> source;  ///< triangle index, or point index for clouds
};

/// `count` points spread uniformly by area over the triangles (stratified, seeded), normals interpolated.
SurfaceSamples sample_surface(const Points3f& vertices, const Faces& faces, const Points3f& normals,
                              int count, std::uint32_t seed);

/// Vertex-clustered copy with about `target_vertices` vertices (cells of one size); degenerate faces dropped.
/// With no faces, a thinned cloud. `source` maps each new vertex to one of its originals (the one nearest the
/// cell's mean).
struct DecimatedMesh {
  Points3f vertices;
  Points3f normals;
  Faces faces;
  std::vector<int> source;
};
DecimatedMesh cluster_decimate(const Points3f& vertices, const Points3f& normals, const Faces& faces,
                               int target_vertices);

}  // namespace vitruvian
