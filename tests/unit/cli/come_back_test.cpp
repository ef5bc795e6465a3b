// The command that a user is told to come back with repeats what was asked for.

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
