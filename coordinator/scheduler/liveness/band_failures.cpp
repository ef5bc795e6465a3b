// When a worker fails a band (a range of rows and samples), the failure is noted in the job, and
// the lease is ended, so that another worker gets the band. A job fails if one of its bands fails
// too often, or if no connected worker may render the job any more.

#include "coordinator/scheduler/liveness/band_failures.h"

#include <cmath>
#include <set>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "coordinator/scheduler/model/band_text.h"
#include "proto/wire/limits.h"
#include "renderlib/base/clean_text.h"

namespace bandsaw::coordinator {
namespace {

/// A job fails when one of its bands failed on this many different workers. It also fails when one
/// of its bands failed this many times and no other worker is left to render the band.
constexpr std::size_t kMaxFailuresPerBand = 3;
/// Factor on the progress timeout while a finished band is being uploaded, possibly over a slow
/// line.
constexpr double kUploadFactor = 20;

}  // namespace

void BandFailures::band_failed(const input::BandFailed& in) {
  Worker* worker = context_.workers.by_session(in.session);
  const Lease* lease = context_.leases.find(in.lease);
  if (worker == nullptr || lease == nullptr || lease->worker != worker->id) {
    return;
  }
  Job& job = context_.jobs.at(lease->job);
  const Band band = lease->band;
  worker->heard_at = context_.clock.timeout_clock();
  if (lease->audit) {
    audits_.give_up(*lease, *worker, in.reason);
    return;
  }
  ledger_.end(in.lease, LeaseLedger::Revoke::kNo);
  job.log_of = worker->name;
  job.log = in.log;
  add(job, *worker, band, in.reason);
}

void BandFailures::add(Job& job, Worker& worker, const Band& band, const std::string& reason) {
  ++worker.on_job[job.id].failures;
  job.failures.push_back({band, worker.instance, clean_text(reason, wire::kReasonBytes)});
  if (job.failures.size() > Job::kMaxFailures) {
    job.failures.pop_front();
  }
  std::set<std::string> names;
  std::size_t count = 0;
  for (const FailedAttempt& failure : job.failures) {
    // Failures of browsers do not count: otherwise anyone who has the link could make any job fail
    // with three browsers.
    if (overlap(failure.band, band) && !context_.is_browser(failure.instance)) {
      names.insert(context_.workers.name_of(failure.instance));
      ++count;
    }
  }
  context_.act(action::LogFailure{job.id, band, worker.name, reason});
  job.notice = absl::StrCat(worker.name, " could not render ", name_of(band), ": ", reason);
  if (names.size() >= kMaxFailuresPerBand ||
      (count >= kMaxFailuresPerBand && !eligibility_.someone_else(job, band))) {
    lifecycle_.end(job, JobState::kFailed,
                   absl::StrCat(name_of(band), " failed ", count, " times, on ",
                                absl::StrJoin(names, ", "), ": ", reason));
  }
}

void BandFailures::check_progress() {
  std::vector<LeaseId> stuck;
  const auto is_late = [this](const Lease& lease) {
    const bool rendered = lease.rows_done >= lease.band.rows.count();
    return context_.clock.timeout_clock() - lease.advanced_at >
           context_.options.progress_timeout_s * (rendered ? kUploadFactor : 1);
  };
  for (const auto& [id, lease] : context_.leases.all()) {
    if (context_.jobs.at(lease.job).state == JobState::kRunning && is_late(lease)) {
      stuck.push_back(id);
    }
  }
  for (const LeaseId id : stuck) {
    const Lease* lease = context_.leases.find(id);
    // When a stuck lease ends, the timeouts of its worker's later leases start again, so these
    // leases are not late any more. The leases of a job that has failed no longer exist.
    if (lease == nullptr || !is_late(*lease)) {
      continue;
    }
    const Band band = lease->band;
    Job& job = context_.jobs.at(lease->job);
    Worker& worker = *context_.workers.by_id(lease->worker);
    const std::string reason = absl::StrCat(
        "no progress for ", std::lround(context_.clock.timeout_clock() - lease->advanced_at), " s");
    if (lease->audit) {
      audits_.give_up(*lease, worker, reason);
      continue;
    }
    ledger_.end(id, LeaseLedger::Revoke::kYes);
    add(job, worker, band, reason);
  }
}

void BandFailures::check_renderable(Job& job) {
  const bool unable = job.state == JobState::kRunning && job.leases.empty() && job.any_free() &&
                      !barrier_.active() && !eligibility_.someone_may_render(job);
  if (!unable) {
    job.unable_since.reset();
    return;
  }
  if (!eligibility_.native_gave_up(job)) {
    return;  // the job waits for a worker; unable_since is not changed
  }
  const Time now = context_.clock.timeout_clock();
  job.unable_since = job.unable_since.value_or(now);
  if (now - *job.unable_since >=
      context_.options.heartbeat_timeout_s + context_.options.reattach_grace_s) {
    lifecycle_.end(
        job, JobState::kFailed,
        absl::StrCat("each worker that is connected failed ", Eligibility::kMaxFailuresPerWorker,
                     " of its bands in a row; the last failure: ", job.notice));
  }
}

}  // namespace bandsaw::coordinator
