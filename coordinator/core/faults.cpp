// What goes wrong: bands that cannot be rendered, workers that are silent, stuck, or wrong.

#include <algorithm>
#include <cmath>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "coordinator/core/band_text.h"
#include "coordinator/core/state.h"
#include "proto/wire/limits.h"
#include "renderlib/base/clean_text.h"

namespace bandsaw::coordinator {
namespace {

/// Faults after which a worker is not given that job again, and after which a band is given up.
constexpr std::uint32_t kFaultsPerWorker = 3;
constexpr std::size_t kFaultsPerBand = 3;
/// So many times as long a band that is rendered may take: it is sent, maybe by a slow line.
constexpr double kForSending = 20;

}  // namespace

std::string Core::State::name_of_instance(const std::string& instance) const {
  const Worker* known = workers_.by_instance(instance);
  return known == nullptr ? instance : known->name;
}

bool Core::State::may_render(const Worker& worker, const Job& job) const {
  const auto on_job = worker.on_job.find(job.id);
  return on_job == worker.on_job.end() || on_job->second.faults < kFaultsPerWorker;
}

bool Core::State::someone_else(const Job& job, const Band& band) const {
  return std::any_of(workers_.all().begin(), workers_.all().end(), [&](const auto& entry) {
    const Worker& worker = entry.second;
    return worker.eligible() && may_render(worker, job) &&
           std::none_of(job.faults.begin(), job.faults.end(), [&](const Fault& fault) {
             return fault.instance == worker.instance && meet(fault.band, band);
           });
  });
}

std::vector<Band> Core::State::left_to_others(const Job& job, const Worker& worker) const {
  std::vector<Band> avoid;
  for (const Fault& fault : job.faults) {
    if (fault.instance == worker.instance && someone_else(job, fault.band)) {
      avoid.push_back(fault.band);
    }
  }
  for (const Loss& loss : job.losses) {
    if (loss.witness && loss.machine == worker.said && another_machine(job, loss.band)) {
      avoid.push_back(loss.band);
    }
  }
  return avoid;
}

bool Core::State::left_to_others(const Job& job, const Worker& worker, const Band& band) const {
  const std::vector<Band> avoid = left_to_others(job, worker);
  return std::any_of(avoid.begin(), avoid.end(), [&](const Band& a) { return meet(a, band); });
}

bool Core::State::someone_may_render(const Job& job) const {
  return std::any_of(workers_.all().begin(), workers_.all().end(), [&](const auto& entry) {
    return entry.second.eligible() && may_render(entry.second, job);
  });
}

void Core::State::add_fault(Job& job, Worker& worker, const Band& band, const std::string& reason) {
  ++worker.on_job[job.id].faults;
  job.faults.push_back({band, worker.instance, clean_text(reason, wire::kReasonBytes)});
  if (job.faults.size() > Job::kFaultsKept) {
    job.faults.pop_front();
  }
  std::set<std::string> names;
  std::size_t count = 0;
  for (const Fault& fault : job.faults) {
    if (meet(fault.band, band)) {
      names.insert(name_of_instance(fault.instance));
      ++count;
    }
  }
  act(action::Faulted{job.id, band, worker.name, reason});
  job.notice = absl::StrCat(worker.name, " could not render ", name_of(band), ": ", reason);
  if (names.size() >= kFaultsPerBand || (count >= kFaultsPerBand && !someone_else(job, band))) {
    end(job, JobState::kFailed,
        absl::StrCat(name_of(band), " failed ", count, " times, on ", absl::StrJoin(names, ", "),
                     ": ", reason));
  }
}

/// One that reconnects is as good as there.
void Core::State::check_unable(Job& job) {
  const bool unable = job.state == JobState::kRunning && job.leases.empty() && job.any_free() &&
                      !waits_for_former() && !someone_may_render(job);
  if (!unable) {
    job.unable_since.reset();
    return;
  }
  if (hunger_.eligible() == 0) {
    return;  // Nobody is there: neither a reason to give up nor a sign of hope.
  }
  job.unable_since = job.unable_since.value_or(clock_.patience());
  if (clock_.patience() - *job.unable_since >=
      options_.heartbeat_timeout_s + options_.reattach_grace_s) {
    end(job, JobState::kFailed,
        absl::StrCat("each worker that is connected failed ", kFaultsPerWorker,
                     " of its bands, with none rendered between; the last: ", job.notice));
  }
}

void Core::State::check_silence() {
  std::vector<WorkerId> silent;
  for (const auto& [id, worker] : workers_.all()) {
    if (worker.session && clock_.patience() - worker.heard_at > options_.heartbeat_timeout_s) {
      silent.push_back(id);
    }
  }
  for (const WorkerId id : silent) {
    Worker& worker = *workers_.by_id(id);
    const std::string reason =
        absl::StrCat("not heard of for ", options_.heartbeat_timeout_s, " s");
    act(action::Close{*worker.session, reason});
    lose(worker, reason);
  }
}

void Core::State::check_progress() {
  std::vector<LeaseId> stuck;
  const auto is_late = [this](const Lease& lease) {
    const bool rendered = lease.rows_done >= lease.band.rows.count();
    return clock_.patience() - lease.advanced_at >
           options_.progress_timeout_s * (rendered ? kForSending : 1);
  };
  for (const auto& [id, lease] : leases_.all()) {
    if (jobs_.at(lease.job).state == JobState::kRunning && is_late(lease)) {
      stuck.push_back(id);
    }
  }
  for (const LeaseId id : stuck) {
    const Lease* lease = leases_.find(id);
    // One that waited behind a stuck one has its turn now; a job that has failed has no leases.
    if (lease == nullptr || !is_late(*lease)) {
      continue;
    }
    const Band band = lease->band;
    Job& job = jobs_.at(lease->job);
    Worker& worker = *workers_.by_id(lease->worker);
    const std::string reason =
        absl::StrCat("no progress for ", std::lround(clock_.patience() - lease->advanced_at), " s");
    if (lease->audit) {
      give_up_audit(*lease, worker, reason);
      continue;
    }
    end_lease(id, Revoke::kYes);
    add_fault(job, worker, band, reason);
  }
}

}  // namespace bandsaw::coordinator
