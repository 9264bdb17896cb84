#include "cli/progress.h"

#include <gtest/gtest.h>

#include <cmath>
#include <sstream>

#include "cli/table.h"

namespace vitruvian {
namespace {

TEST(Progress, LinesNameEachStageOnce) {
  std::ostringstream stream;
  Progress progress(stream, ProgressStyle::lines, 2);
  progress.begin_scan(2, "b.ply");
  for (const double f : {0.0, 0.5, 1.0}) progress.update("align", f);
  progress.update("fit", 0);
  progress.end_scan("ok");
  EXPECT_EQ(stream.str(), "[2/2] b.ply: align\n[2/2] b.ply: fit\n[2/2] b.ply: ok\n");
}

TEST(Progress, BarNeverRunsBackwardAndIsCleared) {
  std::ostringstream stream;
  Progress progress(stream, ProgressStyle::bar, 1);
  progress.begin_scan(1, "a\nb.ply");
  progress.update("fit", 0.5);
  progress.update("align", 0);
  const std::string text = stream.str();
  EXPECT_EQ(text.find('\n'), std::string::npos);
  EXPECT_NE(text.find("75 % fit"), std::string::npos) << text;
  EXPECT_NE(text.find("75 % align"), std::string::npos) << text;
  progress.end_scan("ok");
  EXPECT_NE(stream.str().find("\r\x1b[Ka?b.ply: ok\n"), std::string::npos);
}

TEST(Progress, QuietSaysNothing) {
  std::ostringstream stream;
  Progress progress(stream, ProgressStyle::none, 1);
  progress.begin_scan(1, "a");
  progress.update("fit", 0.5);
  progress.end_scan("ok");
  EXPECT_EQ(stream.str(), "");
}

TEST(Progress, OverallFractionRisesThroughTheStages) {
  double last = -1;
  for (const char* stage :
       {"read", "align", "project", "detect", "pose", "fit", "refine", "detail", "write"}) {
    for (const double f : {0.0, 0.5, 0.99}) {
      EXPECT_GT(overall_fraction(stage, f), last);
      last = overall_fraction(stage, f);
    }
  }
  EXPECT_EQ(overall_fraction("write", 2), 1);
  EXPECT_EQ(overall_fraction("read", std::nan("")), 0);
  EXPECT_EQ(overall_fraction("unknown", 1), 0);
}

TEST(TextTable, AlignsByCharacters) {
  EXPECT_EQ(text_table({{"scan", "mm", "remark"}, {"J\xc3\xb6rg", "12.5", "x"}, {"b", "", ""}}),
            "scan    mm  remark\nJ\xc3\xb6rg  12.5  x\nb           \n");
  EXPECT_EQ(text_table({}), "");
}

}  // namespace
}  // namespace vitruvian
