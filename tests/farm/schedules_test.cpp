// Random schedules of events on a farm of real processes. Workers are killed, frozen, disconnected
// and asked to leave, other workers join, and the coordinator is killed. The image must have the
// same bytes each time. The default is 10 schedules. BANDSAW_SCHEDULES=n runs n schedules.
// BANDSAW_SEED=n runs only the schedule of seed n. The seed determines the events, but not at which
// bands they happen.

#include <gtest/gtest.h>

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <set>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "tests/farm/band_log.h"
#include "tests/farm/farm_processes.h"
#include "tests/support/environment.h"
#include "tests/support/random.h"
#include "tests/support/sanitized.h"

namespace bandsaw::test {
namespace {

constexpr int kMachines = 4;  // workers at most

// kSlower is above 1 if the build has a sanitizer, which makes tests slow.
std::vector<std::string> with_job(std::vector<std::string> arguments) {
  const std::vector<std::string> job = {
      "--width", "96", "--height", "96", "--samples", std::to_string(64 / kSlower), "--quiet"};
  arguments.insert(arguments.end(), job.begin(), job.end());
  return arguments;
}

/// One farm, one job, and the events of one seed.
class Schedule {
 public:
  /// If `hosts` is given, cables are pulled too. `hosts` MUST outlive this object.
  Schedule(std::uint64_t seed, const Hosts* hosts) : random_(seed), hosts_(hosts), farm_(hosts) {}

  /// Returns the image's bytes; empty: the job failed, see outcome().
  std::string run() {
    const std::uint32_t count = 2 + random_.below(2);
    while (names_.size() < count) {
      join();
    }
    const std::string image = farm_.path("farm.pfm");
    Process client = Process::start(
        farm_.on("person", farm_.command(with_job({"submit", kCornell, "-o", image}))));
    const std::uint32_t events = 2 + random_.below(4);
    for (std::uint32_t i = 0; i < events && wait_for_a_band(client); ++i) {
      one_thing_happens();
    }
    calm_down();
    const std::optional<int> code = client.wait();
    tell(absl::StrCat("the client ended with ", code.value_or(-1)));
    return code == 0 ? file_bytes(image) : "";
  }

  std::string outcome() { return absl::StrJoin(outcome_, "; ") + "\n" + farm_.coordinator_log(); }

 private:
  /// Adds an event to the text of outcome().
  void tell(std::string what) { outcome_.push_back(std::move(what)); }

  /// Waits until a worker has stored another band. Returns false if the job is over.
  bool wait_for_a_band(Process& client) {
    while (!client.wait(Process::Milliseconds(0))) {
      const std::string name = one_of(working());
      const std::size_t before = logged_bands(farm_.worker_log(name), "stored").size();
      const auto more = [&](const std::string&, const std::string& log) {
        return logged_bands(log, "stored").size() > before;
      };
      if (farm_.worker(name).wait_until(more, Process::Milliseconds(500))) {
        return true;
      }
    }
    return false;
  }

  /// Returns the workers that are neither frozen nor cut off; at least one.
  std::vector<std::string> working() const {
    std::vector<std::string> names;
    for (const std::string& name : names_) {
      if (!frozen_.contains(name) && !cut_off_.contains(name)) {
        names.push_back(name);
      }
    }
    return names;
  }
  std::string one_of(const std::vector<std::string>& names) {
    return names[random_.below(static_cast<std::uint32_t>(names.size()))];
  }

  void join() {
    names_.push_back(absl::StrCat("w", names_.size()));
    tell(names_.back() + " joins");
    farm_.add_worker(names_.back(), 1 + static_cast<int>(random_.below(2)));
  }

  // Lets at most one event happen. At least one worker goes on working.
  void one_thing_happens() {
    const std::string name = one_of(working());
    const bool others = working().size() > 1;
    switch (random_.below(6)) {
      case 0:
        tell(name + " is killed and started again");
        farm_.worker(name).signal(SIGKILL);
        farm_.add_worker(name, 1);
        break;
      case 1:
        tell(name + " is asked to leave and started again");
        farm_.worker(name).signal(SIGTERM);
        farm_.worker(name).wait();
        farm_.add_worker(name, 1);
        break;
      case 2:
        if (others) {
          tell(name + " is frozen");
          farm_.worker(name).signal(SIGSTOP);
          frozen_.insert(name);
        }
        break;
      case 3:
        if (others && hosts_ != nullptr) {
          tell(name + " is cut off");
          hosts_->unplug(name);
          cut_off_.insert(name);
        } else {
          calm_down();
        }
        break;
      case 4:
        if (names_.size() < kMachines) {
          join();
        }
        break;
      default:
        tell("the coordinator is killed and started again");
        farm_.coordinator().signal(SIGKILL);
        farm_.coordinator().wait();
        farm_.restart_coordinator();
    }
  }

  // Lets frozen workers continue, and connects pulled cables again.
  void calm_down() {
    tell("all go on");
    for (const std::string& name : frozen_) {
      farm_.worker(name).signal(SIGCONT);
    }
    for (const std::string& name : cut_off_) {
      hosts_->plug(name);
    }
    frozen_.clear();
    cut_off_.clear();
  }

  Random random_;
  const Hosts* hosts_;
  FarmProcesses farm_;
  std::vector<std::string> names_;
  std::set<std::string> frozen_;
  std::set<std::string> cut_off_;
  std::vector<std::string> outcome_;
};

TEST(Schedules, RandomFailuresDoNotChangeTheBytes) {
  const auto made = Hosts::create({"coordinator", "person", "w0", "w1", "w2", "w3"});
  const Hosts* hosts = made.ok() ? made->get() : nullptr;
  const TempDir folder;
  const std::string local = folder / "local.pfm";
  ASSERT_EQ(run(with_job({BANDSAW_BIN, "render", kCornell, "-o", local})).code, 0);
  const std::string expected = file_bytes(local);
  const bool alone = std::getenv("BANDSAW_SEED") != nullptr;
  const std::uint64_t first = number_from("BANDSAW_SEED", 1);
  const std::uint64_t count = alone ? 1 : number_from("BANDSAW_SCHEDULES", 10);
  std::uint64_t same = 0;
  for (std::uint64_t seed = first; seed < first + count; ++seed) {
    Schedule schedule(seed, hosts);
    const bool equal = schedule.run() == expected;
    EXPECT_TRUE(equal) << "other bytes, or no image; run it again with BANDSAW_SEED=" << seed
                       << ": " << schedule.outcome();
    same += equal ? 1 : 0;
  }
  std::printf("%llu of %llu random schedules gave the same bytes%s\n",
              static_cast<unsigned long long>(same), static_cast<unsigned long long>(count),
              hosts == nullptr ? " (cables were not pulled: no network namespaces here)" : "");
}

}  // namespace
}  // namespace bandsaw::test
