// Runs the scheduler and carries out its decisions. Each input makes one step of the scheduler.
// absorb() puts the records of the step into the commit queue, then the actions of the step, as
// effects. perform() carries out an action once the records before the action are on disk.

#include "coordinator/engine/scheduler_thread.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <utility>

#include "absl/strings/str_cat.h"
#include "coordinator/engine/job_log.h"
#include "proto/wire/limits.h"

namespace bandsaw::coordinator {
namespace {

/// Interval between two Tick inputs of the scheduler, in seconds. With each Tick the scheduler
/// checks its timeouts.
constexpr double kTick_s = 0.1;
/// The store looks for old jobs and blobs after this time, or after this many new jobs.
constexpr double kCollectEvery_s = 600;
constexpr std::size_t kCollectEveryJobs = 1'000;

}  // namespace

SchedulerThread::SchedulerThread(SchedulerOptions options, Journal& journal, Reserve reserve,
                                 const Clock& clock, StoreInbox& store, FilmInbox& film)
    : scheduler_(options),
      journal_(journal),
      reserve_(std::move(reserve)),
      clock_(clock),
      store_(store),
      film_(film),
      commit_queue_(journal),
      links_(options.epoch),
      logs_(wire::kLogLinesKept, wire::kLogBytesKept) {}

Step SchedulerThread::run(const Input& input, IncomingBand* incoming) {
  Step step = scheduler_.step(input, clock_.now());
  absorb(step, incoming);
  return step;
}

void SchedulerThread::absorb(const Step& step, IncomingBand* incoming) {
  for (const Record& record : step.records) {
    note(record);
    log_record(record);
    commit_queue_.record(record);
    commit_queue_.effect([this, record] { announce(record); });
  }
  for (const Action& action : step.actions) {
    const auto* add = std::get_if<action::AddToFilm>(&action);
    if (add != nullptr && incoming != nullptr) {
      IncomingBand band;
      band.job = incoming->job;
      band.worker = add->worker;
      band.process = incoming->process;
      band.pixels = std::move(incoming->pixels);
      band.share = std::move(incoming->share);
      band.offset = incoming->offset;
      band.tiles = add->tiles;
      commit_queue_.effect([this, rows = add->rows, band = std::move(band)]() mutable {
        film_.add(std::move(band), std::move(rows));
      });
    } else {
      commit_queue_.effect([this, action] { perform(action); });
    }
  }
  if (absl::IsInternal(step.status)) {
    spdlog::error("the scheduler: {}", step.status.ToString());
  }
}

void SchedulerThread::perform(const Action& action) {
  if (const auto* result = std::get_if<action::WriteResult>(&action)) {
    if (results_on_the_way_.insert(result->job).second) {
      film_.request_image(result->job, result->samples);
    }
  } else if (const auto* drop = std::get_if<action::DropBands>(&action)) {
    results_on_the_way_.erase(drop->job);
    store_.drop_bands(drop->job);
    film_.drop(drop->job);
  } else if (const auto* retracted = std::get_if<action::Retract>(&action)) {
    film_.retract(retracted->job, retracted->process);
  } else if (const auto* forgotten = std::get_if<action::DropJob>(&action)) {
    store_.drop_job(forgotten->job);
  } else if (const auto* shared = std::get_if<action::LogReassignment>(&action)) {
    log_reassignment(*shared);
  } else if (const auto* fault = std::get_if<action::LogFailure>(&action)) {
    log_failure(*fault);
  } else {
    // Actions that are messages to a worker go to its connection. All others are ignored here.
    std::visit(
        [this](const auto& one) {
          if constexpr (requires { links_.perform(one); }) {
            links_.perform(one);
          }
        },
        action);
  }
}

void SchedulerThread::note(const Record& record) {
  if (const auto* added = std::get_if<record::JobAdded>(&record)) {
    known_[added->job].spec = added->spec;
    ++added_since_;
  } else if (const auto* pass = std::get_if<record::PassPlanned>(&record)) {
    known_[pass->job].pass_ends.push_back(pass->samples.last);
  } else if (const auto* changed = std::get_if<record::StateChanged>(&record)) {
    // A sequence changes its state too, but is not in known_.
    if (const auto known = known_.find(changed->job); known != known_.end()) {
      known->second.state = changed->state;
    }
  } else if (const auto* forgotten = std::get_if<record::JobForgotten>(&record)) {
    known_.erase(forgotten->job);
  }
}

void SchedulerThread::announce(const Record& record) {
  if (const auto* added = std::get_if<record::JobAdded>(&record)) {
    store_.add_job(added->job, added->spec);
    film_.add_job(added->job, added->spec.settings, is_adaptive(added->spec.stop));
  } else if (const auto* pass = std::get_if<record::PassPlanned>(&record)) {
    film_.plan(pass->job, pass->samples.last);
  }
}

bool SchedulerThread::over(JobId id) const {
  const auto known = known_.find(id);
  return known == known_.end() || is_final(known->second.state);
}

void SchedulerThread::settle() {
  if (const Time now = clock_.now(); now - ticked_at_ >= kTick_s) {
    ticked_at_ = now;
    run(input::Tick{});
  }
  if (journal_status_.ok()) {
    collect();
    if (flush()) {
      compact();
    }
  } else {
    commit_queue_.fail_completions(journal_status_);
  }
  const auto view_of = [this](JobId id) { return job(id); };
  watchers_.update(view_of, !journal_status_.ok(), clock_.now());
}

void SchedulerThread::collect() {
  const Time now = clock_.now();
  if (collected_at_ && now - *collected_at_ < kCollectEvery_s && added_since_ < kCollectEveryJobs) {
    return;
  }
  collected_at_ = now;
  added_since_ = 0;
  store_.collect(scheduler_.kept());
}

/// Rewrites the journal as the smallest list of records if it has become long. Does nothing while
/// records or effects wait in the commit queue, because then the state of the scheduler is newer
/// than the state in the journal.
void SchedulerThread::compact() {
  if (!commit_queue_.empty() || journal_.size() <= compact_above_) {
    return;
  }
  const std::vector<Record> records = scheduler_.snapshot();
  const std::uint64_t before = journal_.size();
  if (2 * records.size() <= before) {
    if (const absl::Status status = journal_.rewrite(records); !status.ok()) {
      spdlog::warn("the journal could not be rewritten: {}", status.ToString());
    } else {
      spdlog::info("the journal was rewritten: {} records, {} before", records.size(), before);
    }
  }
  compact_above_ = std::max<std::uint64_t>(kCompactAbove, 2 * journal_.size());
}

bool SchedulerThread::flush() {
  // If the disk is full, the reserve is removed, and commit_queue_.flush() below writes the records
  // again in the space that the reserve has freed.
  if (const absl::Status written = commit_queue_.write();
      absl::IsResourceExhausted(written) && reserve_.release()) {
    disk_is_full(written);
  }
  const absl::Status flushed = commit_queue_.flush();
  if (flushed.ok()) {
    journal_status_ = flushed;
    return true;
  }
  journal_failed(flushed);
  return false;
}

/// Called when the journal cannot be written, for any reason. Pauses all jobs until the disk takes
/// data again.
void SchedulerThread::journal_failed(const absl::Status& status) {
  store_.test_disk_until_writable();
  if (!journal_status_.ok()) {
    return;
  }
  journal_status_ = absl::ResourceExhaustedError(
      absl::StrCat("the coordinator cannot write its journal: ", status.message()));
  spdlog::error("{}", journal_status_.ToString());
  pause_all(journal_status_);
}

void SchedulerThread::disk_is_full(const absl::Status& status) {
  store_.test_disk_until_writable();
  if (!disk_status_.ok()) {
    return;
  }
  disk_status_ = absl::ResourceExhaustedError(
      absl::StrCat("the coordinator's disk is full: ", status.message(),
                   "; jobs are paused and nothing new is taken until there is room: cancel jobs, "
                   "or free disk space"));
  spdlog::error("{}", disk_status_.ToString());
  has_disk_space_ = false;
  pause_all(disk_status_);
}

void SchedulerThread::pause_all(const absl::Status& status) {
  for (const auto& [id, known] : known_) {
    if (!is_final(known.state)) {
      storage_failed(id, status);
    }
  }
}

void SchedulerThread::storage_failed(JobId job, const absl::Status& status) {
  spdlog::warn("job={} storage failed: {}", job, status.ToString());
  run(input::StorageFailed{.job = job, .reason = std::string(status.message())});
}

void SchedulerThread::disk_is_back() {
  if (!flush()) {
    return;
  }
  if (const absl::Status held = reserve_.hold(); !held.ok()) {
    disk_is_full(held);
    return;
  }
  disk_status_ = absl::OkStatus();
  has_disk_space_ = true;
  spdlog::info("the disk takes data again");
  run(input::StorageBack{});
  film_.retry();
}

void SchedulerThread::bands_damaged(input::BandsDamaged damaged) {
  // The film waits until the bands are rendered again. Then the scheduler requests the result
  // again.
  results_on_the_way_.erase(damaged.job);
  run(damaged);
}

void SchedulerThread::result_written(JobId job, const absl::Status& status) {
  results_on_the_way_.erase(job);
  if (status.ok()) {
    run(input::ResultWritten{.job = job});
  } else {
    storage_failed(job, status);  // the result is requested again when the disk is back
  }
}

}  // namespace bandsaw::coordinator
