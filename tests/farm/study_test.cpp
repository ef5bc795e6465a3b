// Tests the command `bandsaw study`. It renders scenes with several methods of sampling, and writes
// a table and a plot of the methods' error against time.

#include <gtest/gtest.h>
#include <signal.h>

#include <algorithm>
#include <filesystem>

#include "tests/farm/farm_processes.h"

namespace bandsaw::test {
namespace {

constexpr char kUplight[] = BANDSAW_GALLERY "/hard_light/uplight.textproto";
constexpr char kSpheres[] = BANDSAW_GALLERY "/spheres.textproto";

class StudyCommand : public testing::Test {
 protected:
  std::vector<std::string> study(std::vector<std::string> more) const {
    std::vector<std::string> command = {BANDSAW_BIN,       "study", "-o",
                                        folder_ / "s.csv", "-o",    folder_ / "s.svg"};
    command.insert(command.end(), more.begin(), more.end());
    return command;
  }
  bool nothing_written() const { return std::filesystem::is_empty(folder_.path()); }
  TempDir folder_;
};

TEST_F(StudyCommand, WritesTableFiguresAndPlot) {
  const Finished done = run(
      study({kUplight, kSpheres, "--width", "12", "--samples", "16", "--seeds", "2", "--quiet"}));
  ASSERT_EQ(done.code, 0) << done.err;
  EXPECT_EQ(done.out.rfind("| scene | technique |", 0), 0u) << done.out;
  EXPECT_NE(done.out.find("| spheres | independent numbers | 16 |"), std::string::npos);
  const std::string csv = file_bytes(folder_ / "s.csv");
  // There is one header. Each of the two scenes has three rows (1, 4 and 16 samples) for each of
  // four methods and for adaptive sampling. Each scene also has four rows of a method that stops
  // each pixel at a tolerance of the pixel's error. The room with the uplight uses photon maps of
  // indirect light, so this room has three more rows without photon maps.
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 1 + 2 * (5 * 3 + 4) + 3);
  EXPECT_EQ(file_bytes(folder_ / "s.svg").rfind("<svg ", 0), 0u);
}

TEST_F(StudyCommand, TheOptionEveryObjectIsRefusedForLargeScenes) {
  const Finished done =
      run(study({BANDSAW_GALLERY "/mesh.textproto", "--every-object", "--width", "12"}));
  EXPECT_EQ(done.code, 2);
  EXPECT_NE(done.err.find("13826 objects, but the option allows at most 2000"), std::string::npos)
      << done.err;
  EXPECT_TRUE(nothing_written());
}

TEST_F(StudyCommand, ABadSceneIsReportedBeforeAnythingIsRendered) {
  const Finished done = run(study({kCornell, folder_ / "none.textproto"}));
  EXPECT_EQ(done.code, 2);
  EXPECT_NE(done.err.find("none.textproto"), std::string::npos);
  EXPECT_EQ(done.out, "");
  EXPECT_TRUE(nothing_written());
}

TEST_F(StudyCommand, AnInterruptEndsTheCommandAndNothingIsWritten) {
  Process process =
      Process::start(study({kCornell, "--width", "400", "--samples", "65536", "--seeds", "1000"}));
  ASSERT_TRUE(process.wait_for("reference"));
  process.signal(SIGINT);
  EXPECT_EQ(process.wait(), 130);
  EXPECT_NE(process.err().find("interrupted"), std::string::npos);
  EXPECT_TRUE(nothing_written());
}

}  // namespace
}  // namespace bandsaw::test
