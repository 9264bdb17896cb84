#pragma once

#include <span>
#include <string>
#include <vector>

#include "anthropometry/landmarks.h"
#include "measure/surface_error_compute.h"
#include "measured/measurements_json.h"
#include "pipeline/registration.h"

namespace vitruvian {

/// A section of a profile with the curve it follows.
struct ProfileSection {
  SectionResult result;
  std::vector<Vec3d> course;  ///< closed, scan frame and units; empty where the plane misses the segment
};

/// A registered body, measured as registered and re-posed to the standard posture.
class MeasuredRegistration {
 public:
  /// Measures at once: 76 dimensions, 87 landmarks, 24 segments.
  /// @param registration  with parameters; it and the model it was made with must outlive this.
  /// @param rest_offsets  3 x V, added to the shaped vertices before posing; or empty.
  /// @param sha256        of registration.json.
  MeasuredRegistration(const Registration& registration, const BodyModel& body, Points3d rest_offsets,
                       std::string sha256);
  MeasuredRegistration(const MeasuredRegistration&) = delete;
  MeasuredRegistration& operator=(const MeasuredRegistration&) = delete;

  /// Takes the landmarks' confidence and the vertices' errors from the scan itself.
  void compare(const SurfaceMeasurement& surface);
  /// The vertices' errors alone, mm, V.
  void set_vertex_errors(std::vector<float> error_mm) { vertex_error_mm_ = std::move(error_mm); }
  void add_section(const SectionResult& section) { report_.sections.push_back(section); }

  const Registration& registration() const { return registration_; }
  const BodyModel& body() const { return model_.body(); }
  const BodyState& state() const { return state_; }
  const Points3d& rest_offsets() const { return rest_offsets_; }
  const Figure& scanned() const { return scanned_; }    ///< as registered, body frame
  const Figure& standing() const { return standing_; }  ///< standard posture, its pelvis at the origin's
  const Figure& seated() const { return seated_; }      ///< likewise, sitting
  const MeasurementReport& report() const { return report_; }
  /// V, distance to the scan's surface; empty without a scan.
  const std::vector<float>& vertex_error_mm() const { return vertex_error_mm_; }

  /// The standing or sitting body's vertices where the scanned one is: same floor, pelvis above the same
  /// spot. 3 x V, body frame, metres.
  Points3d in_place(Posture posture) const;
  /// Where a dimension lies on its body (as in in_place()), scan frame and units.
  std::vector<Vec3d> course_in_scan(const Dimension& dimension) const;
  /// The paper's sweep with its curves.
  std::vector<ProfileSection> profile(int segment, int count) const;

 private:
  const Figure& figure(Posture posture) const;
  Vec3d shift(Posture posture) const;
  Vec3d in_scan(const Vec3d& body_m) const;

  const Registration& registration_;
  MeasuredModel model_;
  LandmarkSet landmarks_;
  BodyState state_;
  Points3d rest_offsets_;
  Figure scanned_, standing_, seated_;
  Mat4d scan_from_body_;
  MeasurementReport report_;
  std::vector<float> vertex_error_mm_;
};

}  // namespace vitruvian
