#pragma once

#include <Eigen/Core>
#include <cstdint>

namespace vitruvian {

using Vec3f = Eigen::Vector3f;
using Vec3d = Eigen::Vector3d;
using Mat3f = Eigen::Matrix3f;
using Mat3d = Eigen::Matrix3d;
using Mat4d = Eigen::Matrix4d;

/// Points or directions, one a column: 3 x N, contiguous xyz triples in memory.
using Points3f = Eigen::Matrix<float, 3, Eigen::Dynamic>;
using Points3d = Eigen::Matrix<double, 3, Eigen::Dynamic>;
/// Triangles, one a column: 3 x F indices into a Points3f, counter-clockwise seen from outside.
using Faces = Eigen::Matrix<std::int32_t, 3, Eigen::Dynamic>;
using Index = Eigen::Index;

}  // namespace vitruvian
