#include "pipeline/report.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>

#include "core/pipeline/sample_registration.h"

namespace vitruvian {
namespace {

TEST(Report, CsvHasARowASegmentAndNaWhereUnseen) {
  std::istringstream csv(errors_csv(*sample_registration().surface_error));
  std::string line;
  std::getline(csv, line);
  EXPECT_EQ(line, "segment,observed,count,mean_mm,std_mm,median_mm,p95_mm,max_mm");
  int rows = 0;
  while (std::getline(csv, line)) {
    EXPECT_EQ(std::count(line.begin(), line.end(), ','), 7) << line;
    if (rows == 0) {
      EXPECT_EQ(line, "hips,1.0000,100,0.7500,0.5000,1.2500,3.0000,9.0000");
    }
    if (rows == 22) {
      EXPECT_EQ(line, "left_hand_index,0.2500,NA,NA,NA,NA,NA,NA");
    }
    ++rows;
  }
  EXPECT_EQ(rows, 24);
}

TEST(Report, TellsVerdictReasonsAndUnseenParts) {
  const std::string text = report_text(sample_registration());
  for (const char* words :
       {"doubtful", "hardly seen in the scan: left hand index", "unit mm", "not seen", "right upper leg"}) {
    EXPECT_NE(text.find(words), std::string::npos) << words;
  }
}

TEST(Report, FailedRegistrationHasAReportToo) {
  Registration r;
  r.scan.file = "x.ply";
  r.verdict.reasons = {"no body was found"};
  EXPECT_NE(report_text(r).find("no body was found"), std::string::npos);
}

}  // namespace
}  // namespace vitruvian
