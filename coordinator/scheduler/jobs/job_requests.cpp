// Each function handles one request of a user. It checks the request first. Then it emits journal
// records, by which the job is changed.

#include "coordinator/scheduler/jobs/job_requests.h"

#include <variant>
#include <vector>

#include "absl/strings/str_cat.h"
#include "proto/wire/limits.h"

namespace bandsaw::coordinator {
namespace {

/// Maximum number of known jobs, final ones included; bounds the memory.
constexpr std::size_t kMaxJobs = 100'000;

/// Returns true if the numbers of samples are in [1, kMaxSamples], and the target of the error or
/// the limit of time is above 0.
bool in_range(const StopRule& stop) {
  struct InRange {
    static bool samples(std::uint64_t n) { return n >= 1 && n <= kMaxSamples; }
    bool operator()(const StopAtSamples& rule) const { return samples(rule.samples); }
    bool operator()(const StopAtError& rule) const {
      return rule.relative_rmse > 0 && samples(rule.max_samples);
    }
    bool operator()(const StopAtTime& rule) const {
      return rule.seconds > 0 && samples(rule.max_samples);
    }
  };
  return std::visit(InRange{}, stop);
}

absl::Status no_such_job(JobId id) {
  return absl::NotFoundError(absl::StrCat("there is no job ", id));
}

}  // namespace

void JobRequests::submit(const input::Submit& in) {
  if (const auto known = context_.jobs.by_request(in.spec.request_id)) {
    context_.answer_job(*known);
    if (context_.jobs.find(*known)->spec != in.spec) {
      context_.answer(absl::AlreadyExistsError(
          absl::StrCat("request id ", in.spec.request_id, " is job ", *known,
                       " with another scene or other settings; submit with a new request id")));
    }
    return;
  }
  if (absl::Status status = refusal(in.spec.stop, in.spec.settings, in.priority, /*more=*/1);
      !status.ok()) {
    context_.answer(std::move(status));
    return;
  }
  context_.answer_job(add(in.spec, in.priority));
}

JobId JobRequests::add(const JobSpec& spec, std::int32_t priority) {
  const JobId id = context_.jobs.next_id();
  context_.emit(record::JobAdded{id, spec, context_.options.compatibility.pixel_version});
  if (priority != 0) {
    context_.emit(record::PriorityChanged{id, priority});
  }
  planner_.plan_first(context_.jobs.at(id));
  return id;
}

absl::Status JobRequests::refusal(const StopRule& stop, const RenderSettings& settings,
                                  std::int32_t priority, std::size_t more) const {
  if (absl::Status status = check_priority(priority); !status.ok()) {
    return status;
  }
  if (!in_range(stop) || settings.width == 0 || settings.height == 0) {
    return absl::InvalidArgumentError(absl::StrCat(
        "the stop rule or the image size is out of range: samples must be in [1, ", kMaxSamples,
        "], error and time must be above 0, width and height must be at least 1"));
  }
  // Frame jobs do not count as active: their number is limited in Sequences::advance.
  std::size_t active = context_.jobs.active().size() + context_.sequences.active().size();
  std::size_t known = context_.jobs.all().size();
  for (const JobId id : context_.sequences.active()) {
    const FrameCounts& frames = context_.sequences.at(id).counts();
    active -= frames.of(FrameState::kRendering);
    known += frames.of(FrameState::kExpected) + frames.of(FrameState::kWaiting);
  }
  if (active >= wire::kActiveJobs || known + more > kMaxJobs) {
    return absl::ResourceExhaustedError(
        absl::StrCat(active, " jobs are not done yet (at most ", wire::kActiveJobs, "), ", known,
                     " are known (at most ", kMaxJobs,
                     "); wait for a job, cancel one, or keep old ones for a shorter time (`bandsaw "
                     "serve --keep-days`)"));
  }
  return absl::OkStatus();
}

absl::Status JobRequests::check_priority(std::int32_t priority) {
  if (priority < -kMaxPriority || priority > kMaxPriority) {
    return absl::InvalidArgumentError(absl::StrCat("a priority must be in [", -kMaxPriority, ", ",
                                                   kMaxPriority, "], is ", priority));
  }
  return absl::OkStatus();
}

void JobRequests::cancel(const input::Cancel& in) {
  Job* job = context_.jobs.find(in.job);
  if (job == nullptr) {
    context_.answer(no_such_job(in.job));
  } else if (!is_final(job->state)) {
    lifecycle_.end(*job, JobState::kCancelled, "");
  }
}

/// Returns the job with this id. If there is none or it is final, returns nullptr and sets the
/// status of the step to an error.
Job* JobRequests::find_active(JobId id) {
  Job* job = context_.jobs.find(id);
  if (job == nullptr) {
    context_.answer(no_such_job(id));
    return nullptr;
  }
  if (is_final(job->state)) {
    context_.answer(absl::FailedPreconditionError(absl::StrCat("job ", id, " is over")));
    return nullptr;
  }
  return job;
}

void JobRequests::pause(const input::Pause& in) {
  Job* job = find_active(in.job);
  if (job == nullptr || job->held) {
    return;
  }
  if (job->state == JobState::kFinishing) {
    context_.answer(absl::FailedPreconditionError(
        absl::StrCat("job ", in.job, " is finishing: all of it is rendered")));
    return;
  }
  hold(*job);
}

void JobRequests::hold(Job& job) {
  context_.emit(record::HoldChanged{job.id, /*held=*/true});
  context_.emit(record::StateChanged{job.id, JobState::kPaused, kPausedByUser});
  std::vector<LeaseId> not_begun;
  for (const LeaseId id : job.leases) {
    const Worker& worker = *context_.workers.by_id(context_.leases.find(id)->worker);
    if (worker.leases.front() != id) {
      not_begun.push_back(id);
    }
  }
  ledger_.end_all(not_begun, LeaseLedger::Revoke::kYes);
}

void JobRequests::resume(const input::Resume& in) {
  if (Job* job = find_active(in.job)) {
    release(*job);
  }
}

void JobRequests::release(Job& job) {
  if (job.held) {
    context_.emit(record::HoldChanged{job.id, /*held=*/false});
  }
  if (job.state == JobState::kPaused) {
    lifecycle_.resume(job);
  }
}

void JobRequests::set_priority(const input::SetPriority& in) {
  const Job* job = find_active(in.job);
  if (job == nullptr || job->priority == in.priority) {
    return;
  }
  if (absl::Status status = check_priority(in.priority); !status.ok()) {
    context_.answer(std::move(status));
    return;
  }
  context_.emit(record::PriorityChanged{job->id, in.priority});
}

void JobRequests::forget(const input::Forget& in) {
  for (const JobId id : in.jobs) {
    const Job* job = context_.jobs.find(id);
    if (job != nullptr && is_final(job->state) &&
        context_.sequences.find(job->spec.sequence) == nullptr) {
      context_.emit(record::JobForgotten{id});
      context_.act(action::DropJob{id});
    }
  }
}

}  // namespace bandsaw::coordinator
