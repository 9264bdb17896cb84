#include "pipeline/own_models.h"

#include <gtest/gtest.h>

#include "base/error.h"
#include "core/fit/fit_fixtures.h"
#include "core/io/test_files.h"
#include "io/npz.h"

namespace vitruvian {
namespace {

NamedBytes named(const std::string& content, const std::string& name) {
  return {std::as_bytes(std::span(content.data(), content.size())), name};
}

std::string archive_with(const std::string& array) {
  const std::vector<double> values(6, 0.5);
  const NpzItem item{.name = array, .shape = {2, 3}, .doubles = values};
  return to_npz(std::span(&item, 1));
}

TEST(ModelFileKind, IsToldByTheContent) {
  EXPECT_EQ(kind_of_model_file(named(archive_with("v_template"), "a.ckpt")), ModelFileKind::body);
  EXPECT_EQ(kind_of_model_file(named(archive_with("eigvec"), "a.npz")), ModelFileKind::soft_tissue);
  EXPECT_EQ(kind_of_model_file(named(archive_with("archive/data.pkl"), "a.npz")), ModelFileKind::prior);
  EXPECT_EQ(kind_of_model_file(named("\x80\x02}q", "a")), ModelFileKind::body);
}

TEST(ModelFileKind, OtherFilesAreRefused) {
  const std::string archive = archive_with("v_template");
  const std::vector<std::pair<std::string, ErrorCode>> cases = {
      {"", ErrorCode::unsupported_format},
      {"ply\nformat ascii 1.0\n", ErrorCode::unsupported_format},
      {archive_with("poses"), ErrorCode::unsupported_format},
      {archive.substr(0, archive.size() / 2), ErrorCode::bad_file}};
  for (const auto& [content, code] : cases) {
    try {
      kind_of_model_file(named(content, "a.npz"));
      ADD_FAILURE() << content.size() << " bytes were taken for a model";
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), code) << error.what();
      EXPECT_NE(std::string(error.what()).find("a.npz"), std::string::npos);
    }
  }
}

TEST(OwnModels, TheDefaultBodyFromAFileKeepsItsLandmarksAndAsksNothing) {
  Models bundled;
  bundled.body = testing::default_body();
  bundled.prior = testing::shipped_prior();
  bundled.landmarks = {{11, 16, 13, Vec3d(0.1, -0.2, 0.03), 0.7}};
  const std::vector<std::byte> bytes = testing::file_bytes(VITRUVIAN_MODELS_DIR "/body.vbm");
  OwnModelFiles files;
  files.body = NamedBytes{bytes, "body.vbm"};
  const Execution execution(1);
  OwnModels own(bundled, files, execution);
  EXPECT_FALSE(own.next_request());
  EXPECT_FALSE(own.learnt());
  const Models models = own.take();
  ASSERT_EQ(models.landmarks.size(), 1u);
  EXPECT_EQ(models.body.sha256, bundled.body.sha256);
}

}  // namespace
}  // namespace vitruvian
