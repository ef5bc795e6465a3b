// Pixels depend only on the scene and the settings: `render`, a farm of any size, and parts
// combined by `stitch` give equal PFM files, byte for byte. An id such as P5 in a test's name is
// that of a case in tests/hard_cases/cases.txt.

#include <gtest/gtest.h>

#include <algorithm>
#include <csignal>
#include <filesystem>

#include "renderlib/render/kernel.h"
#include "tests/farm/farm_processes.h"
#include "tests/support/hard_case.h"

namespace bandsaw::test {
namespace {

constexpr char kModel[] = "/usr/share/assimp/models/glTF2/BoxTextured-glTF-Binary/BoxTextured.glb";

std::vector<std::string> scenes() {
  std::vector<std::string> out = {kModel};
  for (const auto& entry : std::filesystem::directory_iterator(BANDSAW_GALLERY)) {
    if (entry.path().extension() == ".textproto") {
      out.push_back(entry.path());
    }
  }
  std::sort(out.begin(), out.end());
  return out;
}

// The samples of a pixel are summed in blocks of 8, and the sums of blocks in a binary tree
// (glossary: proto/README.md). 72 samples are 9 blocks. Because 9 is no power of two, a pixel's sum
// consists of several nodes of the tree, and these nodes come from different bands.
const std::vector<std::string> kSettings = {"--width", "24", "--samples", "72", "--quiet"};

std::vector<std::string> with_settings(std::vector<std::string> arguments) {
  arguments.insert(arguments.end(), kSettings.begin(), kSettings.end());
  return arguments;
}

class SameBytes : public testing::Test {
 protected:
  // Returns the bytes of the image that `render` makes, which all other methods must equal.
  std::string rendered(const std::string& scene) {
    const std::string& file = rendered_[scene];
    if (file.empty()) {
      rendered_[scene] = farm_.path("r" + std::to_string(rendered_.size()) + ".pfm");
      expect_success(run(with_settings({BANDSAW_BIN, "render", scene, "-o", file})));
    }
    return file_bytes(file);
  }

  void expect_farm_gives_the_same() {
    for (const std::string& scene : scenes()) {
      const std::string file = farm_.path("farm.pfm");
      expect_success(run(farm_.command(with_settings({"submit", scene, "-o", file}))));
      EXPECT_TRUE(file_bytes(file) == rendered(scene)) << scene;
    }
  }

  FarmProcesses farm_;
  std::map<std::string, std::string> rendered_;
};

TEST_F(SameBytes, OnFarmsOfOneTwoAndFiveWorkers) {
  ASSERT_GE(scenes().size(), 5u);
  farm_.add_worker("one", 1);
  expect_farm_gives_the_same();
  farm_.add_worker("two", 2);
  expect_farm_gives_the_same();
  farm_.add_worker("three", 1);
  farm_.add_worker("four", 2);
  farm_.add_worker("five", 1);
  expect_farm_gives_the_same();
}

TEST_F(SameBytes, ByEachKernel) {
  const std::string scene = std::string(BANDSAW_GALLERY) + "/everything.textproto";
  for (const Kernel* kernel : kernels()) {
    const std::string file = farm_.path(std::string(kernel->name) + ".pfm");
    expect_success(
        run(with_settings({BANDSAW_BIN, "render", scene, "--kernel", kernel->name, "-o", file})));
    EXPECT_TRUE(file_bytes(file) == rendered(scene)) << kernel->name;
  }
}

// The number of samples of each half tile (half of the pixels of a square of 16 x 16) is planned
// from the errors of the first samples. The layer "samples" shows the plan. Both must be the same
// on every farm and after a restart.
TEST_F(SameBytes, WithAdaptiveSampling) {
  const auto adaptive = [&](const std::string& command, const std::string& file) {
    return std::vector<std::string>{command,    std::string(BANDSAW_GALLERY) + "/spheres.textproto",
                                    "-o",       farm_.path(file),
                                    "--width",  "240",
                                    "--error",  "3%",
                                    "--layers", "samples,depth",
                                    "--quiet",  "--adaptive"};
  };
  std::vector<std::string> here = adaptive("render", "here.exr");
  here.insert(here.begin(), BANDSAW_BIN);
  expect_success(run(here));
  farm_.add_worker("one", 1);
  expect_success(run(farm_.command(adaptive("submit", "one.exr"))));
  EXPECT_TRUE(file_bytes(farm_.path("one.exr")) == file_bytes(farm_.path("here.exr")));
  farm_.add_worker("two", 2);
  Process client = Process::start(farm_.command(adaptive("submit", "two.exr")));
  ASSERT_TRUE(farm_.coordinator().wait_until([](const std::string&, const std::string& log) {
    // The log names each job's plan once. The second plan is that of the job of two.exr.
    constexpr char kPlanned[] = "more samples where there is more noise";
    return log.find(kPlanned) != log.rfind(kPlanned);
  })) << farm_.coordinator_log();
  farm_.coordinator().signal(SIGKILL);
  ASSERT_EQ(farm_.coordinator().wait(), 128 + SIGKILL);
  farm_.restart_coordinator();
  EXPECT_EQ(client.wait(), 0) << client.err();
  EXPECT_TRUE(file_bytes(farm_.path("two.exr")) == file_bytes(farm_.path("here.exr")));
}

TEST_F(SameBytes, P5_WhenPartsAreStitched) {
  for (const std::string& scene : scenes()) {
    const std::string whole = rendered(scene);
    // PFM's second line: width and height.
    const std::size_t height_at = whole.find(' ', 3) + 1;
    const int height = std::stoi(whole.substr(height_at));
    const std::vector<int> cuts = {0, height / 5, height / 2 + 1, height};
    std::vector<std::string> stitch = {BANDSAW_BIN, "stitch"};
    for (int part = 0; part < 3; ++part) {
      const std::string file = farm_.path("part" + std::to_string(part) + ".band");
      const std::string rows = std::to_string(cuts[part]) + ":" + std::to_string(cuts[part + 1]);
      expect_success(
          run(with_settings({BANDSAW_BIN, "render", scene, "--rows", rows, "-o", file})));
      stitch.insert(stitch.begin() + 2, file);  // last part first: the order does not matter
    }
    stitch.insert(stitch.end(), {"-o", farm_.path("stitched.pfm")});
    expect_success(run(stitch));
    EXPECT_TRUE(file_bytes(farm_.path("stitched.pfm")) == whole) << scene;
  }
  report_hard_case("P5", "the joined bands equal the whole image byte by byte");
}

TEST_F(SameBytes, WithLayers) {
  farm_.add_worker("one", 1);
  farm_.add_worker("two", 1);
  const std::string scene = std::string(BANDSAW_GALLERY) + "/textured.textproto";
  const auto with_layers = [&](std::vector<std::string> arguments, const std::string& file) {
    arguments.insert(arguments.end(),
                     {scene, "-o", file, "--layers", "depth,albedo,normal,samples"});
    return with_settings(std::move(arguments));
  };
  const std::string here = farm_.path("here.exr");
  const std::string there = farm_.path("there.exr");
  expect_success(run(with_layers({BANDSAW_BIN, "render"}, here)));
  expect_success(run(farm_.command(with_layers({"submit"}, there))));
  EXPECT_TRUE(file_bytes(there) == file_bytes(here));
}

TEST_F(SameBytes, WithAnyNumberOfThreads) {
  const std::string scene = std::string(BANDSAW_GALLERY) + "/cornell.textproto";
  for (const char* threads : {"1", "2", "3", "8"}) {
    const std::string file = farm_.path("threads.pfm");
    expect_success(
        run(with_settings({BANDSAW_BIN, "render", scene, "--threads", threads, "-o", file})));
    EXPECT_TRUE(file_bytes(file) == rendered(scene)) << threads << " threads";
  }
}

}  // namespace
}  // namespace bandsaw::test
