#include "cli/paths.h"

#include "base/error.h"
#include "core/cli/cli_fixture.h"

namespace vitruvian {
namespace {

TEST(OutputStem, IsTheNameWithoutGzAndOneExtension) {
  EXPECT_EQ(output_stem("/x/y/scan.ply"), "scan");
  EXPECT_EQ(output_stem("a.b.ply.gz"), "a.b");
  EXPECT_EQ(output_stem("a.PLY.GZ"), "a");
  EXPECT_EQ(output_stem("noextension"), "noextension");
  EXPECT_EQ(output_stem("a.gz"), "a");
  EXPECT_EQ(output_stem(".ply"), ".ply");
  EXPECT_EQ(output_stem("J\xc3\xb6rg \xe4\xba\xba.obj"), "J\xc3\xb6rg \xe4\xba\xba");
  for (const char* path : {"", "/", ".", "..", "folder/", "..gz", "a/.."})
    EXPECT_THROW(output_stem(path), Error) << path;
}

TEST(OutputFolders, RefusesTwoScansWithOneName) {
  EXPECT_EQ(output_folders({"a.ply", "x/b.obj"}, "out"), (std::vector<std::string>{"out/a", "out/b"}));
  try {
    output_folders({"a.ply", "b.ply", "x/a.stl.gz"}, "out");
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::usage);
    EXPECT_NE(std::string(error.what()).find("x/a.stl.gz"), std::string::npos) << error.what();
  }
}

class OutputFoldersTest : public CliTest {};

TEST_F(OutputFoldersTest, RefusesToOverwriteAScan) {
  const std::string scan = write_scan("registered/registered.ply");
  EXPECT_THROW(output_folders({scan}, path("")), Error);
  EXPECT_THROW(output_folders({path("other/../registered/./registered.ply")}, path("other/..")), Error);
  EXPECT_NO_THROW(output_folders({scan}, path("out")));
}

TEST_F(OutputFoldersTest, StaleOutputsGoAndEverythingElseStays) {
  for (const char* name : {"registration.json", "registered.obj", "errors.csv", "offsets.npz", "mine.txt"})
    write(name, "x");
  remove_stale_outputs(path(""), {"errors.csv"});
  EXPECT_FALSE(exists("registration.json"));
  EXPECT_FALSE(exists("registered.obj"));
  EXPECT_FALSE(exists("offsets.npz"));
  EXPECT_TRUE(exists("errors.csv"));
  EXPECT_TRUE(exists("mine.txt"));
  EXPECT_NO_THROW(remove_stale_outputs(path("not there"), {}));
}

TEST_F(OutputFoldersTest, DataFilesAreSearchedInTheContractsOrder) {
  const std::vector<std::string> folders = data_folders(path("bin"), path("data"));
  try {
    find_data_file(folders, "body.vbm");
    FAIL();
  } catch (const Error& error) {
    for (const char* words : {"bin/models", "share/vitruvian", "data", "scripts/start"}) {
      EXPECT_NE(std::string(error.what()).find(words), std::string::npos) << error.what();
    }
  }
  for (const char* place :
       {"data/body.vbm", "share/vitruvian/body.vbm", "bin/body.vbm", "bin/models/body.vbm"}) {
    write(place, "x");
    EXPECT_EQ(find_data_file(folders, "body.vbm"), path(place));
  }
  EXPECT_EQ(data_folders("bin", "").size(), 3u) << "an unset variable is no folder";
}

TEST(Printable, TakesOutControlCharacters) { EXPECT_EQ(printable("a\x1b[31m\n\xc3\xa4"), "a?[31m?\xc3\xa4"); }

}  // namespace
}  // namespace vitruvian
