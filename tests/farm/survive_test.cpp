// A worker is killed, frozen or drained (asked to leave), a worker joins late, or the coordinator
// is killed. The job must end with the same bytes, and no finished band may be rendered again.

#include <gtest/gtest.h>

#include <csignal>

#include "tests/farm/band_log.h"
#include "tests/farm/farm_processes.h"
#include "tests/farm/survival.h"

namespace bandsaw::test {
namespace {

class Survive : public testing::Test {
 protected:
  FarmProcesses farm_;
  Survival job_{farm_};
};

TEST_F(Survive, AKilledWorker) {
  farm_.add_worker("victim", 1);
  farm_.add_worker("other", 1);
  Process client = job_.submit();
  job_.wait_until_stored("victim", 3);
  farm_.worker("victim").signal(SIGKILL);
  job_.expect_the_same_bytes(client);
  job_.expect_nothing_rendered_again("victim");
}

TEST_F(Survive, AFrozenWorker) {
  farm_.add_worker("victim", 1);
  farm_.add_worker("other", 1);
  Process client = job_.submit();
  job_.wait_until_stored("victim", 2);
  farm_.worker("victim").signal(SIGSTOP);
  job_.expect_the_same_bytes(client);
  job_.expect_nothing_rendered_again("victim");
  // The coordinator has given the frozen worker up, so the worker must join a second time.
  farm_.worker("victim").signal(SIGCONT);
  job_.wait_until_joined("victim", 2);
}

TEST_F(Survive, AWorkerThatJoinsInTheMiddle) {
  farm_.add_worker("first", 1);
  Process client = job_.submit();
  job_.wait_until_stored("first", 3);
  farm_.add_worker("late", 1);
  job_.expect_the_same_bytes(client);
  EXPECT_GT(logged_bands(farm_.worker_log("late"), "stored").size(), 0u);
  job_.expect_nothing_rendered_again();
}

TEST_F(Survive, AKilledCoordinator) {
  farm_.add_worker("one", 1);
  farm_.add_worker("two", 1);
  Process client = job_.submit();
  job_.wait_until_stored("one", 3);
  farm_.coordinator().signal(SIGKILL);
  ASSERT_EQ(farm_.coordinator().wait(), 128 + SIGKILL);
  farm_.restart_coordinator();
  job_.expect_the_same_bytes(client);
  job_.expect_nothing_rendered_again();
}

// All light passes through glass, so each worker makes photon maps. One worker is killed, and a new
// worker joins. While the new worker makes photon maps, the coordinator is killed.
TEST_F(Survive, AKilledWorkerAndCoordinatorWhilePhotonMapsAreMade) {
  Survival job(farm_, BANDSAW_GALLERY "/hard_light/lamp_in_glass.textproto");
  farm_.add_worker("victim", 1);
  farm_.add_worker("other", 1);
  Process client = job.submit();
  job.wait_until_stored("victim", 1);
  farm_.worker("victim").signal(SIGKILL);
  farm_.add_worker("late", 1);
  farm_.coordinator().signal(SIGKILL);
  ASSERT_EQ(farm_.coordinator().wait(), 128 + SIGKILL);
  farm_.restart_coordinator();
  job.expect_the_same_bytes(client);
  job.expect_nothing_rendered_again("victim");
  EXPECT_NE(file_bytes(farm_.path("farm.json")).find("\"photon_maps\":true"), std::string::npos);
}

TEST_F(Survive, ADrainedWorker) {
  farm_.add_worker("leaving", 1);
  farm_.add_worker("staying", 1);
  Process client = job_.submit();
  job_.wait_until_stored("leaving", 2);
  // Batch systems send SIGUSR1 or SIGUSR2 as a warning. A worker ignores both.
  farm_.worker("leaving").signal(SIGUSR1);
  farm_.worker("leaving").signal(SIGUSR2);
  farm_.worker("leaving").signal(SIGTERM);
  EXPECT_EQ(farm_.worker("leaving").wait(), 0);
  // A drained worker has delivered all that it rendered.
  EXPECT_EQ(logged_bands(farm_.worker_log("leaving"), "rendered").size(),
            logged_bands(farm_.worker_log("leaving"), "stored").size());
  job_.expect_the_same_bytes(client);
  job_.expect_nothing_rendered_again();
}

}  // namespace
}  // namespace bandsaw::test
