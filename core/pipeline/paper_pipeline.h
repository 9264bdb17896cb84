#pragma once

#include <functional>
#include <optional>
#include <string_view>
#include <vector>

#include "fit/chamfer.h"
#include "fit/fit_model.h"
#include "fit/paper_solver.h"
#include "pipeline/models.h"
#include "pipeline/registration.h"
#include "pipeline/settings.h"

namespace vitruvian {

// The published pipeline. Its first stages are those of our own under other settings: section 3.1.1 (PCA
// alignment) is align_pca(), 3.1.2 (two projections) paper_cameras(), 3.1.3 (keypoints) lift_two_views(),
// appendix B correct_left_right(), appendix A smpl_joints(). Here are the rest, in the paper's order.

/// Section 3.1.4, "Inverse Kinematics with VPoser": (beta_0, theta_0) from the 22 keypoints in the body
/// frame.
/// @param start_translation  where the search starts, root unturned, as published: the template's centroid on
///                           the scan's; without it the trunk is laid on its keypoints first.
/// @throws Error(no_geometry) with fewer than three keypoints.
BodyState paper_pose(const FitModel& model, const std::vector<Keypoint>& keypoints,
                     const std::optional<Vec3d>& start_translation, const Execution& execution);

/// Told after every iteration of the published solver: which curve ("distance", "correspondence 1" or
/// "correspondence 2"), the iteration's number from 1, and the energy before it.
using EnergyTrace = std::function<void(std::string_view curve, int iteration, double energy)>;

/// Section 3.2, "Distance Minimization": (beta*, theta*) from a start. Progress: "fit".
/// @param scan_points  3 x N, body frame, all of the scan's vertices.
PaperFit paper_distance_fit(const FitModel& model, const Points3f& scan_points, const RegionLabels& regions,
                            const BodyState& start, const Settings& settings, const Execution& execution,
                            const EnergyTrace& trace = {});

struct PaperRefinement {
  PaperFit first_pass;
  PaperFit second_pass;      ///< "a single additional pass"; its state is (beta**, theta**)
  std::vector<int> matches;  ///< scan point of each template vertex in the last pass
};

/// Section 3.3, "Correspondence Finetuning": rematching and final parameter fitting, and both once more.
/// Progress: "refine".
PaperRefinement paper_correspondence_fit(const FitModel& model, const Points3f& scan_points,
                                         const RegionLabels& regions, const BodyState& start,
                                         const Settings& settings, const Execution& execution,
                                         const EnergyTrace& trace = {});

/// Correspondence rematching (section 3.3.1) with each region pair by itself.
std::vector<int> rematch_regions(const Points3f& template_vertices, const Points3f& scan_points,
                                 const RegionLabels& regions, const Execution& execution);

}  // namespace vitruvian
