#include "io/file.h"

#include <dirent.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdlib>
#include <functional>

#include "core/io/test_files.h"

namespace vitruvian::test {
namespace {

/// A folder of its own, removed at the end.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    const char* base = std::getenv("TMPDIR");
    path_ = std::string(base ? base : "/tmp") + "/vitruvian-io-XXXXXX";
    EXPECT_NE(::mkdtemp(path_.data()), nullptr);
  }
  ~TemporaryFolder() { remove(path_); }
  const std::string& path() const { return path_; }

  static std::vector<std::string> names(const std::string& folder) {
    std::vector<std::string> result;
    DIR* directory = ::opendir(folder.c_str());
    if (!directory) return result;
    while (const dirent* entry = ::readdir(directory)) {
      const std::string name = entry->d_name;
      if (name != "." && name != "..") result.push_back(name);
    }
    ::closedir(directory);
    return result;
  }

 private:
  static void remove(const std::string& folder) {
    for (const std::string& name : names(folder)) {
      const std::string path = folder + "/" + name;
      if (::unlink(path.c_str()) != 0) remove(path);
    }
    ::rmdir(folder.c_str());
  }
  std::string path_;
};

ErrorCode code_of(const std::function<void()>& action) {
  try {
    action();
  } catch (const Error& error) {
    return error.code();
  }
  ADD_FAILURE() << "no error";
  return ErrorCode::internal;
}

TEST(File, WritesWholeAndReadsBackUnderUnicodeNames) {
  const TemporaryFolder folder;
  const std::string path = folder.path() + "/Ärzte & 人体 scan.ply";
  for (const std::string& content : {std::string("first"), std::string(), binary_ply(false)}) {
    write_file(path, content);
    const FileBytes file(path);
    const auto bytes = file.bytes();
    EXPECT_EQ(std::string(reinterpret_cast<const char*>(bytes.data()), bytes.size()), content);
  }
  EXPECT_EQ(TemporaryFolder::names(folder.path()).size(), 1u) << "no temporary file is left";
  const Scan scan = read_scan_file(path, Execution(2));
  EXPECT_EQ(scan.file_name, "Ärzte & 人体 scan.ply");
  EXPECT_EQ(scan.vertices.cols(), 8);
}

TEST(File, MovedBytesStayValid) {
  const TemporaryFolder folder;
  const std::string path = folder.path() + "/a";
  write_file(path, "content");
  FileBytes first(path);
  FileBytes second(std::move(first));
  EXPECT_TRUE(first.bytes().empty());
  FileBytes third(folder.path() + "/a");
  third = std::move(second);
  EXPECT_EQ(third.bytes().size(), 7u);
  EXPECT_EQ(static_cast<char>(third.bytes()[6]), 't');
}

TEST(File, ErrorsAreTypedAndNameThePath) {
  const TemporaryFolder folder;
  const std::string missing = folder.path() + "/missing.ply";
  EXPECT_EQ(code_of([&] { FileBytes file(missing); }), ErrorCode::cannot_read);
  EXPECT_EQ(code_of([&] { FileBytes file(folder.path()); }), ErrorCode::cannot_read);
  EXPECT_EQ(code_of([&] { write_file(folder.path() + "/no/such/folder", "x"); }), ErrorCode::cannot_write);
  EXPECT_EQ(code_of([&] { write_file(folder.path(), "x"); }), ErrorCode::cannot_write);
  try {
    read_scan_file(missing, Execution());
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::cannot_read);
    EXPECT_EQ(std::string(error.what()).rfind(missing, 0), 0u) << error.what();
  }
  write_file(missing, "");
  try {
    read_scan_file(missing, Execution());
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::bad_file);
    EXPECT_EQ(std::string(error.what()).rfind(missing, 0), 0u) << error.what();
  }
}

TEST(File, AFailedWriteLeavesTheOldFileAlone) {
  const TemporaryFolder folder;
  make_folders(folder.path() + "/target/inside");
  EXPECT_EQ(code_of([&] { write_file(folder.path() + "/target", "x"); }), ErrorCode::cannot_write);
  EXPECT_EQ(TemporaryFolder::names(folder.path()), (std::vector<std::string>{"target"}));
}

TEST(File, MakesFoldersAndRefusesFilesInTheWay) {
  const TemporaryFolder folder;
  make_folders(folder.path() + "/a/b/c");
  make_folders(folder.path() + "/a/b/c/");
  write_file(folder.path() + "/a/b/c/file", "x");
  EXPECT_EQ(code_of([&] { make_folders(folder.path() + "/a/b/c/file"); }), ErrorCode::cannot_write);
  EXPECT_EQ(code_of([&] { make_folders(folder.path() + "/a/b/c/file/d"); }), ErrorCode::cannot_write);
}

}  // namespace
}  // namespace vitruvian::test
