#pragma once

// Helpers of the scheduler's tests. FarmDriver drives a Scheduler by hand: it sends inputs, keeps
// all records and actions, and checks the invariants after each step. An input gives records, which
// are for the journal, and actions, which the coordinator would do. A band is a range of rows and
// a range of samples, and a lease gives a band to a worker. An epoch is one run of the coordinator.
// The glossary of proto/README.md defines further terms.

#include <algorithm>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "coordinator/scheduler/scheduler.h"
#include "gtest/gtest.h"

namespace bandsaw::coordinator {

/// Returns options with the versions of test_worker: protocol 1, pixel version 2, canary 3.
inline SchedulerOptions test_options() {
  SchedulerOptions options;
  options.compatibility = {1, 2, 3};
  options.epoch = "one";
  return options;
}

/// Returns options for which workers are slow. The target time of a band is a millisecond, so a
/// band of a small image has one row or a few.
inline SchedulerOptions slow() {
  SchedulerOptions options = test_options();
  options.band_target_s = 1e-3;
  return options;
}

/// Returns a job for submission. `request` is its request id.
inline JobSpec test_job(std::string request, const StopRule& stop, std::uint32_t width = 8,
                        std::uint32_t height = 8) {
  JobSpec spec;
  spec.request_id = std::move(request);
  spec.name = "test";
  spec.manifest = std::string(64, 'a');
  spec.settings.width = width;
  spec.settings.height = height;
  spec.stop = stop;
  return spec;
}

/// Returns the row digest that a correct worker would send: an arbitrary function of the samples
/// and the row. A worker that sends another number counts as wrong.
inline std::uint64_t honest_digest(const SampleRange& samples, std::uint32_t row) {
  return samples.first * 1'000'003 + samples.last * 7'919 + row + 1;
}
/// Returns honest_digest() of each row of the band.
inline std::vector<std::uint64_t> honest_digests(const Band& band) {
  std::vector<std::uint64_t> digests;
  for (std::uint32_t row = band.rows.first; row < band.rows.last; ++row) {
    digests.push_back(honest_digest(band.samples, row));
  }
  return digests;
}

/// Returns the Hello of a worker process on a machine of its own. `instance` names the process;
/// `held`: the leases that it holds after a reconnect.
inline WorkerHello test_worker(const std::string& instance, std::uint32_t max_bands = 2,
                               std::vector<WorkerHello::Held> held = {}) {
  WorkerHello worker;
  worker.instance = instance;
  worker.name = "worker-" + instance;
  worker.build = "test build";
  worker.protocol = 1;
  worker.pixel_version = 2;
  worker.canary = 3;
  worker.max_bands = max_bands;
  worker.held = std::move(held);
  return worker;
}

class FarmDriver {
  std::unique_ptr<Scheduler> owned_;  // before `scheduler`, which refers to it

 public:
  explicit FarmDriver(SchedulerOptions options = test_options())
      : owned_(std::make_unique<Scheduler>(std::move(options))), scheduler(*owned_) {}

  Step send(const Input& input) {
    Step step = scheduler.step(input, now);
    take(step);
    return step;
  }

  /// Keeps the records and actions of a step, and checks the invariants. Tests call it for steps
  /// that they caused without `send`.
  void take(const Step& step) {
    for (const Record& record : step.records) {
      records.push_back(record);
    }
    for (const Action& action : step.actions) {
      actions.push_back(action);
    }
    EXPECT_EQ(scheduler.broken_invariant().value_or(""), "");
  }

  JobId submit(JobSpec spec) { return send(input::Submit{std::move(spec)}).job; }

  /// A worker joins. It may hold at most `max_bands` bands at once. `held`: the leases that it
  /// holds now.
  Step hello(SessionId session, const std::string& instance, std::uint32_t max_bands = 2,
             std::vector<WorkerHello::Held> held = {}) {
    return send(input::Hello{session, test_worker(instance, max_bands, std::move(held))});
  }

  /// A browser tab of the name "tab" joins. It has this much memory for scenes; 0: no limit.
  Step hello_tab(SessionId session, const std::string& instance, std::uint64_t memory_bytes = 0,
                 std::vector<WorkerHello::Held> held = {}) {
    WorkerHello worker = test_worker(instance, 1, std::move(held));
    worker.name = "tab";
    worker.browser = true;
    worker.memory_bytes = memory_bytes;
    return send(input::Hello{session, std::move(worker)});
  }

  /// The worker returns the right pixels of a lease, which it rendered in `render_s` seconds.
  Step stored(const action::Lease& lease, const std::string& instance, double render_s = 0.5) {
    input::BandStored in;
    in.job = lease.job;
    in.band = lease.band;
    in.row_digests = honest_digests(lease.band);
    in.instance = instance;
    in.render_s = render_s;
    in.cpu_s = render_s;
    in.counters.rays = lease.band.rows.count() * lease.band.samples.samples();
    return send(in);
  }

  void heartbeat(SessionId session) { send(input::Heartbeat{session, {}, "rendering"}); }

  /// Advances the time in steps of half a second. Each step sends heartbeats of these sessions and
  /// a Tick. Workers of other sessions are silent.
  void pass_time(double seconds, const std::vector<SessionId>& sessions = {}) {
    for (double passed = 0; passed < seconds; passed += 0.5) {
      now += 0.5;
      for (const SessionId session : sessions) {
        heartbeat(session);
      }
      send(input::Tick{});
    }
  }

  /// Lets a worker render all bands that it is leased, until it gets no more.
  void render_all(SessionId session, const std::string& instance) {
    for (std::size_t i = 0; i < actions.size(); ++i) {
      if (const auto* lease = std::get_if<action::Lease>(&actions[i]);
          lease != nullptr && lease->session == session) {
        now += 0.1;
        stored(action::Lease(*lease), instance);
      }
    }
  }

  /// Returns all actions of a kind so far.
  template <class A>
  std::vector<A> all() const {
    std::vector<A> found;
    for (const Action& action : actions) {
      if (const A* a = std::get_if<A>(&action)) {
        found.push_back(*a);
      }
    }
    return found;
  }

  /// Returns all records of a kind so far.
  template <class R>
  std::vector<R> all_records() const {
    std::vector<R> found;
    for (const Record& record : records) {
      if (const R* r = std::get_if<R>(&record)) {
        found.push_back(*r);
      }
    }
    return found;
  }

  JobView job(JobId id) const { return *scheduler.job(id, now); }

  Scheduler& scheduler;
  Time now = 1000;  ///< seconds; the start is arbitrary
  std::vector<Record> records;
  std::vector<Action> actions;
};

/// Returns the actions of a kind in one step.
template <class A>
std::vector<A> in(const Step& step) {
  std::vector<A> found;
  for (const Action& action : step.actions) {
    if (const A* a = std::get_if<A>(&action)) {
      found.push_back(*a);
    }
  }
  return found;
}

}  // namespace bandsaw::coordinator
