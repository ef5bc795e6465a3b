// Browsers as workers.

#include "farm_driver.h"

namespace bandsaw::coordinator {
namespace {

TEST(Browser, IsShownAsSuch) {
  FarmDriver farm;
  farm.hello(1, "a");
  farm.hello_tab(2, "b");
  WorkerHello old = test_worker("c");
  old.browser = true;
  old.pixel_version = 1;
  farm.send(input::Hello{3, old});
  std::map<std::string, bool> browsers;
  for (const WorkerView& worker : farm.scheduler.workers(farm.now)) {
    browsers[worker.name] = worker.browser;
  }
  EXPECT_EQ(browsers,
            (std::map<std::string, bool>{{"tab", true}, {"worker-a", false}, {"worker-c", true}}));
}

}  // namespace
}  // namespace bandsaw::coordinator
