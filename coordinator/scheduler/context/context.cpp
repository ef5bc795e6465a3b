// apply() changes the durable state (what the journal rebuilds after a restart) for each kind of
// record; the other functions answer questions about the state that the scheduler's parts share.

#include "coordinator/scheduler/context/context.h"

#include "coordinator/scheduler/api/worker_process.h"

namespace bandsaw::coordinator {

// One input advances the timeout clock by at most a third of the heartbeat timeout. So if hours lie
// between two inputs, workers whose messages are still unread do not time out at once.
Context::Context(SchedulerOptions scheduler_options)
    : options(std::move(scheduler_options)),
      clock(options.heartbeat_timeout_s / 3),
      leases(options.epoch) {}

void Context::flush_revocations() {
  for (auto& [session, ids] : revoked_) {
    act(action::Revoke{session, std::move(ids)});
  }
  revoked_.clear();
}

bool Context::is_silent(const Worker& worker) const {
  return clock.timeout_clock() - worker.heard_at > 2 * options.heartbeat_interval_s;
}

Reporter Context::reporter_of(const input::BandStored& in) const {
  if (in.instance.empty()) {
    return absent(in.process);
  }
  const Worker* worker = workers.by_instance(in.instance);
  return worker == nullptr ? absent(worker_process_id(in.instance)) : worker->reporter();
}

Reporter Context::reporter_of(WorkerProcessId process) const {
  const Worker* worker = workers.by_process(process);
  return worker == nullptr ? absent(process) : worker->reporter();
}

/// Returns the origin of a result whose worker is not known any more.
Reporter Context::absent(WorkerProcessId process) const {
  return {.process = process, .machine = {}, .browser = browsers.contains(process)};
}

bool Context::is_browser(const std::string& instance) const {
  return browsers.contains(worker_process_id(instance));
}

void Context::note_natives() {
  if (available.natives() > 0) {
    native_seen_at_ = clock.timeout_clock();
  }
}

bool Context::only_browsers() const {
  return available.natives() == 0 && clock.timeout_clock() - native_seen_at_ >= kNativesAway_s;
}

std::string Context::name_of(const Reporter& reporter) const {
  if (const Worker* worker = workers.by_process(reporter.process)) {
    return worker->name;
  }
  return reporter.browser           ? "a browser that has left"
         : reporter.machine.empty() ? "a worker that has left"
                                    : reporter.machine;
}

void Context::apply(const Record& record) {
  std::visit([this](const auto& r) { apply(r); }, record);
}

void Context::apply(const record::JobAdded& r) {
  jobs.add(r.job, r.spec, r.pixel_version);
  if (Sequence* sequence = sequences.find(r.spec.sequence)) {
    sequence->start(r.spec.frame, r.job);
  }
}

void Context::apply(const record::PassPlanned& r) {
  Job* job = jobs.find(r.job);
  if (job != nullptr && !is_final(job->state)) {
    job->add_pass(r.samples);
    jobs.mark_leasable(*job);
  }
}

void Context::apply(const record::TilesPlanned& r) {
  Job* job = jobs.find(r.job);
  if (job != nullptr && !is_final(job->state)) {
    job->plan_tiles(r.plan);
  }
}

void Context::apply(const record::SamplesFixed& r) {
  if (Job* job = jobs.find(r.job)) {
    job->fix_samples(r.samples);
  }
}

void Context::apply(const record::StateChanged& r) {
  const auto forget_rates = [&] {  // the statistics of each worker on this job
    for (auto& [id, worker] : workers.all()) {
      worker.on_job.erase(r.job);
    }
  };
  if (Sequence* sequence = sequences.find(r.job)) {
    if (is_final(sequence->state)) {  // failed frames are tried again
      sequence->restart_clock();
    } else if (r.state == JobState::kPaused) {
      sequence->clock.stop(clock.wall());
    }
    sequence->state = r.state;
    sequence->reason = r.reason;
    sequences.set_active(r.job, !is_final(r.state));
    if (is_final(r.state)) {
      forget_rates();
    }
    return;
  }
  Job* job = jobs.find(r.job);
  if (job == nullptr || is_final(job->state)) {
    return;
  }
  if (r.state == JobState::kPaused) {
    job->stop_clock(clock.wall());
  }
  Sequence* sequence = sequences.find(job->spec.sequence);
  if (is_final(r.state)) {
    if (jobs.active() == std::set<JobId>{r.job}) {  // it is the last active job
      forget_browsers();
    }
    // The next frames of the sequence start with the costs and the rate of this one.
    if (sequence != nullptr && r.state == JobState::kDone && job->work_rate.measured()) {
      sequence->cost = job->cost;
      sequence->work_rate = job->work_rate;
    }
    job->drop_details();
    jobs.set_final(r.job);
    forget_rates();
  }
  job->state = r.state;
  job->reason = r.reason;
  if (sequence != nullptr && is_final(r.state)) {
    sequence->end(*job);
  }
  if (r.state != JobState::kRunning) {
    jobs.unmark_leasable(*job);
  }
}

/// Forgets the browsers that have left. Called when no active job has bands that browsers rendered.
/// Connected browsers are kept, because they may render more bands.
void Context::forget_browsers() {
  std::erase_if(browsers, [&](const auto& entry) { return !joined.contains(entry.second); });
  quarantine.forget_browsers();
}

void Context::apply(const record::PriorityChanged& r) {
  if (Job* job = jobs.find(r.job)) {
    jobs.set_priority(*job, r.priority);
  } else if (Sequence* sequence = sequences.find(r.job)) {
    sequence->priority = r.priority;
  }
}

void Context::apply(const record::HoldChanged& r) {
  if (Job* job = jobs.find(r.job)) {
    job->held = r.held;
    job->held_at = clock.timeout_clock();
  } else if (Sequence* sequence = sequences.find(r.job)) {
    sequence->held = r.held;
  }
}

void Context::apply(const record::TimeSpent& r) {
  if (Job* job = jobs.find(r.job)) {
    job->elapsed_noted = r.elapsed_s;
  } else if (Sequence* sequence = sequences.find(r.job)) {
    sequence->elapsed_noted = r.elapsed_s;
  }
}

void Context::apply(const record::JobSummary& r) {
  if (Job* job = jobs.find(r.job); job != nullptr && !is_final(job->state)) {
    job->summary = r;
  }
}

void Context::apply(const record::ErrorMeasured& r) {
  if (Job* job = jobs.find(r.job)) {
    add_point(job->curve, r.point);
  }
}

void Context::apply(const record::ShareCounted& r) {
  Job* job = jobs.find(r.job);
  if (job != nullptr && job->final_shares.size() < Job::kMaxFinalShares) {
    job->final_shares.push_back(r.share);
  }
}

void Context::apply(const record::FailureLog& r) {
  if (Job* job = jobs.find(r.job)) {
    job->log_of = r.worker;
    job->log = r.log;
  }
}

void Context::apply(const record::JobForgotten& r) {
  sequences.remove(r.job);
  jobs.remove(r.job);
}
void Context::apply(const record::WorkerJoined& r) {
  joined.insert(r.instance);
  if (r.browser) {
    if (browsers.size() >= kMaxBrowsers) {
      browsers.erase(browsers.begin());
    }
    browsers[worker_process_id(r.instance)] = r.instance;
  }
}
void Context::apply(const record::WorkerLeft& r) { joined.erase(r.instance); }

void Context::apply(const record::BandAudited& r) {
  if (Job* job = jobs.find(r.job); job != nullptr && !is_final(job->state)) {
    job->audited.insert({r.band, r.process});
    job->settle_disputes(r.band, r.process);
  }
}

void Context::apply(const record::BandLost& r) {
  if (Job* job = jobs.find(r.job); job != nullptr && !is_final(job->state)) {
    job->remove_stored(r.band, r.process);
  }
}

void Context::apply(const record::RowDisputed& r) {
  if (Job* job = jobs.find(r.job); job != nullptr && !is_final(job->state)) {
    job->disputes.push_back(r);
  }
}

// A job with an error target decides its number of samples again, because that number followed from
// the error that is void now.
void Context::apply(const record::ErrorForgotten& r) {
  if (Job* job = jobs.find(r.job); job != nullptr && !is_final(job->state)) {
    job->curve.clear();
    job->error = -1;
    job->error_samples = 0;
    job->pending_checkpoint.reset();
    if (std::holds_alternative<StopAtError>(job->spec.stop)) {
      job->fixed_samples.reset();
    }
  }
}

// All results of the process are void. So the disputes (rows for which two machines returned
// different digests) in which the process is involved are removed.
void Context::apply(const record::WorkerQuarantined& r) {
  quarantine.add(r);
  for (const JobId id : jobs.active()) {
    std::erase_if(jobs.at(id).disputes, [&](const record::RowDisputed& one) {
      return one.stored.process == r.process || one.other.process == r.process;
    });
  }
}
void Context::apply(const record::QuarantineLifted& r) { quarantine.lift(r.name); }

void Context::apply(const record::SequenceAdded& r) {
  sequences.add(r.job, r.spec, r.pixel_version);
  jobs.never_reuse(r.job);
}

void Context::apply(const record::FrameWaits& r) {
  if (Sequence* sequence = sequences.find(r.job)) {
    sequence->wait({r.frame, r.manifest, r.package_bytes}, r.failures, r.reason);
  }
}

}  // namespace bandsaw::coordinator
