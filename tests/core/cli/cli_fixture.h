#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <functional>
#include <sstream>
#include <string>
#include <vector>

#include "cli/run_cli.h"
#include "core/pipeline/sample_registration.h"

namespace vitruvian {

/// Runs the command line in-process on files of a folder of its own, with a registration that does no work.
class CliTest : public testing::Test {
 protected:
  void SetUp() override {
    const testing::TestInfo& info = *testing::UnitTest::GetInstance()->current_test_info();
    folder_ = std::filesystem::temp_directory_path() /
              (std::string("vitruvian-") + info.test_suite_name() + "-" + info.name());
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::string path(const std::string& name) const { return (folder_ / name).string(); }
  bool exists(const std::string& name) const { return std::filesystem::exists(folder_ / name); }
  std::string write(const std::string& name, const std::string& text) const {
    std::filesystem::create_directories((folder_ / name).parent_path());
    std::ofstream(path(name), std::ios::binary) << text;
    return path(name);
  }
  std::string read(const std::string& name) const {
    std::ifstream file(path(name), std::ios::binary);
    std::ostringstream text;
    text << file.rdbuf();
    return text.str();
  }
  /// A tetrahedron: the least that counts as a scan.
  std::string write_scan(const std::string& name) const {
    return write(
        name,
        "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
        "element face 4\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n"
        "3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n");
  }

  /// What the pretended registration gives for a scan.
  static Registration pretended(const Scan& scan, const Settings& settings) {
    Registration r = sample_registration();
    r.scan = {scan.file_name, scan.sha256, static_cast<long>(scan.vertices.cols()),
              static_cast<long>(scan.faces.cols())};
    r.settings = settings;
    r.verdict = {VerdictStatus::ok, 0.9, {}};
    r.registered_vertices = scan.vertices.cast<double>().colwise() + scan.origin;
    r.registered_faces = scan.faces;
    r.vertex_error_mm.assign(static_cast<std::size_t>(scan.vertices.cols()), 1.5f);
    return r;
  }

  int run(const std::vector<std::string>& arguments, bool terminal = false) {
    out_.str("");
    error_.str("");
    const CliContext context{
        out_,      error_, terminal, interrupt_, [this](const RegisterArguments& a) { return open_(a); },
        open_body_};
    return static_cast<int>(run_cli(arguments, context));
  }
  std::string out() const { return out_.str(); }
  std::string error() const { return error_.str(); }
  bool said(const std::string& words) const { return error().find(words) != std::string::npos; }

  /// May be replaced by a test.
  std::function<Registration(const Scan&, const Settings&, const Execution&)> register_ =
      [](const Scan& scan, const Settings& settings, const Execution&) { return pretended(scan, settings); };
  std::function<RegisterFunction(const RegisterArguments&)> open_ =
      [this](const RegisterArguments&) -> RegisterFunction {
    return [this](Scan scan, const Settings& settings, const Execution& execution, double) {
      return register_(scan, settings, execution);
    };
  };
  BodyOpener open_body_;
  Execution interrupt_{1};

 private:
  std::filesystem::path folder_;
  std::ostringstream out_, error_;
};

}  // namespace vitruvian
