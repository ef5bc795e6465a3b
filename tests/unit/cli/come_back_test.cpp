// When a command leaves a job early, for example at Ctrl-C, it prints a command with which the user
// can watch the job again. The printed command repeats the files and the settings that the user
// asked for. The second argument of come_back() is the file name that is printed if the user named
// no file.

#include <gtest/gtest.h>

#include "coordinator/cli/farm/watch_job.h"

namespace bandsaw::coordinator {
namespace {

WatchOptions of_job_7() {
  WatchOptions options;
  options.job = 7;
  return options;
}

TEST(ComeBack, RepeatsTheFilesAndTheDenoiser) {
  WatchOptions options = of_job_7();
  EXPECT_EQ(come_back(options, "FILE"), "Come back with: bandsaw watch 7 -o FILE");
  options.outputs = {"a.png", "b.exr"};
  options.denoise = Denoiser::kRegression;
  EXPECT_EQ(come_back(options, "FILE"),
            "Come back with: bandsaw watch 7 --denoise -o a.png -o b.exr");
  options.outputs = {"walk.####.png"};
  options.denoise = Denoiser::kOidn;
  EXPECT_EQ(come_back(options, "FILE"),
            "Come back with: bandsaw watch 7 --denoise=oidn -o walk.####.png");
}

TEST(ComeBack, QuotesNamesForTheShell) {
  WatchOptions options = of_job_7();
  options.outputs = {"it's mine.png"};
  EXPECT_EQ(come_back(options, "FILE"), R"(Come back with: bandsaw watch 7 -o 'it'\''s mine.png')");
}

TEST(ComeBack, RepeatsTheSettingsAndTheStepsAfterTheImages) {
  WatchOptions options = of_job_7();
  options.outputs = {"w.#.exr"};
  options.display = {.exposure = -1.5, .tone = Tone::kFilmic, .half = true};
  options.report.file = "none";
  options.after = {.video = "w.mp4",
                   .video_fps = 12.5,
                   .contact_sheet = "s.png",
                   .command = "cp $BANDSAW_FILES /mnt"};
  EXPECT_EQ(come_back(options, "FILE"),
            "Come back with: bandsaw watch 7 -o w.#.exr --report none --half --exposure -1.5 "
            "--tone filmic --video w.mp4 --fps 12.5 --contact-sheet s.png "
            "--then 'cp $BANDSAW_FILES /mnt'");
}

// The option --farm takes a file with a join string, "-" for standard input, or the join string
// itself, which contains a secret.
TEST(ComeBack, NamesTheFileOfTheFarmAndShowsNoSecret) {
  WatchOptions options = of_job_7();
  options.farm.farm = "/dev/null";
  EXPECT_EQ(come_back(options, "FILE"), "Come back with: bandsaw watch 7 -o FILE --farm /dev/null");
  for (const char* farm : {"-", "bsw1-f-10.0.0.1:7878-secret"}) {
    options.farm.farm = farm;
    EXPECT_EQ(come_back(options, "FILE"), "Come back with: bandsaw watch 7 -o FILE");
  }
}

}  // namespace
}  // namespace bandsaw::coordinator
