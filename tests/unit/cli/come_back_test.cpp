// When a command leaves a job early, for example at Ctrl-C, it prints the command that follows the
// job again. That command repeats the files and the denoiser that the user asked for.

#include <gtest/gtest.h>

#include "coordinator/cli/farm/watch_job.h"

namespace bandsaw::coordinator {
namespace {

TEST(ComeBack, RepeatsTheFilesAndTheDenoiser) {
  EXPECT_EQ(come_back(7, {}, Denoiser::kNone, "FILE"), "Come back with: bandsaw watch 7 -o FILE");
  EXPECT_EQ(come_back(7, {"a.png", "b.exr"}, Denoiser::kRegression, "FILE"),
            "Come back with: bandsaw watch 7 --denoise -o a.png -o b.exr");
  EXPECT_EQ(come_back(7, {"walk.####.png"}, Denoiser::kOidn, "FILE"),
            "Come back with: bandsaw watch 7 --denoise=oidn -o walk.####.png");
}

}  // namespace
}  // namespace bandsaw::coordinator
