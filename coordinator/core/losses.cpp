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

/// What the worker may be rendering, if it is lost now without a word of leaving: its first lease,
/// and the second, since the first may be finished and not stored yet. Without copies: the
/// original's worker is at the same rows, and a net that fails would take both at once. Without
/// audits: somebody has rendered those rows. Without what it was given when it had fallen silent
/// already: it never began that.
std::vector<Losing> Core::State::in_hand(const Worker& worker) const {
  std::vector<Losing> lost;
  if (worker.draining || worker.quarantined) {
    return lost;
  }
  const bool alone = worker.leases.size() == 1 && worker.dropping.empty();
  const std::size_t begun = std::min<std::size_t>(worker.leases.size(), 2);
  for (std::size_t i = 0; i < begun; ++i) {
    const Lease& lease = *leases_.find(worker.leases[i]);
    const bool silent_before = worker.heard_at < lease.advanced_at && is_silent(worker);
    if (lease.copy_of == 0 && !lease.audit && !silent_before) {
      lost.push_back({lease.job, lease.band, alone});
    }
  }
  return lost;
}

void Core::State::add_losses(const Worker& worker, const std::vector<Losing>& lost) {
  const auto is_test = [this](const Losing& one) {
    return one.alone && is_suspect(jobs_.at(one.job), one.band);
  };
  if (!lost.empty() && std::none_of(lost.begin(), lost.end(), is_test)) {
    loss_rate_.add_loss();
  }
  for (const Losing& one : lost) {
    if (Job& job = jobs_.at(one.job); !is_final(job.state)) {
      add_loss(job, worker, one);
    }
  }
}

void Core::State::add_loss(Job& job, const Worker& worker, const Losing& lost) {
  const bool suspect = is_suspect(job, lost.band);
  const std::uint32_t count = lost.band.rows.count();
  const std::uint32_t again = suspect ? count : (count + kPieces - 1) / kPieces;
  job.losses.push_back(
      {lost.band, again, worker.instance, worker.said, /*witness=*/suspect && lost.alone});
  if (job.losses.size() > Job::kFaultsKept) {
    job.losses.pop_front();
  }
  weigh_losses(job, worker, lost.band);
}

/// Fails the job when so many workers were lost at the band, for no other reason that can be, that
/// it is not by chance. Machines are counted, and processes of one machine only where there is no
/// other machine left to ask.
void Core::State::weigh_losses(Job& job, const Worker& worker, const Band& band) {
  std::set<std::string> names;
  std::set<std::string> instances;
  std::set<std::string> machines;
  std::size_t others = 0;
  for (const Loss& loss : job.losses) {
    if (!meet(loss.band, band)) {
      continue;
    }
    names.insert(name_of_instance(loss.instance));
    if (loss.witness) {
      instances.insert(loss.instance);
      machines.insert(loss.machine);
    } else {
      ++others;
    }
  }
  if (names.size() < 2) {
    return;
  }
  const std::string reason =
      absl::StrCat(names.size(), " workers were lost while they rendered ", name_of(band), " (",
                   absl::StrJoin(names, ", "), "); the last: ", worker.reason);
  job.notice = reason;
  const std::size_t witnesses = another_machine(job, band) ? machines.size() : instances.size();
  if (witnesses >= loss_rate_.witnesses(options_.losses_per_band, others)) {
    end(job, JobState::kFailed,
        absl::StrCat(
            reason,
            "; it seems to end every worker that renders it: by the memory that "
            "it needs, or by a fault of the renderer; what the last one said: bandsaw logs ",
            worker.name));
  }
}

/// Whether it may have ended a worker. Such a band is rendered by a worker that has nothing else in
/// hand: should that one be lost as well, it is known at what. A band that is finished but not
/// stored would be blamed for the one behind it.
bool Core::State::is_suspect(const Job& job, const Band& band) {
  return std::any_of(job.losses.begin(), job.losses.end(),
                     [&](const Loss& loss) { return meet(loss.band, band); });
}

/// Whether a worker was lost at the band that had nothing else in hand.
bool Core::State::has_witness(const Job& job, const Band& band) {
  return std::any_of(job.losses.begin(), job.losses.end(),
                     [&](const Loss& loss) { return loss.witness && meet(loss.band, band); });
}

/// Whether a machine may render the band that was not lost at it and did not fail it.
bool Core::State::another_machine(const Job& job, const Band& band) const {
  return std::any_of(workers_.all().begin(), workers_.all().end(), [&](const auto& entry) {
    const Worker& worker = entry.second;
    return worker.eligible() && may_render(worker, job) &&
           std::none_of(job.losses.begin(), job.losses.end(),
                        [&](const Loss& loss) {
                          return loss.witness && loss.machine == worker.said &&
                                 meet(loss.band, band);
                        }) &&
           std::none_of(job.faults.begin(), job.faults.end(), [&](const Fault& fault) {
             return fault.instance == worker.instance && meet(fault.band, band);
           });
  });
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
