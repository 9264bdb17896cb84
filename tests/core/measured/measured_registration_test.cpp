#include "measured/measured_registration.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <nlohmann/json.hpp>
#include <set>

#include "core/anthropometry/measured_body.h"
#include "measured/export_files.h"
#include "measured/report.h"

namespace vitruvian {
namespace {

using nlohmann::json;

/// A registration of the default body, of a scan in millimetres that is turned and moved.
Registration registration_of(double first_beta) {
  const BodyModel& body = testing::made_body();
  Registration r;
  r.scan.file = "a <scan> & more.ply";
  r.alignment.body_from_scan = Mat4d::Identity();
  r.alignment.body_from_scan.topLeftCorner<3, 3>() << 0, 1e-3, 0, 0, 0, 1e-3, 1e-3, 0, 0;
  r.alignment.body_from_scan.topRightCorner<3, 1>() << 0.3, -0.2, 0.1;
  r.parameters =
      BodyParameters{BodyState::rest(body).betas, Points3d::Zero(3, body.joint_count()), Vec3d(1, 0, 0)};
  r.parameters->betas[0] = first_beta;
  return r;
}

MeasuredRegistration measured(const Registration& registration, const Points3d& offsets = Points3d(3, 0)) {
  return {registration, testing::made_body(), offsets, "0"};
}

TEST(MeasuredRegistration, PutsTheReposedBodiesWhereTheScanStands) {
  const Registration registration = registration_of(1);
  const MeasuredRegistration m = measured(registration);
  const double floor = m.scanned().vertices.row(1).minCoeff();
  for (const Posture posture : {Posture::standing, Posture::sitting, Posture::scanned}) {
    const Points3d there = m.in_place(posture);
    EXPECT_NEAR(there.row(1).minCoeff(), floor, 1e-12) << "on the same floor";
    EXPECT_LT(std::abs(there.row(0).mean() - m.scanned().vertices.row(0).mean()), 0.02);
  }
  EXPECT_LT((m.in_place(Posture::scanned) - m.scanned().vertices).norm(), 1e-12);
}

TEST(MeasuredRegistration, GivesCoursesInTheScansFrameAndUnits) {
  const Registration registration = registration_of(0);
  const MeasuredRegistration m = measured(registration);
  std::set<Posture> seen;
  for (const Dimension& d : m.report().dimensions) {
    seen.insert(d.posture);
    const std::vector<Vec3d> course = m.course_in_scan(d);
    ASSERT_EQ(course.size(), d.course.size()) << d.id;
    double in_body = 0, in_scan = 0;
    for (std::size_t i = 1; i < course.size(); ++i) {
      in_body += (d.course[i] - d.course[i - 1]).norm();
      in_scan += (course[i] - course[i - 1]).norm();
    }
    EXPECT_NEAR(in_scan, 1e3 * in_body, 1e-6) << d.id;
    if (d.course_kind != CourseKind::height) continue;
    EXPECT_NEAR(in_scan, 1e3 * d.value_m, 1e-6) << d.id;
  }
  EXPECT_EQ(seen.size(), 3u) << "standing, sitting and as scanned";
}

TEST(MeasuredRegistration, CountsVertexOffsets) {
  const Registration registration = registration_of(0);
  const Points3d wider =
      Eigen::Vector3d(0, 0, 0.02).asDiagonal() * testing::made_body().v_template.cast<double>();
  const MeasuredRegistration plain = measured(registration), refined = measured(registration, wider);
  EXPECT_NEAR(refined.report().body.volume_m3 / plain.report().body.volume_m3, 1.02, 2e-3);
}

TEST(MeasuredRegistration, WritesNoNumberThatIsNotFinite) {
  const Registration registration = registration_of(-2);
  const MeasuredRegistration m = measured(registration);
  const json document = json::parse(measurements_json(m.report(), JsonStyle::pretty));
  for (const json& row : document["dimensions"]) {
    EXPECT_TRUE(row["value_mm"].is_number()) << row;
    EXPECT_TRUE(row["uncertainty_mm"].is_null()) << "nothing is known of the fit: " << row;
    EXPECT_TRUE(row["uncertainty_source"].is_null());
  }
}

TEST(Report, StandsAloneAndDefinesEveryDimension) {
  const Registration registration = registration_of(1);
  const MeasuredRegistration m = measured(registration);
  const std::string html = measured_report(m);
  for (const char* foreign :
       {"http:", "https:", "//", "src=", "href=", "<script", "<link", "@import", "url("})
    EXPECT_EQ(html.find(foreign), std::string::npos) << foreign;
  EXPECT_EQ(html.find("<scan>"), std::string::npos) << "the file's name is text";
  for (const char* unknown : {"nan", ">inf", "-inf"})
    EXPECT_EQ(html.find(unknown), std::string::npos) << unknown;
  for (const Dimension& d : m.report().dimensions) {
    EXPECT_NE(html.find(d.definition), std::string::npos) << d.id;
  }
  std::size_t plots = 0;
  for (std::size_t at = 0; (at = html.find("<svg class=\"plot\"", at)) != std::string::npos; ++at) ++plots;
  EXPECT_EQ(plots, 6u);
}

TEST(ExportFiles, MakesEveryFormatAndNoOther) {
  const Registration registration = registration_of(0);
  const MeasuredRegistration m = measured(registration);
  for (const std::string_view format : export_formats()) {
    const std::vector<ExportedFile> files = export_files(format, m);
    EXPECT_FALSE(files.empty()) << format;
    for (const ExportedFile& file : files) EXPECT_GT(file.content.size(), 20u) << file.name;
  }
  EXPECT_THROW(export_files("fbx", m), Error);
}

}  // namespace
}  // namespace vitruvian
