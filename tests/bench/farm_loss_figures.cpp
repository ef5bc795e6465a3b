// Measures the time until a coordinator detects the loss of a worker. Also counts how many finished
// bands (parts of the image) are rendered again after the coordinator was killed.

#include <csignal>
#include <functional>
#include <regex>

#include "renderlib/base/check.h"
#include "tests/bench/farm_figures.h"
#include "tests/farm/survival.h"

namespace bandsaw::bench {
namespace {

using test::FarmProcesses;
using test::Hosts;
using test::Process;

constexpr int kKills = 10;  // number of losses by SIGKILL
// Number of losses by a freeze, and also number of losses by a pulled cable. The coordinator needs
// seconds to detect such a loss.
constexpr int kSilences = 3;

/// Submits a job that does not end during the measurement.
void keep_busy(const FarmProcesses& farm) {
  const test::Finished finished = test::run(farm.on(
      "coordinator", farm.command({"submit", std::string(BANDSAW_GALLERY) + "/cornell.textproto",
                                   "--samples", "65536", "--detach"})));
  BANDSAW_CHECK(finished.code == 0, finished.err.c_str());
}

/// Starts a worker and waits until one of its bands is stored. Then calls `lose`, which kills,
/// freezes or disconnects the worker. Returns the seconds from that call to the coordinator's
/// report of the loss.
double seen_after(FarmProcesses& farm, const std::string& worker,
                  const std::function<void()>& lose) {
  farm.add_worker(worker, 1);
  test::Survival(farm).wait_until_stored(worker, 1);
  const std::regex gone("worker=" + worker + " .*(closed|disconnected)");
  const Clock::time_point begin = Clock::now();
  lose();
  BANDSAW_CHECK(farm.coordinator().wait_until([&](const std::string&, const std::string& log) {
    return std::regex_search(log, gone);
  }),
                "a loss is seen within a minute");
  return seconds_since(begin);
}

/// Measures the time until the coordinator reports the loss of a worker that gets the signal
/// `number`. The measurement is repeated `times` times, each time with a new worker.
Figure signalled(const std::string& name, const std::string& aim, int number, int times) {
  Figure figure{name, aim, " s", {}, ""};
  FarmProcesses farm;
  keep_busy(farm);
  for (int i = 0; i < times; ++i) {
    const std::string worker = "desk" + std::to_string(i);
    figure.measured.push_back(
        seen_after(farm, worker, [&] { farm.worker(worker).signal(number); }));
  }
  return figure;
}

/// Measures the time until the coordinator reports the loss of a worker whose cable is pulled. The
/// figure has no values if machines cannot be simulated here.
Figure cable_pulled() {
  Figure figure{"loss seen: cable pulled", "≤ 5 s", " s", {}, ""};
  std::vector<std::string> names = {"coordinator"};
  for (int i = 0; i < kSilences; ++i) {
    names.push_back("desk" + std::to_string(i));
  }
  const auto hosts = Hosts::create(names);
  if (!hosts.ok()) {
    figure.remark = "skipped: " + std::string(hosts.status().message());
    return figure;
  }
  FarmProcesses farm(hosts->get());
  keep_busy(farm);
  for (int i = 0; i < kSilences; ++i) {
    const std::string worker = "desk" + std::to_string(i);
    figure.measured.push_back(seen_after(farm, worker, [&] { (*hosts)->unplug(worker); }));
  }
  return figure;
}

}  // namespace

std::vector<Figure> loss_figures() {
  return {signalled("loss seen: process killed", "≤ 0.1 s", SIGKILL, kKills),
          signalled("loss seen: process frozen", "≤ 5 s", SIGSTOP, kSilences), cable_pulled()};
}

Figure rendered_again_figure() {
  Figure figure{"finished bands rendered again after coordinator kill -9", "0", "", {}, ""};
  for (const std::size_t stored : {1, 3, 5}) {  // bands of worker "one" before the kill
    FarmProcesses farm;
    test::Survival job(farm);
    farm.add_worker("one", 1);
    farm.add_worker("two", 1);
    Process client = job.submit();
    job.wait_until_stored("one", stored);
    farm.coordinator().signal(SIGKILL);
    farm.coordinator().wait();
    farm.restart_coordinator();
    job.expect_the_same_bytes(client);
    figure.measured.push_back(job.rendered_again());
  }
  figure.remark = "each image has the bytes of a local render";
  return figure;
}

}  // namespace bandsaw::bench
