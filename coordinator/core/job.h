#pragma once

// One job: its passes, what is there of them, and what went wrong.

#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "coordinator/core/audit.h"
#include "coordinator/core/cost_map.h"
#include "coordinator/core/coverage.h"
#include "coordinator/core/messages.h"
#include "coordinator/core/row_digests.h"
#include "coordinator/core/row_times.h"
#include "coordinator/core/speed.h"
#include "coordinator/core/types.h"
#include "renderlib/render/tile_schedule.h"

namespace bandsaw::coordinator {

/// What was stored, of a pass or of a job. Each band is counted once, by its first valid result.
struct Totals {
  std::uint64_t samples = 0;  ///< pixel samples
  Counters counters;
  double cpu_s = 0;

  void add(const Totals& other) {
    samples += other.samples;
    counters.add(other.counters);
    cpu_s += other.cpu_s;
  }
};

struct Pass {
  SampleRange samples;
  Coverage coverage;
  TileSamples tiles;  ///< of the whole image
  /// What each tile row's pixels take, over what all would if each took the pass's samples; empty:
  /// they do.
  std::vector<float> shares;
  Totals stored;
  RowDigests digests;
  /// Rows that were stored with one result.
  struct StoredBand {
    Band band;
    Totals totals;  ///< of the whole result, at the first of its rows; else nothing
  };
  /// What one worker process stored of it.
  struct Part {
    std::vector<StoredBand> bands;
    Totals totals;  ///< of all bands
  };
  std::map<std::uint64_t, Part> parts;  ///< by renderer
  /// How often a band that begins at this sample and row came back unfinished. For the logs.
  std::map<std::pair<std::uint64_t, std::uint32_t>, std::uint32_t> returned;

  double share() const;  ///< the same of the whole image
  TileSamples tiles_of(const Band& band) const { return tiles.of(samples, band); }
  /// Counts rows of a band as stored by a renderer.
  void credit(std::uint64_t renderer, const Band& band, const std::vector<RowRange>& rows,
              const Totals& totals);
  /// What the renderer stored is free again; false: it had nothing.
  bool retract(std::uint64_t renderer);
  /// Whether the renderer stored exactly this band, and it was not freed since.
  bool has_stored(const Band& band, std::uint64_t renderer) const;
  /// Frees such a band; returns what was counted for it, nothing when there is no such band.
  std::optional<Totals> lose(const Band& band, std::uint64_t renderer);
  /// Who stored a row of a node; 0: not known.
  std::uint64_t renderer_of_row(const SampleRange& samples, std::uint32_t row) const;

 private:
  void add_up();
};

/// The reason of a job that a person paused.
inline constexpr char kPausedByAPerson[] = "paused by a person; it goes on with: bandsaw resume";

/// A worker could not render a band, or made no progress on it.
struct Fault {
  Band band;
  std::string instance;
  std::string reason;
};

/// A worker was lost while it had a band in hand, and has not come back.
struct Loss {
  Band band;               ///< without what others stored of it since
  std::uint32_t rows = 0;  ///< of it, at a time, when it is leased again
  std::string instance;
  std::string machine;   ///< the name that the worker says itself
  bool witness = false;  ///< the band was suspect already, and all that the worker had in hand
};

/// What a worker may have been rendering when it was lost.
struct Losing {
  JobId job = 0;
  Band band;
  bool alone = false;  ///< it was all that the worker had in hand
};

class Job {
 public:
  Job(JobId id, JobSpec spec, std::uint32_t pixel_version);

  /// The pass that a band's samples are a node of, when its rows are in the image; else nothing.
  Pass* pass_of(const Band& band);
  const Pass* pass_of(const Band& band) const;

  /// Follows the last pass.
  void add_pass(const SampleRange& samples);
  /// Of the passes that are added from now on.
  void plan_tiles(TilePlan plan);
  /// The job ends after this many samples: passes beyond are forgotten.
  void fix(std::uint64_t samples);
  /// What the renderer stored of any pass is free again, and no share of its is counted; false: it
  /// had nothing. Its bands' audits are over.
  bool retract(std::uint64_t renderer);
  /// Frees a band that the renderer stored, and forgets that a second machine vouched for it.
  /// Nothing is freed when Pass::has_stored does not hold.
  void lose(const Band& band, std::uint64_t renderer);
  /// Counts complete passes on; digests of all but the last few are forgotten.
  void advance();
  /// Passes, plans, faults and digests are not needed any more; the figures stay.
  void finish();

  std::uint64_t planned_samples() const;   ///< of all passes
  std::uint64_t complete_samples() const;  ///< of the passes that are complete from the first
  bool complete() const { return fixed && complete_samples() >= *fixed; }
  bool any_free() const;
  /// Whether a band waits for a machine to render it a second time.
  bool audit_waits() const;
  /// Pixel samples of its passes that nobody has.
  double free_samples() const;
  Totals totals() const;
  /// The largest, at most kSharesKept, by size.
  std::vector<WorkerShare> largest_shares() const;
  std::uint64_t pixels() const;
  /// Pixel samples that rendering the band takes.
  std::uint64_t samples_of(const Band& band) const;
  /// The work of the band: samples in columns of cost 1.
  double cost_of(const Band& band) const;
  std::uint64_t max_samples() const;
  bool timed() const { return std::holds_alternative<StopAtTime>(spec.stop); }

  JobId id = 0;
  JobSpec spec;
  std::uint32_t pixel_version = 0;  ///< that it was begun with; 0: not known
  JobState state = JobState::kRunning;
  std::int32_t priority = 0;
  bool held = false;                   ///< a person paused it
  Time held_at = 0;                    ///< patience clock: since when
  std::string reason;                  ///< of the state
  std::string notice;                  ///< what people should know though the job goes on
  std::string damage;                  ///< what of its bands on disk was damaged, in this life
  std::uint64_t damaged_bands = 0;     ///< likewise, while the coordinator ran
  std::optional<std::uint64_t> fixed;  ///< the job ends after this many samples a pixel
  std::vector<Pass> passes;            ///< from sample 0 on, without gaps
  std::optional<TilePlan> tile_plan;   ///< of an adaptive job, from its pilot's end on
  bool image_asked = false;            ///< in this life of the coordinator
  bool bands_on_disk = false;          ///< bands were stored and not dropped

  double error = -1;  ///< of `error_at` samples; negative: not known
  std::uint64_t error_at = 0;
  ErrorCurve curve;

  std::set<LeaseId> leases;
  std::set<LeaseId> copies;        ///< of `leases`, those that own nothing (Lease::copy_of)
  std::uint64_t bands_copied = 0;  ///< leases given to idle workers though others had them
  std::deque<Fault> faults;        ///< the newest kFaultsKept
  /// Patience clock: since when no connected worker is given it any more.
  std::optional<Time> unable_since;
  std::string log_of;            ///< the worker that failed a band last …
  std::vector<std::string> log;  ///< … and the last lines of its log
  std::vector<Audit> audits;     ///< open, at most kAuditsKept
  /// Whose second result was the same, and by whom they are stored: it may be another one day.
  std::set<std::pair<Band, std::uint64_t>> audited;
  /// A look at the error that waits for audits: what it would decide on may be wrong pixels.
  std::optional<input::PassMerged> look;
  std::deque<Loss> losses;                      ///< the newest kFaultsKept
  std::map<std::uint64_t, WorkerShare> shares;  ///< by renderer, at most kSharesKnown
  std::optional<record::Figures> figures;       ///< of a final job
  std::vector<WorkerShare> final_shares;        ///< of a final job, the largest first

  std::optional<Time> first_lease_at;  ///< in this life of the coordinator
  double elapsed_before = 0;           ///< seconds, in earlier lives
  double elapsed_noted = 0;            ///< seconds in all, as journalled last
  Throughput throughput;               ///< pixel samples
  CostMap cost;                        ///< of its rows
  RowTimes row_times;                  ///< likewise
  std::uint32_t probes = 0;            ///< given out, or not to be had (probes.h)
  Speed per_thread;                    ///< pace of all its workers, in work a second and thread

  static constexpr std::size_t kFaultsKept = 1'000;
  static constexpr std::size_t kAuditsKept = 4'096;
  static constexpr std::size_t kSharesKnown = 65'536;
  static constexpr std::size_t kSharesKept = 128;  ///< the largest, of a final job

 private:
  static constexpr std::size_t kPassesWithDigests = 8;
  std::optional<TileSchedule> schedule_;
  std::size_t complete_passes_ = 0;
};

}  // namespace bandsaw::coordinator
