// Dispatch of bands to many workers. The number of bands a second that the scheduler handles is
// reported, not tested.

#include <chrono>

#include "farm_driver.h"

namespace bandsaw::coordinator {
namespace {

/// Runs a job to its end and returns the number of its bands. The invariants are not checked after
/// each step, because this would be slow. Sets `seconds` to the wall time in which the scheduler
/// handled the bands.
std::size_t bands_of(std::size_t workers, std::uint32_t height, double& seconds) {
  Scheduler scheduler(slow());
  scheduler.step(input::Submit{test_job("r1", StopAtSamples{64}, 256, height)}, 0);
  std::vector<action::Lease> queue;
  const auto take = [&](const Step& step) {
    for (auto& lease : in<action::Lease>(step)) {
      queue.push_back(std::move(lease));
    }
  };
  for (std::size_t w = 1; w <= workers; ++w) {
    WorkerHello hello;
    hello.instance = std::to_string(w);
    hello.name = "worker-" + hello.instance;
    hello.protocol = 1;
    hello.pixel_version = 2;
    hello.canary = 3;
    take(scheduler.step(input::Hello{w, hello}, 0));
  }
  const auto begin = std::chrono::steady_clock::now();
  std::size_t bands = 0;
  for (; bands < queue.size(); ++bands) {
    const action::Lease lease = queue[bands];
    input::BandStored stored;
    stored.job = lease.job;
    stored.band = lease.band;
    stored.row_digests = honest_digests(lease.band);
    stored.instance = std::to_string(lease.session);
    // A row has 256 pixels, and each worker renders 100,000 samples of pixels a second.
    stored.render_s =
        static_cast<double>(lease.band.samples.samples()) * lease.band.rows.count() * 256 / 100'000;
    take(scheduler.step(stored, 1e-5 * static_cast<double>(bands)));
  }
  seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  EXPECT_EQ(scheduler.job(1, 0)->state, JobState::kFinishing);
  EXPECT_EQ(scheduler.broken_invariant().value_or(""), "");
  return bands;
}

TEST(Dispatch, AThousandWorkersAreServedAndTheSpeedIsReported) {
  double seconds = 0;
  const std::size_t bands = bands_of(1'000, 10'000, seconds);
  EXPECT_GE(bands, 10'000u);
  RecordProperty("bands_per_second", static_cast<int>(static_cast<double>(bands) / seconds));
}

TEST(Dispatch, LittleWorkIsSpreadOverManyWorkers) {
  SchedulerOptions options = test_options();
  options.band_target_s = 1e-4;  // so short that each band has one row
  FarmDriver farm(options);
  for (SessionId s = 1; s <= 8; ++s) {
    farm.hello(s, std::to_string(s));
  }
  farm.submit(test_job("r1", StopAtSamples{8}, 64, 8));
  std::set<SessionId> served;
  for (const auto& lease : farm.all<action::Lease>()) {
    EXPECT_TRUE(served.insert(lease.session).second);
  }
  EXPECT_EQ(served.size(), 8u);
}

}  // namespace
}  // namespace bandsaw::coordinator
