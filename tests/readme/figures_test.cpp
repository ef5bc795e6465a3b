// Tests deploy/figures.sh, which makes the figures of the gallery's README, or one picture with
// thumbnails of given scenes (the sheet). To be fast, the tests make figures 24 pixels wide.

#include <gtest/gtest.h>

#include <filesystem>

#include "tests/support/process.h"
#include "tests/support/temp_dir.h"

namespace bandsaw::test {
namespace {

namespace fs = std::filesystem;

TEST(Figures, AllMakesEveryStoredFigureAndNoOther) {
  const TempDir folder;
  const std::string build = fs::path(BANDSAW_BIN).parent_path().parent_path();
  const Finished finished = run(
      {"/bin/bash", std::string(BANDSAW_SOURCE) + "/deploy/figures.sh", "all", folder.path(), "24"},
      {"BANDSAW_BUILD=" + build, "PATH=" + build + "/bin:/usr/bin:/bin"});
  ASSERT_EQ(finished.code, 0) << finished.err;
  std::size_t figures = 0;
  for (const auto& kept : fs::directory_iterator(std::string(BANDSAW_GALLERY) + "/figures")) {
    EXPECT_TRUE(fs::exists(fs::path(folder.path()) / kept.path().filename())) << kept.path();
    ++figures;
  }
  EXPECT_EQ(figures, static_cast<std::size_t>(std::distance(fs::directory_iterator(folder.path()),
                                                            fs::directory_iterator())));
}

TEST(Figures, TheSheetShowsTheScenesAndListsTheirPlaces) {
  const TempDir folder;
  const std::string build = fs::path(BANDSAW_BIN).parent_path().parent_path();
  const std::string gallery = BANDSAW_GALLERY;
  const Finished finished =
      run({"/bin/bash", std::string(BANDSAW_SOURCE) + "/deploy/figures.sh", "sheet", folder.path(),
           "24", gallery + "/cornell.textproto", gallery + "/mesh.textproto"},
          {"BANDSAW_BUILD=" + build, "PATH=" + build + "/bin:/usr/bin:/bin"});
  ASSERT_EQ(finished.code, 0) << finished.err;
  EXPECT_NE(finished.out.find("row 1: cornell mesh\n"), std::string::npos) << finished.out;
  EXPECT_TRUE(fs::exists(fs::path(folder.path()) / "sheet.png"));
}

TEST(Figures, AnUnknownNameIsRefused) {
  const Finished finished =
      run({"/bin/bash", std::string(BANDSAW_SOURCE) + "/deploy/figures.sh", "nothing"});
  EXPECT_EQ(finished.code, 2);
  EXPECT_NE(finished.err.find("usage:"), std::string::npos);
}

}  // namespace
}  // namespace bandsaw::test
