// Clean images, which --denoise makes, have the same bytes from `render` and from every farm, even
// if a worker or the coordinator is killed. The denoiser needs two guides, which are images of the
// albedo and of the shape of the surfaces. A farm renders each guide as a separate job, which the
// coordinator's log and the list of jobs call "guide: …".

#include <gtest/gtest.h>

#include <csignal>

#include "tests/farm/farm_processes.h"

namespace bandsaw::test {
namespace {

class CleanImages : public testing::Test {
 protected:
  /// Returns the arguments of `command`, "render" or "submit", for a clean image of a gallery
  /// scene.
  static std::vector<std::string> image(const std::string& command, const std::string& scene,
                                        const std::string& samples, const std::string& file) {
    return {command,     std::string(BANDSAW_GALLERY) + "/" + scene + ".textproto",
            "--width",   "96",
            "--samples", samples,
            "--denoise", "--quiet",
            "-o",        file};
  }

  /// Renders on this machine and returns the file.
  std::string here(const std::string& scene, const std::string& samples, const std::string& file) {
    std::vector<std::string> command = image("render", scene, samples, farm_.path(file));
    command.insert(command.begin(), BANDSAW_BIN);
    const Finished done = run(command);
    EXPECT_EQ(done.code, 0) << done.err;
    return file_bytes(farm_.path(file));
  }

  void run_on_farm(const std::vector<std::string>& arguments) {
    const Finished done = run(farm_.command(arguments));
    ASSERT_EQ(done.code, 0) << done.err;
  }

  FarmProcesses farm_;
};

TEST_F(CleanImages, AreTheSameFromThreeWorkersOfWhichOneIsKilled) {
  const std::string expected = here("spheres", "200", "here.exr");
  farm_.add_worker("one", 1);
  farm_.add_worker("two", 1);
  farm_.add_worker("three", 1);
  Process client =
      Process::start(farm_.command(image("submit", "spheres", "200", farm_.path("there.exr"))));
  ASSERT_TRUE(farm_.worker("three").wait_until([](const std::string&, const std::string& log) {
    return log.find("stored job=1") != std::string::npos;
  })) << farm_.worker_log("three");
  farm_.worker("three").signal(SIGKILL);
  EXPECT_EQ(client.wait(), 0) << client.err();
  EXPECT_TRUE(file_bytes(farm_.path("there.exr")) == expected);
  // The farm has the guides already, so `watch` does not have them rendered again.
  run_on_farm({"watch", "1", "--denoise", "--quiet", "-o", farm_.path("watched.exr")});
  EXPECT_TRUE(file_bytes(farm_.path("watched.exr")) == expected);
  const Finished jobs = run(farm_.command({"jobs", "--json"}));
  EXPECT_NE(jobs.out.find("guide: shape"), std::string::npos) << jobs.out;
  EXPECT_EQ(jobs.out.find("guide: shape"), jobs.out.rfind("guide: shape")) << jobs.out;
}

TEST_F(CleanImages, AreTheSameAfterTheCoordinatorWasKilled) {
  const std::string expected = here("cornell", "40", "here.png");
  farm_.add_worker("one", 1);
  farm_.add_worker("two", 1);
  Process client =
      Process::start(farm_.command(image("submit", "cornell", "40", farm_.path("there.png"))));
  ASSERT_TRUE(farm_.coordinator().wait_until([](const std::string&, const std::string& log) {
    return log.find("guide: albedo") != std::string::npos;
  })) << farm_.coordinator_log();
  farm_.coordinator().signal(SIGKILL);
  ASSERT_EQ(farm_.coordinator().wait(), 128 + SIGKILL);
  farm_.restart_coordinator();
  EXPECT_EQ(client.wait(), 0) << client.err() << farm_.coordinator_log();
  EXPECT_TRUE(file_bytes(farm_.path("there.png")) == expected);
  // .raw.png: the image before it was cleaned.
  EXPECT_TRUE(file_bytes(farm_.path("there.raw.png")) == file_bytes(farm_.path("here.raw.png")));
}

// The denoiser needs two independent parts of the samples. The samples of one block, which are 8 or
// fewer, cannot be separated after they are summed. So if there is only one block, further samples
// are rendered as the other part.
TEST_F(CleanImages, AreTheSameWithFewSamples) {
  const std::string expected = here("spheres", "5", "here.pfm");
  farm_.add_worker("one", 2);
  run_on_farm(image("submit", "spheres", "5", farm_.path("there.pfm")));
  EXPECT_TRUE(file_bytes(farm_.path("there.pfm")) == expected);
}

// A stand-in takes the place of the library OpenImageDenoise. The program finds the stand-in as it
// would find the installed library.
TEST_F(CleanImages, AreMadeByAnInstalledLibrary) {
  std::vector<std::string> command = image("render", "spheres", "20", farm_.path("oidn.exr"));
  command.insert(command.begin(), BANDSAW_BIN);
  for (std::string& argument : command) {
    argument = argument == "--denoise" ? "--denoise=oidn" : argument;
  }
  const Finished missing = run(command);
  if (missing.code == 0) {
    GTEST_SKIP() << "OpenImageDenoise is installed on this machine";
  }
  EXPECT_EQ(missing.code, 2);
  EXPECT_NE(missing.err.find("OpenImageDenoise cannot be loaded"), std::string::npos)
      << missing.err;
  command.insert(command.begin(), {"/usr/bin/env", "LD_LIBRARY_PATH=" BANDSAW_OIDN_FOLDER});
  const Finished done = run(command);
  ASSERT_EQ(done.code, 0) << done.err;
  const std::string report = file_bytes(farm_.path("oidn.json"));
  EXPECT_NE(report.find("\"method\":\"oidn\",\"same_bits_on_all_machines\":false"),
            std::string::npos)
      << report;
}

TEST_F(CleanImages, AreRefusedForADepthImageAndForOneSample) {
  farm_.add_worker("one", 1);
  std::vector<std::string> depth = image("submit", "spheres", "5", farm_.path("depth.pfm"));
  depth.insert(depth.end(), {"--integrator", "depth"});
  const Finished refused = run(farm_.command(depth));
  EXPECT_EQ(refused.code, 2);
  EXPECT_NE(refused.err.find("not cleaned"), std::string::npos) << refused.err;
  const Finished jobs = run(farm_.command({"jobs"}));
  EXPECT_EQ(jobs.out.find("spheres"), std::string::npos) << jobs.out;
  // Submits a job with one sample without --denoise; watch --denoise then refuses it.
  run_on_farm({"submit", std::string(BANDSAW_GALLERY) + "/spheres.textproto", "--width", "16",
               "--samples", "1", "--quiet", "-o", farm_.path("one.png")});
  const Finished one =
      run(farm_.command({"watch", "1", "--denoise", "-o", farm_.path("clean.png")}));
  EXPECT_NE(one.code, 0);
  EXPECT_NE(one.err.find("one sample per pixel"), std::string::npos) << one.err;
}

}  // namespace
}  // namespace bandsaw::test
