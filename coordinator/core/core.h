#pragma once

// The scheduler: what is decided, apart from the world it is decided for. One input at a time, with
// the time it came; out come records for the journal and actions for the world. The same inputs
// give the same outputs.

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "coordinator/core/messages.h"
#include "coordinator/core/types.h"

namespace bandsaw::coordinator {

/// What a worker must be equal in to be fit for the farm.
struct Fitness {
  std::uint32_t protocol = 0;
  std::uint32_t pixel_version = 0;
  std::uint64_t canary = 0;
};

struct CoreOptions {
  Fitness fitness;
  double heartbeat_interval_s = 1;  ///< asked of workers
  double heartbeat_timeout_s = 4;   ///< a worker silent this long is lost
  double progress_timeout_s = 30;   ///< a lease that does not advance this long is given to another
  double reattach_grace_s =
      6;  ///< after a restart nothing is leased this long unless all former workers are back
  double band_target_s =
      1;  ///< how long a band should take its worker; bands are shorter toward the end
  /// So many machines lost at a band that is suspect already fail the job; more where many are lost
  /// for other reasons, or nothing is known of the farm yet (loss_rate.h).
  std::size_t losses_per_band = 3;
  double audit_share = 0;  ///< of all bands, [0, 1]: rendered by two machines (audit.h)
  std::string epoch;       ///< names this life; part of what a held lease is known by
};

/// What one input led to. Durable first: the records MUST be on disk before any action is done or
/// any answer given.
struct Step {
  std::vector<Record> records;
  std::vector<Action> actions;
  absl::Status status;  ///< of what people ask: the answer. Others: INTERNAL only for a bug.
  JobId job = 0;        ///< of Submit
};

class Core {
 public:
  explicit Core(CoreOptions options);
  ~Core();
  Core(Core&&) noexcept;
  Core& operator=(Core&&) noexcept;

  /// `now` need not be exact: it may jump or go back. Tick MUST come at least once a heartbeat
  /// interval.
  Step step(const Input& input, Time now);

  // Restart: all records in the order they were written, then all bands found on disk and what is
  // damaged of them, then `replayed` once, then inputs.
  void replay(const Record& record);
  void replay(const input::BandStored& band);
  /// So many bytes of a job's band log, > 0, are of no whole band: said to people (why).
  void replay_damage(JobId job, std::uint64_t bytes);
  /// Begins the grace time; its actions are for jobs that were finishing.
  Step replayed(Time now);

  /// Which rows of a band a job still wants: empty when all are there; none at all when the job is
  /// final or unknown, or the band is not one of its passes.
  std::optional<std::vector<RowRange>> wanted(JobId job, const Band& band) const;

  /// What its half tiles take.
  TileSamples tiles(JobId job, const Band& band) const;

  /// The fewest records that replay to what is durable now: what a journal can be replaced by.
  std::vector<Record> snapshot() const;

  std::optional<JobView> job(JobId id, Time now) const;
  /// Why it is not done yet, in sentences, the most important first; empty: no such job.
  std::vector<std::string> why(JobId id, Time now) const;
  std::vector<JobView> jobs(Time now) const;        ///< by id
  std::vector<WorkerView> workers(Time now) const;  ///< by name

  /// The first invariant that does not hold, as a sentence; nothing when all do. For tests, after
  /// every step.
  std::optional<std::string> broken_invariant() const;

 private:
  class State;
  std::unique_ptr<State> state_;
};

}  // namespace bandsaw::coordinator
