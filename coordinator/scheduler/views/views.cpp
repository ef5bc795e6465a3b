// Builds the views of jobs and workers, and the sentences that explain why a job or a worker waits.
// These sentences are made by idle_reason() and the functions after it.

#include "coordinator/scheduler/views/views.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <string>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/strings/str_join.h"
#include "coordinator/scheduler/model/band_text.h"
#include "coordinator/scheduler/views/progress.h"
#include "coordinator/scheduler/views/sequence_views.h"

namespace bandsaw::coordinator {
namespace {

/// Maximum number of lines in each list of sentences about workers. One more line counts the rest.
constexpr std::size_t kMaxLines = 10;

std::string priority_text(std::int32_t priority) {
  return priority == 0 ? "" : absl::StrCat(" (priority ", priority, ")");
}

/// Returns the reason, and then the log of the worker that failed last.
std::vector<std::string> failed_because(const Job& job, std::string reason) {
  std::vector<std::string> lines = {std::move(reason)};
  for (const std::string& line : job.log) {
    lines.push_back(absl::StrCat(job.log_of, " | ", line));
  }
  return lines;
}

/// Returns a size as text, for example "1.5 GB".
std::string size_text(double bytes) {
  return bytes < 1e9 ? absl::StrFormat("%.0f MB", std::ceil(bytes / 1e6))
                     : absl::StrFormat("%.1f GB", std::ceil(bytes / 1e8) / 10);
}

/// Returns why the scene of a job does not fit into a worker's memory.
std::string memory_reason(const Worker& worker, const Job& job) {
  const std::string has =
      absl::StrCat("it has ", size_text(static_cast<double>(worker.memory_bytes)));
  return job.spec.package_bytes == 0
             ? absl::StrCat("the size of its scene is not known, and ", has, " of memory")
             : absl::StrCat("its scene needs about ",
                            size_text(static_cast<double>(job.spec.package_bytes) *
                                      Eligibility::kMemoryPerPackageByte),
                            " of memory, ", has);
}

const char* state_of(const Worker& worker) {
  return worker.quarantined      ? "quarantined"
         : !worker.session       ? "lost"
         : worker.draining       ? "draining"
         : worker.leases.empty() ? "idle"
                                 : "rendering";
}

}  // namespace

std::optional<JobView> Views::job(JobId id, Time now) const {
  if (const Sequence* sequence = context_.sequences.find(id)) {
    return sequence_view(context_, *sequence, now);
  }
  const Job* job = context_.jobs.find(id);
  return job == nullptr ? std::nullopt : std::optional(view(*job, now));
}

std::optional<std::vector<FrameView>> Views::frames(JobId id, std::uint64_t after) const {
  const Sequence* sequence = context_.sequences.find(id);
  return sequence == nullptr ? std::nullopt : std::optional(frame_views(*sequence, after));
}

std::vector<KeptJob> Views::kept() const {
  std::vector<KeptJob> out;
  for (const auto& [id, job] : context_.jobs.all()) {
    if (context_.sequences.find(job.spec.sequence) == nullptr) {
      out.push_back({id, is_final(job.state), {job.spec.manifest}, {}});
    }
  }
  for (const auto& [id, sequence] : context_.sequences.all()) {
    KeptJob kept{id, is_final(sequence.state), {}, {}};
    for (const Sequence::Frame& frame : sequence.frames()) {
      if (!frame.manifest.empty()) {
        kept.manifests.push_back(frame.manifest);
      }
      if (frame.job != 0) {
        kept.frame_jobs.push_back(frame.job);
      }
    }
    out.push_back(std::move(kept));
  }
  return out;
}

JobView Views::view(const Job& job, Time now) const {
  const bool over = is_final(job.state);
  const Totals totals = job.totals();
  JobView view;
  view.id = job.id;
  view.spec = job.spec;
  view.state = job.state;
  view.reason = !job.reason.empty() ? job.reason : waiting_reason(job);
  if (view.reason.empty()) {
    view.reason = job.damage;
  }
  view.elapsed_s = job.elapsed(std::max(now, context_.clock.wall()));
  view.fraction = fraction_done(job, now);
  view.remaining_s = remaining_s(context_, job, now);
  view.samples_per_s = over ? 0 : job.throughput.per_second(now);
  view.samples_done = totals.samples;
  // The pixels of an adaptive job take different numbers of samples, so their mean is shown.
  const bool uneven = job.tile_plan || (over && is_adaptive(job.spec.stop));
  view.samples_per_pixel = uneven ? totals.samples / job.pixels() : job.complete_samples();
  view.error = over && job.summary ? job.summary->error : job.error;
  view.counters = totals.counters;
  view.cpu_s = totals.cpu_s;
  view.workers_used = over && job.summary ? job.summary->workers_used
                                          : static_cast<std::uint32_t>(job.shares.size());
  view.priority = job.priority;
  if (job.state == JobState::kFailed) {
    view.log_of = job.log_of;
    view.log = job.log;
  }
  view.bands_copied = job.backups_granted;
  view.bands_audited = job.audited.size();
  view.workers = workers_on(context_, job);
  view.curve = job.curve;
  view.shares = job.final_shares;
  return view;
}

std::vector<JobView> Views::jobs(Time now, const JobPage& page) const {
  std::vector<JobView> views;
  const auto& jobs = context_.jobs.all();
  for (auto at = jobs.upper_bound(page.after); at != jobs.end() && views.size() < page.most; ++at) {
    if (context_.sequences.find(at->second.spec.sequence) != nullptr) {
      continue;
    }
    views.push_back(view(at->second, now));
    views.back().curve.clear();
    views.back().log.clear();
    views.back().shares.clear();
  }
  const auto& sequences = context_.sequences.all();
  std::size_t left = page.most;
  for (auto at = sequences.upper_bound(page.after); at != sequences.end() && left > 0; ++at) {
    views.push_back(sequence_view(context_, at->second, now));
    --left;
  }
  std::sort(views.begin(), views.end(),
            [](const JobView& a, const JobView& b) { return a.id < b.id; });
  views.erase(views.begin() + static_cast<std::ptrdiff_t>(std::min(views.size(), page.most)),
              views.end());
  return views;
}

std::vector<WorkerView> Views::workers(Time now) const {
  std::vector<WorkerView> views;
  for (const auto& [id, worker] : context_.workers.all()) {
    WorkerView view;
    view.name = worker.name;
    view.state = state_of(worker);
    view.reason = worker.reason.empty() ? idle_reason(worker) : worker.reason;
    view.address = worker.address;
    view.build = worker.build;
    view.threads = worker.threads;
    view.samples_per_s = worker.speed.mean();
    view.job = worker.leases.empty() ? 0 : context_.leases.find(worker.leases.front())->job;
    view.browser = worker.browser;
    view.connected_s = worker.session ? std::max(0.0, now - worker.connected_at) : 0;
    views.push_back(std::move(view));
  }
  for (const Refusal& refusal : sessions_.refusals()) {
    views.push_back(refusal.worker);
  }
  for (WorkerView& view : absent_quarantined()) {
    views.push_back(std::move(view));
  }
  std::sort(views.begin(), views.end(),
            [](const WorkerView& a, const WorkerView& b) { return a.name < b.name; });
  return views;
}

/// Returns why an idle worker may not render the first job that has bands to give. Returns "" if it
/// may render one of the jobs that have bands to give, or if it is not eligible or not idle.
std::string Views::idle_reason(const Worker& worker) const {
  if (!worker.eligible() || !worker.leases.empty()) {
    return "";
  }
  std::string reason;
  for (const JobTable::Rank& rank : context_.jobs.leasable()) {
    const Job& job = context_.jobs.at(rank.job);
    if (eligibility_.may_render(worker, job)) {
      return "";
    }
    if (reason.empty()) {
      reason = absl::StrCat("gets no bands of job ", rank.place, ": ", refusal(worker, job));
    }
  }
  return reason;
}

/// Returns why the worker may not render the job. REQUIRES: Eligibility::may_render is false. If
/// the farm renders in browsers only, a native worker renders only bands that browsers have
/// rendered, so that the results are compared.
std::string Views::refusal(const Worker& worker, const Job& job) const {
  return !Eligibility::fits(worker, job)              ? memory_reason(worker, job)
         : Eligibility::failed_too_often(worker, job) ? "it failed too often"
         : worker.browser ? "native workers must first compare what browsers have rendered"
                          : "the farm renders in browsers only (--browsers only); this worker only "
                            "checks their results";
}

std::vector<WorkerView> Views::absent_quarantined() const {
  std::map<std::string, WorkerView> views;
  const auto& workers = context_.workers.all();
  for (const auto& [process, entry] : context_.quarantine.entries()) {
    const auto is_its_worker = [&name = entry.name](const auto& w) {
      return w.second.quarantined && (w.second.reported_name == name || w.second.name == name);
    };
    const bool shown = std::any_of(workers.begin(), workers.end(), is_its_worker);
    if (!entry.lifted && !entry.name.empty() && !shown) {
      WorkerView& view = views[entry.name];
      view.name = entry.name;
      view.state = "quarantined";
      view.reason = QuarantineList::describe(entry);
    }
  }
  std::vector<WorkerView> out;
  for (auto& [name, view] : views) {
    out.push_back(std::move(view));
  }
  return out;
}

std::string Views::waiting_reason(const Job& job) const {
  if (job.state != JobState::kRunning || !job.leases.empty()) {
    return job.notice;
  }
  if (!job.any_free() && audits_.block(job)) {
    return audit_reason(job);
  }
  if (barrier_.active()) {
    return absl::StrCat("waits for ", barrier_.missing(),
                        " workers that were there before the coordinator's restart, or before "
                        "all were lost at once");
  }
  if (context_.available.eligible() == 0) {
    const auto& refusals = sessions_.refusals();
    return refusals.empty() ? "no worker is connected"
                            : absl::StrCat("no worker is connected; ", refusals.back().worker.name,
                                           " was refused: ", refusals.back().worker.reason);
  }
  if (!eligibility_.someone_may_render(job)) {
    return nobody_reason(job);
  }
  const std::string busy = job.any_free() ? busy_with_others(job) : "";
  return busy.empty() ? job.notice : busy;
}

/// Returns why no connected worker may render the job.
std::string Views::nobody_reason(const Job& job) const {
  const Worker* largest = nullptr;
  bool any_browser = false;
  for (const auto& [id, worker] : context_.workers.all()) {
    any_browser = any_browser || (worker.eligible() && worker.browser);
    if (worker.eligible() && !Eligibility::fits(worker, job) &&
        (largest == nullptr || worker.memory_bytes > largest->memory_bytes)) {
      largest = &worker;
    }
  }
  if (context_.options.browsers == Browsers::kOnly && !any_browser) {
    return "no browser is connected, and the farm renders in browsers only (--browsers only)";
  }
  const std::string notice = job.notice.empty() ? "" : absl::StrCat("; the last: ", job.notice);
  return largest == nullptr
             ? absl::StrCat("no connected worker can render it", notice)
             : absl::StrCat("no connected worker can render it: the largest browser is ",
                            largest->name, ", and ", memory_reason(*largest, job),
                            "; start a native worker", notice);
}

/// Returns the reason why the audits of a job with nothing left to render wait.
std::string Views::audit_reason(const Job& job) const {
  for (const Audit& audit : job.audits) {
    if (audit.doubtful() && audit.lease == 0) {
      const auto append_name = [this](std::string* out, const Audit::Result& result) {
        absl::StrAppend(out, context_.name_of(result.reporter));
      };
      return absl::StrCat(absl::StrJoin(audit.results(), ", ", append_name),
                          " returned different pixels for ", name_of(audit.band()),
                          "; another machine must decide: start a ",
                          audit.only_browsers() ? "" : "native ",
                          "worker on such a machine, or exclude the wrong machine with `bandsaw "
                          "quarantine NAME`");
    }
  }
  return absl::StrCat(job.audits.size(), job.audits.size() == 1 ? " band is" : " bands are",
                      " being rendered a second time, by another machine, to compare");
}

/// Returns for example "all workers are busy with job 5 (priority 10)", or "" if some worker is
/// idle.
std::string Views::busy_with_others(const Job& job) const {
  std::set<JobTable::Rank> jobs;
  for (const auto& [id, worker] : context_.workers.all()) {
    if (!worker.eligible()) {
      continue;
    }
    if (worker.leases.empty()) {
      return "";
    }
    for (const LeaseId lease : worker.leases) {
      JobTable::Rank rank = JobTable::rank(context_.jobs.at(context_.leases.find(lease)->job));
      rank.job = rank.place;  // frames of a sequence are one job for its user
      jobs.insert(rank);
    }
  }
  JobTable::Rank own = JobTable::rank(job);
  own.job = own.place;
  jobs.erase(own);
  if (jobs.empty()) {
    return "";
  }
  const auto append_job = [](std::string* out, const JobTable::Rank& other) {
    absl::StrAppend(out, "job ", other.job, priority_text(-other.descending_priority));
  };
  return absl::StrCat("all workers are busy with ", absl::StrJoin(jobs, ", ", append_job));
}

std::vector<std::string> Views::why(JobId id, Time now) const {
  if (const Sequence* sequence = context_.sequences.find(id)) {
    return why_of_sequence(*sequence, now);
  }
  const Job* job = context_.jobs.find(id);
  if (job == nullptr) {
    return {};
  }
  std::vector<std::string> lines = why_of_state(*job, now);
  if (!job->damage.empty()) {
    lines.push_back(job->damage);
  }
  return lines;
}

/// Returns the sequence's reason, if any, then the sentences about all its frames, then the
/// sentences about the first frame that is being rendered. If the sequence is done or cancelled,
/// returns one sentence that says so.
std::vector<std::string> Views::why_of_sequence(const Sequence& sequence, Time now) const {
  if (sequence.state == JobState::kDone || sequence.state == JobState::kCancelled) {
    return {sequence.state == JobState::kDone ? "it is done" : "it was cancelled"};
  }
  std::vector<std::string> lines;
  if (!sequence.reason.empty()) {
    lines.push_back(sequence.reason);
  }
  for (std::string& line : frame_sentences(sequence)) {
    lines.push_back(std::move(line));
  }
  if (!sequence.open_jobs().empty()) {
    const Job& first = context_.jobs.at(*sequence.open_jobs().begin());
    for (const std::string& line : why_of_state(first, now)) {
      lines.push_back(absl::StrCat("frame ", first.spec.frame, ": ", line));
    }
  }
  return lines;
}

/// Returns sentences about the job's state. For a running job, they say who works on it, what it
/// waits for, how long it still needs, and why other workers do not work on it.
std::vector<std::string> Views::why_of_state(const Job& job, Time now) const {
  const auto with_reason = [&](const char* what) {
    return absl::StrCat(what, job.reason.empty() ? "" : ": ", job.reason);
  };
  switch (job.state) {
    case JobState::kDone:
      return {"it is done"};
    case JobState::kFailed:
      return failed_because(job, with_reason("it failed"));
    case JobState::kCancelled:
      return {"it was cancelled"};
    case JobState::kFinishing:
      return {"every pixel is there; the result is being written"};
    case JobState::kPaused:
      return {with_reason("it is paused")};
    case JobState::kRunning:
      break;
  }
  std::vector<std::string> lines = working_on(job);
  if (const std::string reason = waiting_reason(job); !reason.empty()) {
    lines.push_back(reason);
  }
  if (!job.any_free() && audits_.block(job)) {
    lines.push_back(audit_reason(job));
  } else if (job.leases.empty() && !job.any_free()) {
    lines.push_back("all that is planned is rendered; how much more is needed is being measured");
  }
  if (lines.empty()) {
    lines.push_back("it is about to be given to workers");
  }
  if (const double left = remaining_s(context_, job, now); left >= 0 && !job.leases.empty()) {
    lines.push_back(
        absl::StrCat("it needs about ", static_cast<std::uint64_t>(left + 0.5), " s more"));
  }
  const std::vector<std::string> not_working = not_working_on(job);
  lines.insert(lines.end(), not_working.begin(), not_working.end());
  return lines;
}

std::vector<std::string> Views::working_on(const Job& job) const {
  std::vector<std::string> out;
  const std::vector<JobWorkerView> workers = workers_on(context_, job);
  for (const JobWorkerView& worker : workers) {
    if (out.size() == kMaxLines) {
      out.push_back(absl::StrCat("and ", workers.size() - kMaxLines, " more workers"));
      break;
    }
    out.push_back(absl::StrCat(worker.name, " works on it: ", worker.state, ", rows ",
                               worker.rows.first, "–", worker.rows.last));
  }
  return out;
}

std::vector<std::string> Views::not_working_on(const Job& job) const {
  std::vector<std::string> out;
  for (const auto& [id, worker] : context_.workers.all()) {
    if (worker.quarantined || (worker.session && worker.draining)) {
      out.push_back(absl::StrCat(
          worker.name, worker.quarantined ? " gets no work: " : " is leaving: ", worker.reason));
    } else if (worker.eligible() && !eligibility_.may_render(worker, job)) {
      out.push_back(absl::StrCat(worker.name, " gets no bands of it: ", refusal(worker, job)));
    } else if (worker.eligible() && !worker.leases.empty()) {
      const Job& other = context_.jobs.at(context_.leases.find(worker.leases.front())->job);
      if (other.id != job.id) {
        out.push_back(absl::StrCat(worker.name, " is busy with job ", other.id,
                                   priority_text(other.priority)));
      }
    }
  }
  for (const Refusal& refusal : sessions_.refusals()) {
    out.push_back(absl::StrCat(refusal.worker.name, " was refused: ", refusal.worker.reason));
  }
  if (out.size() > kMaxLines) {
    const std::size_t more = out.size() - kMaxLines;
    out.resize(kMaxLines);
    out.push_back(absl::StrCat("and ", more, " more workers that do not render it"));
  }
  return out;
}

}  // namespace bandsaw::coordinator
