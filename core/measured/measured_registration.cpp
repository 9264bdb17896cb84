#include "measured/measured_registration.h"

#include <Eigen/LU>
#include <utility>

#include "anthropometry/posture.h"
#include "anthropometry/seated.h"
#include "pipeline/body_parameters.h"

namespace vitruvian {
namespace {

const BodyParameters& known_parameters(const Registration& registration) {
  if (!registration.parameters) {
    throw Error(ErrorCode::usage, "the registration failed and has no body to measure");
  }
  return *registration.parameters;
}

/// The registered shape, with the mouth shut.
Eigen::VectorXd calm_shape(const BodyModel& body, BodyParameters parameters) {
  parameters.expression.setZero();
  return state_of(body, parameters).betas;
}

/// The rows of surface_segments by segment.
std::array<const SegmentError*, kSegmentCount> error_rows(const Registration& registration) {
  std::array<const SegmentError*, kSegmentCount> rows{};
  if (!registration.surface_error) return rows;
  for (const SegmentError& row : registration.surface_error->surface_segments) {
    const int segment = segment_named(row.segment);
    if (segment >= 0) rows[static_cast<std::size_t>(segment)] = &row;
  }
  return rows;
}

FitErrors fit_errors(const Registration& registration) {
  const auto rows = error_rows(registration);
  FitErrors errors;
  for (std::size_t s = 0; s < rows.size(); ++s) {
    if (rows[s] && rows[s]->statistics) errors[s] = 1e-3 * rows[s]->statistics->mean_mm;
  }
  return errors;
}

/// From the very vertices that the landmark lies between.
double local_confidence(const SurfaceLandmark& landmark, const SurfaceMeasurement& surface) {
  double observed = 0, error = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const auto v = static_cast<std::size_t>(landmark.vertex[k]);
    observed += landmark.weight[static_cast<Index>(k)] * surface.observed[v];
    error += landmark.weight[static_cast<Index>(k)] * surface.surface_distance_m[v];
  }
  return landmark_confidence(observed, error);
}

}  // namespace

MeasuredRegistration::MeasuredRegistration(const Registration& registration, const BodyModel& body,
                                           Points3d rest_offsets, std::string sha256)
    : registration_(registration),
      model_(body),
      landmarks_(model_),
      state_(state_of(body, known_parameters(registration))),
      rest_offsets_(std::move(rest_offsets)),
      scanned_(model_, state_, rest_offsets_),
      standing_(model_, standard_posture(model_, calm_shape(body, *registration.parameters)), rest_offsets_),
      seated_(model_, seated_posture(model_, calm_shape(body, *registration.parameters)), rest_offsets_),
      scan_from_body_(registration.alignment.body_from_scan.inverse()) {
  report_.registration_sha256 = std::move(sha256);
  report_.body = measure_body(scanned_);
  const FitQuality fit{fit_errors(registration), rest_offsets_.cols() > 0};
  report_.dimensions = measure_dimensions(standing_, scanned_, landmarks_, fit);
  for (Dimension& seated : measure_seated(seated_, landmarks_, fit)) {
    report_.dimensions.push_back(std::move(seated));
  }
  const auto rows = error_rows(registration);
  for (const SurfaceLandmark& landmark : landmarks_.all()) {
    LandmarkReport row{std::string(landmark.name), landmark.position(scanned_.vertices), Vec3d::Zero(),
                       std::nullopt};
    row.scan = in_scan(row.body_m);
    if (const SegmentError* error = rows[static_cast<std::size_t>(landmark.segment)]) {
      row.confidence =
          error->statistics ? landmark_confidence(error->observed, 1e-3 * error->statistics->mean_mm) : 0.0;
    }
    report_.landmarks.push_back(std::move(row));
  }
}

void MeasuredRegistration::compare(const SurfaceMeasurement& surface) {
  for (std::size_t i = 0; i < report_.landmarks.size(); ++i) {
    report_.landmarks[i].confidence = local_confidence(landmarks_.all()[i], surface);
  }
  vertex_error_mm_.clear();
  for (const float distance : surface.surface_distance_m) vertex_error_mm_.push_back(1e3f * distance);
}

const Figure& MeasuredRegistration::figure(Posture posture) const {
  return posture == Posture::standing ? standing_ : posture == Posture::sitting ? seated_ : scanned_;
}

Vec3d MeasuredRegistration::shift(Posture posture) const {
  const Figure& own = figure(posture);
  const Vec3d there = scanned_.axes[0].proximal, here = own.axes[0].proximal;
  return {there.x() - here.x(), scanned_.vertices.row(1).minCoeff() - own.vertices.row(1).minCoeff(),
          there.z() - here.z()};
}

Points3d MeasuredRegistration::in_place(Posture posture) const {
  return figure(posture).vertices.colwise() + shift(posture);
}

Vec3d MeasuredRegistration::in_scan(const Vec3d& body_m) const {
  return scan_from_body_.topLeftCorner<3, 3>() * body_m + scan_from_body_.topRightCorner<3, 1>();
}

std::vector<Vec3d> MeasuredRegistration::course_in_scan(const Dimension& dimension) const {
  const Vec3d moved = shift(dimension.posture);
  std::vector<Vec3d> course;
  for (const Vec3d& corner : dimension.course) course.push_back(in_scan(corner + moved));
  return course;
}

std::vector<ProfileSection> MeasuredRegistration::profile(int segment, int count) const {
  std::vector<ProfileSection> profile;
  for (const SectionResult& result : section_profile(scanned_, segment, count)) {
    ProfileSection section{result, {}};
    if (const auto loop = segment_section(scanned_, segment, section.result.t)) {
      for (const SectionPoint& point : loop->points) section.course.push_back(in_scan(point.position));
      if (loop->closed && !section.course.empty()) section.course.push_back(section.course.front());
    }
    profile.push_back(std::move(section));
  }
  return profile;
}

}  // namespace vitruvian
