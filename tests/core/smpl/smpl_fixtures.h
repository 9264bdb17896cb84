#pragma once

#include <gtest/gtest.h>

#include <string>

#include "body/forward.h"
#include "io/file.h"
#include "io/npz.h"
#include "smpl/read_model.h"

namespace vitruvian::testing {

/// Path of a file that tests/smpl/make_smpl_files.py wrote.
inline std::string smpl_file(const std::string& name) { return VITRUVIAN_SMPL_FILES "/" + name; }

inline BodyModel read_smpl_file(const std::string& name, const SmplOptions& options = {}) {
  const FileBytes file(smpl_file(name));
  return read_smpl_model(file.bytes(), smpl_file(name), options);
}

inline Eigen::VectorXd as_vector(const NumericArray& array) {
  return Eigen::Map<const Eigen::VectorXd>(array.values.data(), static_cast<Index>(array.values.size()));
}

/// What the published formulas give for a file: a state of the model, and its vertices.
struct Expected {
  BodyState state;
  Points3d vertices;

  Expected(const std::string& name, int betas) {
    const FileBytes file(smpl_file(name + ".expected.npz"));
    const NpzFile arrays(file.bytes(), name);
    const Eigen::VectorXd pose = as_vector(arrays.array("pose"));
    const Eigen::VectorXd given = as_vector(arrays.array("coefficients"));
    EXPECT_LE(given.size(), betas);
    Eigen::VectorXd coefficients = Eigen::VectorXd::Zero(betas);
    coefficients.head(given.size()) = given;
    state = BodyState::from_axis_angle(Eigen::Map<const Points3d>(pose.data(), 3, pose.size() / 3),
                                       coefficients, Vec3d::Zero());
    const Eigen::VectorXd flat = as_vector(arrays.array("vertices"));
    vertices = Eigen::Map<const Points3d>(flat.data(), 3, flat.size() / 3);
  }
};

}  // namespace vitruvian::testing
