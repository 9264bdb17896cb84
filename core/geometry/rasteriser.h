#pragma once

#include <vector>

#include "base/types.h"

namespace vitruvian {

/// Z-buffer of an orthographic picture. Screen space: x to the right and y down in pixels, pixel (i, j)
/// covers [i, i + 1) x [j, j + 1) and is sampled at its centre; z points to the viewer, so the larger z hides
/// the smaller.
struct Raster {
  int width, height;
  std::vector<float> depth;          ///< height x width, z of what is seen; -infinity where empty
  std::vector<std::int32_t> source;  ///< height x width, triangle or point index; -1 where empty
  std::vector<float> weight1;        ///< height x width, barycentric weight of the triangle's second vertex
  std::vector<float> weight2;        ///< ... of its third; the first vertex has the rest

  /// An empty picture. @throws Error(internal) when a side is not in 1..16384.
  Raster(int width, int height);
  std::size_t at(int x, int y) const { return static_cast<std::size_t>(y) * width + x; }
};

/// Draws triangles, both sides. Triangles with a non-finite corner or without area on screen are left out; of
/// equal depths the earlier triangle stays.
/// @param screen  3 x V in screen space.  @param faces  3 x F into `screen`.
void draw_triangles(Raster& raster, const Points3f& screen, const Faces& faces);

/// Draws each point as a disc across its normal, or facing the viewer where the normal is zero. Discs bulge a
/// little at their centres, so that of two overlapping ones on one surface each shows its own half. Smaller
/// than a pixel, a point still covers the pixel it lies in.
/// @param radii  V, pixels.  @param normals  3 x V unit or zero, screen axes, any sign; or empty: all face
/// the viewer.
void draw_discs(Raster& raster, const Points3f& screen, const Eigen::VectorXf& radii,
                const Points3f& normals);

/// Nearest and farthest depth of a picture: what a viewer sees from the front and from behind, in one pass.
struct DepthRange {
  int width, height;
  std::vector<float> nearest;   ///< largest z; -infinity where empty
  std::vector<float> farthest;  ///< smallest z; +infinity where empty

  DepthRange(int width, int height);
};
void draw_triangles(DepthRange& range, const Points3f& screen, const Faces& faces);
void draw_discs(DepthRange& range, const Points3f& screen, const Eigen::VectorXf& radii);

}  // namespace vitruvian
