#include "coordinator/engine/core_desk.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <utility>

#include "absl/strings/str_cat.h"
#include "coordinator/engine/job_log.h"
#include "proto/wire/limits.h"

namespace bandsaw::coordinator {
namespace {

constexpr double kTick_s = 0.1;
constexpr double kCollectEvery_s = 600;
constexpr std::size_t kCollectEveryJobs = 1'000;

}  // namespace

CoreDesk::CoreDesk(SchedulerOptions options, Journal& journal, Reserve reserve, const Clock& clock,
                   Hooks hooks)
    : core_(options),
      journal_(journal),
      reserve_(std::move(reserve)),
      clock_(clock),
      hooks_(std::move(hooks)),
      outbox_(journal),
      links_(options.epoch),
      logs_(wire::kLogLinesKept, wire::kLogBytesKept) {}

Step CoreDesk::run(const Input& input, PutBand* put) {
  Step step = core_.step(input, clock_.now());
  absorb(step, put);
  return step;
}

void CoreDesk::absorb(const Step& step, PutBand* put) {
  for (const Record& record : step.records) {
    note(record);
    log_record(record);
    outbox_.record(record);
    outbox_.deed([this, record] { tell_others(record); });
  }
  for (const Action& action : step.actions) {
    const auto* add = std::get_if<action::AddToFilm>(&action);
    if (add != nullptr && put != nullptr) {
      PutBand band;
      band.job = put->job;
      band.worker = add->worker;
      band.renderer = put->renderer;
      band.pixels = std::move(put->pixels);
      band.share = std::move(put->share);
      band.offset = put->offset;
      band.tiles = add->tiles;
      outbox_.deed([this, rows = add->rows, band = std::move(band)]() mutable {
        hooks_.add_to_film(std::move(band), std::move(rows));
      });
    } else {
      outbox_.deed([this, action] { perform(action); });
    }
  }
  if (absl::IsInternal(step.status)) {
    spdlog::error("the core: {}", step.status.ToString());
  }
}

void CoreDesk::perform(const Action& action) {
  if (const auto* result = std::get_if<action::WriteResult>(&action)) {
    if (results_on_the_way_.insert(result->job).second) {
      hooks_.make_result(result->job, result->samples);
    }
  } else if (const auto* drop = std::get_if<action::DropBands>(&action)) {
    results_on_the_way_.erase(drop->job);
    hooks_.drop_bands(drop->job);
  } else if (const auto* retracted = std::get_if<action::Retract>(&action)) {
    hooks_.retract(retracted->job, retracted->process);
  } else if (const auto* forgotten = std::get_if<action::DropJob>(&action)) {
    hooks_.drop_job(forgotten->job);
  } else if (const auto* shared = std::get_if<action::LogReassignment>(&action)) {
    log_shared(*shared);
  } else if (const auto* fault = std::get_if<action::LogFailure>(&action)) {
    log_fault(*fault);
  } else {
    std::visit(
        [this](const auto& one) {
          if constexpr (requires { links_.perform(one); }) {
            links_.perform(one);
          }
        },
        action);
  }
}

void CoreDesk::note(const Record& record) {
  if (const auto* added = std::get_if<record::JobAdded>(&record)) {
    known_[added->job].spec = added->spec;
    ++added_since_;
  } else if (const auto* pass = std::get_if<record::PassPlanned>(&record)) {
    known_[pass->job].pass_ends.push_back(pass->samples.last);
  } else if (const auto* changed = std::get_if<record::StateChanged>(&record)) {
    known_[changed->job].state = changed->state;
  } else if (const auto* forgotten = std::get_if<record::JobForgotten>(&record)) {
    known_.erase(forgotten->job);
  }
}

void CoreDesk::tell_others(const Record& record) {
  if (const auto* added = std::get_if<record::JobAdded>(&record)) {
    hooks_.add_job(added->job, added->spec);
  } else if (const auto* pass = std::get_if<record::PassPlanned>(&record)) {
    hooks_.plan_pass(pass->job, pass->samples.last);
  }
}

bool CoreDesk::over(JobId id) const {
  const auto known = known_.find(id);
  return known == known_.end() || is_final(known->second.state);
}

void CoreDesk::settle() {
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
    outbox_.fail_replies(journal_status_);
  }
  const auto view_of = [this](JobId id) { return job(id); };
  watchers_.update(view_of, !journal_status_.ok(), clock_.now());
}

void CoreDesk::collect() {
  const Time now = clock_.now();
  if (collected_at_ && now - *collected_at_ < kCollectEvery_s && added_since_ < kCollectEveryJobs) {
    return;
  }
  collected_at_ = now;
  added_since_ = 0;
  std::vector<Collector::Job> jobs;
  for (const auto& [id, known] : known_) {
    jobs.push_back({id, known.spec.manifest, is_final(known.state)});
  }
  hooks_.collect(std::move(jobs));
}

/// Only where nothing waits for the journal: then what the core knows is what the journal holds.
void CoreDesk::compact() {
  if (!outbox_.empty() || journal_.size() <= compact_above_) {
    return;
  }
  const std::vector<Record> records = core_.snapshot();
  const std::uint64_t before = journal_.size();
  if (2 * records.size() <= before) {
    if (const absl::Status status = journal_.rewrite(records); !status.ok()) {
      spdlog::warn("the journal could not be written anew: {}", status.ToString());
    } else {
      spdlog::info("the journal was written anew: {} records, {} before", records.size(), before);
    }
  }
  compact_above_ = std::max<std::uint64_t>(kCompactAbove, 2 * journal_.size());
}

bool CoreDesk::flush() {
  if (const absl::Status written = outbox_.write();
      absl::IsResourceExhausted(written) && reserve_.release()) {
    no_room(written);
  }
  const absl::Status flushed = outbox_.flush();
  if (flushed.ok()) {
    journal_status_ = flushed;
    return true;
  }
  journal_failed(flushed);
  return false;
}

void CoreDesk::journal_failed(const absl::Status& status) {
  hooks_.expect_trouble();
  if (!journal_status_.ok()) {
    return;
  }
  journal_status_ = absl::ResourceExhaustedError(
      absl::StrCat("the coordinator cannot write its journal: ", status.message()));
  spdlog::error("{}", journal_status_.ToString());
  pause_all(journal_status_);
}

void CoreDesk::no_room(const absl::Status& status) {
  hooks_.expect_trouble();
  if (!room_.ok()) {
    return;
  }
  room_ = absl::ResourceExhaustedError(absl::StrCat(
      "the coordinator's disk is full: ", status.message(),
      "; jobs are paused and nothing new is taken until there is room: cancel jobs, or free some"));
  spdlog::error("{}", room_.ToString());
  hooks_.room(false);
  pause_all(room_);
}

void CoreDesk::pause_all(const absl::Status& status) {
  for (const auto& [id, known] : known_) {
    if (!is_final(known.state)) {
      storage_failed(id, status);
    }
  }
}

void CoreDesk::storage_failed(JobId job, const absl::Status& status) {
  spdlog::warn("job={} storage failed: {}", job, status.ToString());
  run(input::StorageFailed{.job = job, .reason = std::string(status.message())});
}

void CoreDesk::disk_is_back() {
  if (!flush()) {
    return;
  }
  if (const absl::Status held = reserve_.hold(); !held.ok()) {
    no_room(held);
    return;
  }
  room_ = absl::OkStatus();
  hooks_.room(true);
  spdlog::info("the disk takes data again");
  run(input::StorageBack{});
  hooks_.retry_film();
}

void CoreDesk::bands_damaged(input::BandsDamaged damaged) {
  results_on_the_way_.erase(damaged.job);  // the film waits for the bands; the core asks again
  run(damaged);
}

void CoreDesk::result_written(JobId job, const absl::Status& status) {
  results_on_the_way_.erase(job);
  if (status.ok()) {
    run(input::ResultWritten{.job = job});
  } else {
    storage_failed(job, status);  // the core asks again when the disk is back
  }
}

}  // namespace bandsaw::coordinator
