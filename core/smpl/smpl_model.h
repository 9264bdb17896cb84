#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "body/model.h"

namespace vitruvian {

/// How many coefficients are kept of a model file; kEveryBeta: all.
inline constexpr int kEveryBeta = -1;
struct SmplOptions {
  int betas = 0;         ///< shape components; 0: all that there are, at most 16
  int expressions = 10;  ///< facial expression components of SMPL-X
};

/// Reads a model file of the SMPL family: SMPL 1.0 and 1.1, SMPL+H, SMPL-X and STAR, as a pickle or a NumPy
/// archive. The family is told by the number of joints and pose correctives. Segments, shape priors
/// (standard normal, as these models define their betas) and joint names are made here.
///
/// SMPL-X's shape directions hold up to 300 of shape, then expression (of files with at most 300 columns: 10
/// of shape). STAR's last corrective column, which its authors multiply by beta[1], becomes part of that
/// beta's shape direction after the joints have been regressed.
/// @param file_name  its path; names the model and, when it says so, its gender.
/// @throws Error(bad_model, bad_file, unsupported_format) naming the file, the array and what is wrong.
BodyModel read_smpl_model(std::span<const std::byte> bytes, const std::string& file_name,
                          const SmplOptions& options);

/// Adds the soft-tissue components of a DMPL file (array `eigvec`, V x 3 x n) as further coefficients. Their
/// prior is centred at 0 with 3 mm of root mean square displacement a component.
/// @throws Error(bad_model, bad_file, unsupported_format) when the file is damaged or for another mesh.
void add_dmpl(BodyModel& model, std::span<const std::byte> bytes, const std::string& file_name,
              int components = 8);

}  // namespace vitruvian
