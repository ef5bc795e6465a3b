// Tests the scenes in two folders of the gallery. `study` has the images of a study of ray tracing
// on phones, and `books` has scenes of the "weekend" books on ray tracing. Every scene loads, and a
// farm gives the same bytes as `render`.

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "tests/farm/farm_processes.h"

namespace bandsaw::test {
namespace {

namespace fs = std::filesystem;

// Returns the scene files of both folders in the build folder's gallery. Only this gallery has the
// maps that the build generates.
std::vector<std::string> scenes_of_folders() {
  std::vector<std::string> scenes;
  for (const char* part : {"study", "books"}) {
    for (const auto& entry :
         fs::directory_iterator(std::string(BANDSAW_MADE_GALLERY) + "/" + part)) {
      if (entry.path().extension() == ".textproto") {
        scenes.push_back(entry.path());
      }
    }
  }
  std::sort(scenes.begin(), scenes.end());
  return scenes;
}

TEST(GalleryFolders, RenderAndFarmGiveTheSameBytes) {
  FarmProcesses farm;
  farm.add_worker("one", 1);
  farm.add_worker("two", 1);
  const std::vector<std::string> scenes = scenes_of_folders();
  EXPECT_EQ(std::count_if(scenes.begin(), scenes.end(),
                          [](const std::string& s) { return s.find("/study/") != s.npos; }),
            24);  // the study's 23 images, and first.textproto
  for (const std::string& scene : scenes) {
    SCOPED_TRACE(scene);
    const std::vector<std::string> settings = {"--width", "20", "--samples", "16", "--quiet"};
    const auto with = [&](std::vector<std::string> arguments, const std::string& file) {
      arguments.insert(arguments.end(), {scene, "-o", farm.path(file)});
      arguments.insert(arguments.end(), settings.begin(), settings.end());
      return arguments;
    };
    const Finished here = run(with({BANDSAW_BIN, "render"}, "here.pfm"));
    ASSERT_EQ(here.code, 0) << here.err;
    const Finished there = run(farm.command(with({"submit"}, "there.pfm")));
    ASSERT_EQ(there.code, 0) << there.err;
    EXPECT_TRUE(file_bytes(farm.path("here.pfm")) == file_bytes(farm.path("there.pfm")));
  }
}

}  // namespace
}  // namespace bandsaw::test
