// Simulates forty browser tabs beside a few native workers, in one thread and virtual time. Tabs
// join, are frozen, closed, loaded again and disconnected; they reconnect with the leases (bands
// given to them) that they hold, fail bands and return wrong pixels ("lie"), while the coordinator
// crashes. All this happens in the first kStorm seconds; after that every job must be done. A
// worker that lied is quarantined: it gets no more work. A failure prints its seed;
// BANDSAW_SEED=n in the environment repeats this run, and BANDSAW_SEEDS=n runs n seeds.

#include <cmath>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "farm_driver.h"
#include "seeds.h"
#include "simulated_farm.h"

namespace bandsaw::coordinator::sim {
namespace {

struct TabOutcome {
  std::string broken;                  ///< the first thing that was wrong; empty: nothing
  std::size_t done = 0;                ///< jobs
  std::uint64_t rendered_by_tabs = 0;  ///< bands
  std::uint64_t reloads = 0;           ///< tabs and native workers that were started again
  std::set<std::string> quarantined;   ///< names of workers
};

/// The farm and the events that may happen in a run.
struct TabWeather {
  bool liars = false;  ///< a third of the tabs lie, and all bands of tabs are audited
  Browsers browsers = Browsers::kAlso;  ///< tabs and native workers render
  std::size_t natives = 3;              ///< number of native workers
};

class TabSimulation : SimulatedFarm {
 public:
  TabSimulation(std::uint64_t seed, const TabWeather& weather)
      : SimulatedFarm(seed), weather_(weather) {
    coordinator_.tear_steps = chance_.happens(0.3);
    coordinator_.browser_audit_share = weather.liars ? 1 : 0.1;
    coordinator_.browsers = weather.browsers;
    coordinator_.must_be_right = true;
  }

  TabOutcome run() {
    coordinator_.start();
    for (std::size_t i = 0; i < weather_.natives; ++i) {
      add_native(i);
    }
    for (int i = 0; i < 40; ++i) {
      add_tab(i);
    }
    const std::size_t jobs = chance_.pick(1, 3);
    for (std::size_t i = 0; i < jobs; ++i) {
      agenda_.in(chance_.between(1, 10), [this, job = random_job(i)] { submit(job); });
    }
    crash_now_and_then();
    agenda_.at(kStorm, [this] { calm_down(); });
    run_until_over(jobs, 25, 100'000);
    return outcome(jobs);
  }

 private:
  JobSpec random_job(std::size_t number) {
    JobSpec job = test_job(absl::StrCat("request ", number), StopAtSamples{chance_.pick(16, 400)},
                           static_cast<std::uint32_t>(chance_.pick(8, 48)),
                           static_cast<std::uint32_t>(chance_.pick(8, 90)));
    // A scene needs four times the bytes of its package. So each job fits into tab 0, which has 4
    // GB.
    job.package_bytes = static_cast<std::uint64_t>(chance_.between_log(1e6, 9e8));
    return job;
  }

  SimWorker& add(const std::string& name, const Nature& nature) {
    workers_.push_back(std::make_unique<SimWorker>(agenda_, chance_, coordinator_, name, nature));
    return *workers_.back();
  }

  // If tabs lie, native workers are never frozen, closed or disconnected. The reason is that wrong
  // pixels are certain to be found only if a native worker is connected all the time.
  void add_native(std::size_t number) {
    SimWorker& worker =
        add(absl::StrCat("native", number), {.samples_per_s = chance_.between_log(3'000, 30'000),
                                             .threads = 4,
                                             .loses = chance_.between(0, 0.1)});
    worker.start();
    if (!weather_.liars) {
      live(worker);
    }
  }

  void add_tab(int number) {
    Nature nature;
    nature.browser = true;
    nature.number = static_cast<std::uint32_t>(number);
    nature.samples_per_s = chance_.between_log(200, 3'000);
    nature.threads = static_cast<std::uint32_t>(chance_.pick(1, 8));
    nature.max_bands = static_cast<std::uint32_t>(chance_.pick(1, 3));
    nature.memory_bytes = number == 0 ? std::uint64_t{4'000'000'000}
                                      : static_cast<std::uint64_t>(chance_.between_log(1e7, 4e9));
    nature.fails = chance_.happens(0.2) ? 0.2 : 0;
    nature.hangs = chance_.happens(0.1) ? 0.02 : 0;
    nature.lies = weather_.liars && number % 3 == 1 ? 0.2 : 0;
    nature.loses = chance_.between(0, 0.2);
    SimWorker& tab = add("tab", nature);  // all have the same name
    tabs_.push_back(&tab);
    agenda_.in(chance_.between(0, 15), [this, &tab] {
      tab.start();
      live(tab);
    });
  }

  /// Lets something happen to the worker at a random time, again and again until the storm is over.
  void live(SimWorker& worker) {
    agenda_.in(chance_.between_log(0.3, 20), [this, &worker] {
      if (agenda_.now() > kStorm) {
        return;
      }
      switch (chance_.pick(0, 3)) {
        case 0:
          worker.freeze(chance_.between(0.1, 15));
          break;
        case 1:
          worker.cut_cable();
          break;
        case 2:
          worker.drain();
          break;
        default:
          worker.kill();
          agenda_.in(chance_.between_log(0.1, 10), [this, &worker] { reopen(worker); });
      }
      live(worker);
    });
  }

  void reopen(SimWorker& worker) {
    if (!worker.running()) {
      ++reloads_;
      worker.start();
    }
  }

  void crash_now_and_then() {
    agenda_.in(chance_.between(5, 30), [this] {
      if (agenda_.now() < kStorm && coordinator_.up()) {
        coordinator_.crash();
        agenda_.in(chance_.between(0.1, 5), [this] { coordinator_.start(); });
      }
      crash_now_and_then();
    });
  }

  /// Ends the storm. Half of the tabs are closed for good. The others are loaded again, so that
  /// they are new workers; they stay, and lie no more. They have to be loaded again because a
  /// worker that has failed three bands of a job in a row gets no more bands of this job. A job
  /// that fits only into such a tab would wait for ever.
  void calm_down() {
    for (std::size_t i = 0; i < workers_.size(); ++i) {
      SimWorker& worker = *workers_[i];
      worker.calm_down();
      const bool is_tab = i >= weather_.natives;
      if (is_tab) {
        worker.kill();
      }
      if (!is_tab || i % 2 != 0 || i == weather_.natives) {
        reopen(worker);
        worker.cut_cable();  // a draining worker reconnects without draining
      }
    }
  }

  /// Returns the outcome of a run after which `jobs` jobs must be done.
  TabOutcome outcome(std::size_t jobs) {
    TabOutcome out;
    out.reloads = reloads_;
    out.quarantined = coordinator_.quarantined;
    for (const SimWorker* tab : tabs_) {
      out.rendered_by_tabs += tab->rendered;
    }
    if (coordinator_.broken) {
      out.broken = *coordinator_.broken;
      return out;
    }
    for (const JobView& job : coordinator_.scheduler().jobs(agenda_.now())) {
      out.done += job.state == JobState::kDone && coordinator_.results.contains(job.id) ? 1 : 0;
      if (job.state != JobState::kDone) {
        out.broken = absl::StrCat("job ", job.id, " is not done: ", job.reason);
      }
    }
    if (out.done != jobs && out.broken.empty()) {
      out.broken = absl::StrCat(out.done, " of ", jobs, " jobs are done");
    }
    return out;
  }

  TabWeather weather_;
  std::vector<SimWorker*> tabs_;
  std::uint64_t reloads_ = 0;
};

TEST(TabSimulation, EveryJobEndsWithTheRightBytes) {
  std::uint64_t rendered = 0;
  std::uint64_t reloads = 0;
  for_seeds(90'001, 20, [&](std::uint64_t seed) {
    const TabOutcome one = TabSimulation(seed, {}).run();
    EXPECT_EQ(one.broken, "") << "again with BANDSAW_SEED=" << seed;
    EXPECT_TRUE(one.quarantined.empty()) << "again with BANDSAW_SEED=" << seed;
    rendered += one.rendered_by_tabs;
    reloads += one.reloads;
  });
  EXPECT_GT(rendered, 100u);
  EXPECT_GT(reloads, 10u);
}

TEST(TabSimulation, TabsAloneRenderTheRightBytes) {
  for_seeds(91'001, 10, [&](std::uint64_t seed) {
    const TabOutcome one = TabSimulation(seed, {.natives = 0}).run();
    EXPECT_EQ(one.broken, "") << "again with BANDSAW_SEED=" << seed;
  });
}

// With Browsers::kOnly, only tabs render. Native workers render all bands again and compare them,
// so no image may have a wrong row.
TEST(TabSimulation, NativeWorkersThatOnlyCompareFindTabsThatLie) {
  for_seeds(92'001, 10, [&](std::uint64_t seed) {
    const TabOutcome one = TabSimulation(seed, {.liars = true, .browsers = Browsers::kOnly}).run();
    EXPECT_EQ(one.broken, "") << "again with BANDSAW_SEED=" << seed;
  });
}

TEST(TabSimulation, TabsThatLieAreFoundAndTheirPixelsRenderedAgain) {
  std::size_t found = 0;
  for_seeds(93'001, 20, [&](std::uint64_t seed) {
    const TabOutcome one = TabSimulation(seed, {.liars = true}).run();
    EXPECT_EQ(one.broken, "") << "again with BANDSAW_SEED=" << seed;
    for (const std::string& name : one.quarantined) {
      EXPECT_FALSE(absl::StartsWith(name, "native")) << "again with BANDSAW_SEED=" << seed;
      found += absl::StartsWith(name, "tab@browser") ? 1 : 0;
    }
  });
  EXPECT_GT(found, 0u);
}

}  // namespace
}  // namespace bandsaw::coordinator::sim
