// A band is a range of rows and samples. When a worker is lost, worker_lost() adds each band that
// the worker may have been rendering to the suspicions of the band's job. A suspect band is
// rendered again in pieces. If a worker that holds only one such piece is lost, this loss is
// conclusive. Enough conclusive losses at a band fail the job.

#include "coordinator/scheduler/liveness/crash_attribution.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <string>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "coordinator/scheduler/model/band_text.h"

namespace bandsaw::coordinator {
namespace {

/// A suspect band is retried in this many pieces. Otherwise the longest bands, those that were cut
/// before a work rate was known, would take seconds, and more workers would be lost at them by
/// chance.
constexpr std::uint32_t kPieces = 8;

}  // namespace

void CrashRate::add(double& count) {
  count += 1;
  if (bands_ + crashes_ > kMaxCount) {
    bands_ /= 2;
    crashes_ /= 2;
  }
}

// `own` is the number of losses at this band that add_crash() counted. They are subtracted, because
// the rate must be that of losses for reasons other than this band.
std::size_t CrashRate::required(std::size_t min_crashes, std::size_t own) const {
  const double crashes = std::max(0.0, crashes_ - static_cast<double>(own)) + kPriorCrashes;
  const double share = crashes / (crashes + bands_ + kPriorBands);
  // The least n with share^n <= kMistake.
  const double needed = std::ceil(std::log(kMistake) / std::log(share));
  return std::clamp(static_cast<std::size_t>(needed), min_crashes,
                    std::max(min_crashes, kMaxRequired));
}

// Returns the bands at which the worker may have been when it was lost: its first lease, and its
// second, since the first may be finished and not stored yet. These do not count:
// - all leases of a worker that said that it leaves: it did not crash;
// - all leases of a browser: it may be closed at any time, and its machine is not known;
// - a backup task: another worker renders the same rows, and a network failure ends both at once;
// - the lease of an audit: another worker has rendered its rows without a crash;
// - a lease that was granted when the worker was silent already: it was never begun.
std::vector<HeldBand> CrashAttribution::held_bands(const Worker& worker) const {
  std::vector<HeldBand> held;
  if (worker.draining || worker.quarantined || worker.browser) {
    return held;
  }
  const bool alone = worker.leases.size() == 1 && worker.revoked.empty();
  const std::size_t begun = std::min<std::size_t>(worker.leases.size(), 2);
  for (std::size_t i = 0; i < begun; ++i) {
    const Lease& lease = *context_.leases.find(worker.leases[i]);
    const bool silent_before = worker.heard_at < lease.advanced_at && context_.is_silent(worker);
    if (lease.backup_of == 0 && !lease.audit && !silent_before) {
      held.push_back({lease.job, lease.band, alone});
    }
  }
  return held;
}

void CrashAttribution::worker_lost(const Worker& worker, const std::vector<HeldBand>& held) {
  const auto is_retry = [this](const HeldBand& one) {
    return one.alone && context_.jobs.at(one.job).is_suspect(one.band);
  };
  // A loss at a suspect band says nothing about how often workers are lost by chance.
  if (!held.empty() && std::none_of(held.begin(), held.end(), is_retry)) {
    rate_.add_crash();
  }
  for (const HeldBand& one : held) {
    if (Job& job = context_.jobs.at(one.job); !is_final(job.state)) {
      add_suspicion(job, worker, one);
    }
  }
}

/// Makes the band suspect, and fails the job if enough workers were lost at the band. A band that
/// is suspect for the first time is retried in pieces.
void CrashAttribution::add_suspicion(Job& job, const Worker& worker, const HeldBand& held) {
  const bool suspect = job.is_suspect(held.band);
  const std::uint32_t rows = held.band.rows.count();
  const std::uint32_t piece_rows = suspect ? rows : (rows + kPieces - 1) / kPieces;
  job.suspicions.push_back({.band = held.band,
                            .piece_rows = piece_rows,
                            .instance = worker.instance,
                            .machine = worker.machine(),
                            .conclusive = suspect && held.alone});
  if (job.suspicions.size() > Job::kMaxFailures) {
    job.suspicions.pop_front();
  }
  fail_if_blamed(job, worker, held.band);
}

/// Fails the job if more machines were lost at the band than chance explains. Processes of one
/// machine are counted separately only if no other machine is left to render the band.
void CrashAttribution::fail_if_blamed(Job& job, const Worker& worker, const Band& band) {
  std::set<std::string> names;
  std::set<std::string> instances;  // workers of conclusive crashes
  std::set<std::string> machines;   // their machines
  std::size_t inconclusive = 0;
  for (const Suspicion& one : job.suspicions) {
    if (!overlap(one.band, band)) {
      continue;
    }
    names.insert(context_.workers.name_of(one.instance));
    if (one.conclusive) {
      instances.insert(one.instance);
      machines.insert(one.machine);
    } else {
      ++inconclusive;
    }
  }
  if (names.size() < 2) {
    return;  // a band is never blamed for the losses of a single worker
  }
  const std::string reason =
      absl::StrCat(names.size(), " workers were lost while they rendered ", name_of(band), " (",
                   absl::StrJoin(names, ", "), "); the last: ", worker.reason);
  job.notice = reason;
  const std::size_t crashes =
      eligibility_.another_machine(job, band) ? machines.size() : instances.size();
  if (crashes >= rate_.required(context_.options.min_crashes_per_band, inconclusive)) {
    lifecycle_.end(
        job, JobState::kFailed,
        absl::StrCat(
            reason,
            "; it seems to end every worker that renders it, because it needs too much memory or "
            "because the renderer has a fault; the last worker's log is shown by `bandsaw logs ",
            worker.name, "`"));
  }
}

void CrashAttribution::worker_connected(const Worker& worker) {
  for (const JobId id : context_.jobs.active()) {
    std::erase_if(context_.jobs.at(id).suspicions,
                  [&](const Suspicion& one) { return one.instance == worker.instance; });
  }
}

}  // namespace bandsaw::coordinator
