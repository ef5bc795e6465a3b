// step() passes the input to the part that handles it, then lets the other parts react in a fixed
// order (finish_step). It returns the records for the journal and the actions for the engine that
// the parts have collected in the context.

#include "coordinator/scheduler/scheduler.h"

#include <set>
#include <utility>

#include "coordinator/scheduler/dispatch/work_rate.h"
#include "coordinator/scheduler/replay/invariants.h"
#include "coordinator/scheduler/replay/snapshot.h"

namespace bandsaw::coordinator {

Scheduler::Scheduler(SchedulerOptions options)
    : context_(std::move(options)),
      barrier_(context_),
      ledger_(context_),
      eligibility_(context_),
      chooser_(context_, eligibility_),
      audits_(context_, ledger_, eligibility_, barrier_),
      planner_(context_, ledger_),
      dispatcher_(context_, ledger_, eligibility_, chooser_, audits_, planner_),
      lifecycle_(context_, ledger_, planner_, audits_),
      requests_(context_, ledger_, planner_, lifecycle_),
      sequences_(context_, requests_, lifecycle_),
      bands_(context_, ledger_),
      crashes_(context_, eligibility_, lifecycle_),
      failures_(context_, ledger_, eligibility_, audits_, barrier_, lifecycle_),
      sessions_(context_, ledger_, barrier_, crashes_),
      quarantine_(context_, ledger_, sessions_),
      comparison_(context_, ledger_, quarantine_),
      views_(context_, eligibility_, audits_, barrier_, sessions_),
      restart_(context_, barrier_, planner_, lifecycle_, bands_, comparison_, sequences_) {}

Step Scheduler::step(const Input& input, Time now) {
  context_.clock.advance(now);
  std::visit([this](const auto& in) { on(in); }, input);
  return finish_step();
}

/// Continues the sequences, revokes the leases that the input has ended, grants leases to the
/// workers, and revokes the leases that ended while leases were granted.
Step Scheduler::finish_step() {
  sequences_.advance();
  context_.flush_revocations();
  if (!barrier_.active()) {
    dispatcher_.assign();
  }
  context_.flush_revocations();
  return context_.take_step();
}

/// Does what depends on time alone: ends what has timed out, and continues each active job.
void Scheduler::on(const input::Tick&) {
  context_.note_natives();  // notes when a native worker (not a browser) was last connected
  barrier_.expire();
  lifecycle_.revoke_from_held_jobs();
  sessions_.forget_refusals();
  sessions_.check_silence();
  failures_.check_progress();
  const std::set<JobId> active = context_.jobs.active();
  for (const JobId id : active) {
    Job& job = context_.jobs.at(id);
    lifecycle_.advance(job);
    lifecycle_.note_time(job);
    failures_.check_renderable(job);
  }
  sequences_.note_times();
}

/// First compares the result with the stored digests of its rows, which may put the sending machine
/// under quarantine. If the machine is not under quarantine, measures the work rate, counts the
/// rows as stored, and ends the leases whose rows nobody needs any more.
void Scheduler::on(const input::BandStored& in) {
  Job* job = context_.jobs.find(in.job);
  Pass* pass = job == nullptr || is_final(job->state) ? nullptr : job->pass_of(in.band);
  if (pass == nullptr) {
    return;
  }
  if (in.row_digests.size() != in.band.rows.count()) {
    context_.answer(absl::InternalError("a stored band needs one digest a row"));
    return;
  }
  const Reporter reporter = context_.reporter_of(in);
  if (!context_.quarantine.contains(reporter.process)) {
    comparison_.compare(*job, *pass, in, reporter);
  }
  if (context_.quarantine.contains(reporter.process)) {
    lifecycle_.advance(*job);
    return;
  }
  Worker* worker = context_.workers.by_instance(in.instance);
  if (worker != nullptr) {
    measure(*worker, *job, in);
    worker->on_job[job->id].failures = 0;
    // From the counted bands, crashes_ estimates how often native workers crash by chance. So bands
    // of browsers and suspect bands (bands that a worker held when it was lost) are not counted.
    if (!job->is_suspect(in.band) && !worker->browser) {
      crashes_.count_band();
    }
  }
  Coverage::Change change;
  if (in.written) {  // false: all rows were stored already, so the result was only compared
    change = bands_.store(*job, *pass, in, reporter);
    comparison_.open_audits(*job, in, reporter, change.rows);
  }
  if (worker != nullptr) {
    ledger_.end_rendered(*worker, in.job, in.band);
  }
  ledger_.end_overtaken(change.overtaken);
  ledger_.end_useless_backups(*job);
  if (!change.rows.empty()) {
    context_.act(action::AddToFilm{.job = job->id,
                                   .band = in.band,
                                   .rows = change.rows,
                                   .worker = worker == nullptr ? std::string() : worker->name,
                                   .tiles = pass->tiles_of(in.band)});
  }
  lifecycle_.advance(*job);
}

void Scheduler::on(const input::BandsDamaged& in) {
  Job* job = context_.jobs.find(in.job);
  if (job != nullptr && !is_final(job->state)) {
    bands_.free_damaged(*job, in);
    lifecycle_.advance(*job);
  }
}

void Scheduler::replay(const Record& record) { context_.apply(record); }
void Scheduler::replay(const input::BandStored& band) { restart_.add_band(band); }
void Scheduler::replay_damage(JobId job, std::uint64_t bytes) { restart_.note_damage(job, bytes); }

Step Scheduler::replayed(Time now) {
  context_.clock.advance(now);
  restart_.finish();
  return finish_step();
}

std::optional<std::vector<RowRange>> Scheduler::wanted(JobId id, const Band& band) const {
  const Job* job = context_.jobs.find(id);
  const Pass* pass = job == nullptr || is_final(job->state) ? nullptr : job->pass_of(band);
  return pass == nullptr ? std::nullopt : std::optional(pass->coverage.wanted(band));
}

TileSamples Scheduler::tiles(JobId id, const Band& band) const {
  const Job* job = context_.jobs.find(id);
  const Pass* pass = job == nullptr ? nullptr : job->pass_of(band);
  return pass == nullptr ? TileSamples() : pass->tiles_of(band);
}

std::vector<Record> Scheduler::snapshot() const { return coordinator::snapshot(context_); }

std::optional<JobView> Scheduler::job(JobId id, Time now) const { return views_.job(id, now); }
std::vector<std::string> Scheduler::why(JobId id, Time now) const { return views_.why(id, now); }
std::vector<JobView> Scheduler::jobs(Time now, const JobPage& page) const {
  return views_.jobs(now, page);
}
std::optional<std::vector<FrameView>> Scheduler::frames(JobId id, std::uint64_t after) const {
  return views_.frames(id, after);
}
std::vector<WorkerView> Scheduler::workers(Time now) const { return views_.workers(now); }
bool Scheduler::is_browser(const std::string& instance) const {
  return context_.is_browser(instance);
}

std::optional<std::string> Scheduler::broken_invariant() const {
  return coordinator::broken_invariant(context_);
}

}  // namespace bandsaw::coordinator
