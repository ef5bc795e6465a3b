// Workers that go while they render a band: by chance, or because of it.

#include <algorithm>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "coordinator/core/band_text.h"
#include "coordinator/core/state.h"

namespace bandsaw::coordinator {
namespace {

/// A suspect band is rendered again in so many pieces: the longest, those that were cut before a
/// pace was known, take seconds, and workers that go for other reasons go while at them.
constexpr std::uint32_t kPieces = 8;

}  // namespace

/// What the worker is rendering, if it went now without a word of leaving. A copy does not count:
/// the original's worker is at the same rows, and a net that fails would take both at once. Nor
/// does an audit: somebody has rendered those rows. Nor what it was given when it had fallen silent
/// already: it never began that.
std::optional<Core::State::Losing> Core::State::in_hand(const Worker& worker) const {
  if (worker.draining || worker.quarantined || worker.leases.empty()) {
    return std::nullopt;
  }
  const Lease& lease = *leases_.find(worker.leases.front());
  const bool silent_before = worker.heard_at < lease.advanced_at && is_silent(worker);
  return lease.copy_of != 0 || lease.audit || silent_before
             ? std::nullopt
             : std::optional(Losing{lease.job, lease.band});
}

void Core::State::add_loss(const Worker& worker, const Losing& lost) {
  Job* job = find(lost.job);
  if (job == nullptr || is_final(job->state)) {
    return;
  }
  const std::uint32_t count = lost.band.rows.count();
  const std::uint32_t again = is_suspect(*job, lost.band) ? count : (count + kPieces - 1) / kPieces;
  job->losses.push_back({lost.band, again, worker.instance});
  if (job->losses.size() > Job::kFaultsKept) {
    job->losses.pop_front();
  }
  std::set<std::string> instances;
  for (const Loss& loss : job->losses) {
    if (meet(loss.band, lost.band)) {
      instances.insert(loss.instance);
    }
  }
  if (instances.size() < 2) {
    return;
  }
  const std::string names =
      absl::StrJoin(instances, ", ", [this](std::string* out, const std::string& instance) {
        absl::StrAppend(out, name_of_instance(instance));
      });
  const std::string reason =
      absl::StrCat(instances.size(), " workers were lost while they rendered ", name_of(lost.band),
                   " (", names, "); the last: ", worker.reason);
  job->notice = reason;
  if (instances.size() >= options_.losses_per_band) {
    end(*job, JobState::kFailed,
        absl::StrCat(
            reason,
            "; it seems to end every worker that renders it: by the memory that "
            "it needs, or by a fault of the renderer; what the last one said: bandsaw logs ",
            worker.name));
  }
}

/// Whether it may have ended a worker. Such a band is rendered by a worker that has nothing else in
/// hand: should that one go as well, it is known by what. A band that is finished but not stored
/// would be blamed for the one behind it.
bool Core::State::is_suspect(const Job& job, const Band& band) {
  return std::any_of(job.losses.begin(), job.losses.end(),
                     [&](const Loss& loss) { return meet(loss.band, band); });
}

/// Of what is free, from its first row on, instead of `band`, which is cut by times alone: rows
/// that are not suspect, or one piece of a band that is, whole. The third who is lost must have
/// been at the very piece that the second was at, and not just at another of a long band.
Band Core::State::narrowed(const Job& job, const Band& free, Band band) {
  if (band.samples != free.samples) {
    return band;  // part of a row
  }
  const std::uint32_t first = band.rows.first;
  std::uint32_t next = free.rows.last;  // where the next suspect band begins
  std::optional<std::uint32_t> piece;
  for (const Loss& loss : job.losses) {
    const RowRange& rows = loss.band.rows;
    if (!meet(loss.band, free)) {
      continue;
    }
    if (rows.first > first) {
      next = std::min(next, rows.first);
    } else {
      piece = std::min({piece.value_or(free.rows.last), rows.last, first + loss.rows});
    }
  }
  band.rows.last = std::min(piece.value_or(band.rows.last), next);
  return band;
}

bool Core::State::has_suspect(const Worker& worker) const {
  return std::any_of(worker.leases.begin(), worker.leases.end(), [&](LeaseId id) {
    const Lease& lease = *leases_.find(id);
    return is_suspect(jobs_.at(lease.job), lease.band);
  });
}

/// A worker that comes back had lost its connection, not its life.
void Core::State::forgive_losses(const Worker& worker) {
  for (const JobId id : active_) {
    std::erase_if(jobs_.at(id).losses,
                  [&](const Loss& loss) { return loss.instance == worker.instance; });
  }
}

/// Rows that somebody has rendered did not end those who tried before. What is stored at an end of
/// a loss's rows narrows it down; rows within leave it as it is.
void Core::State::shrink_losses(Job& job, const Band& stored) {
  for (Loss& loss : job.losses) {
    RowRange& rows = loss.band.rows;
    if (!meet(loss.band, stored)) {
      continue;
    }
    if (stored.rows.first <= rows.first) {
      rows.first = std::min(rows.last, stored.rows.last);
    } else if (stored.rows.last >= rows.last) {
      rows.last = stored.rows.first;
    }
  }
  std::erase_if(job.losses, [](const Loss& loss) { return loss.band.rows.count() == 0; });
}

}  // namespace bandsaw::coordinator
