#pragma once

#include "base/execution.h"
#include "body/forward.h"
#include "geometry/scan_surface.h"

namespace vitruvian {

struct DetailSettings {
  int iterations = 10;
  int scan_samples = 60000;
  double reach_begin = 0.040, reach_end = 0.015;          ///< m, of the search for counterparts
  double robust_begin = 0.030, robust_end = 0.006;        ///< m, scale of the robust weights
  double smoothing_begin = 0.050, smoothing_end = 0.006;  ///< m, see Smoothness
  std::uint32_t seed = 1;
};

/// Free-form refinement of a fitted body: one offset a vertex, so that the body meets the scan where that saw
/// something, follows smoothly where it did not, and fades to the parametric body far from all observations.
///
/// A non-rigid ICP from stiff to soft (Amberg, Romdhani, Vetter 2007): in each iteration the scan draws at
/// the posed vertices (scan_pull.h), and displacements are solved for against a plate and membrane energy
/// (surface_energy.h). It is solved in the posed frame, where the scan is and where lengths are true,
/// relative to the parametric body, so that iterations do not drift; the result is taken back through each
/// vertex's skinning. Triangles never face against those of the parametric body (folds.h).
///
/// @param scan  body frame, metres.
/// @return 3 x V, metres, rest frame: added to the rest vertices before skinning.
/// @throws Error(cancelled).
Points3f vertex_offsets(const BodyModel& model, const BodyState& state, const ScanSurface& scan,
                        const DetailSettings& settings, const Execution& execution);

}  // namespace vitruvian
