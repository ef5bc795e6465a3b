// Who renders what: the job of the highest priority, then the oldest, that has something free, for
// the worker that has least in hand. When nothing is free any more: tail.cpp.

#include <algorithm>

#include "coordinator/core/band_sizing.h"
#include "coordinator/core/probes.h"
#include "coordinator/core/state.h"

namespace bandsaw::coordinator {
namespace {

/// What of `free` begins first and is in none of `avoid`.
std::optional<Band> without(Band free, const std::vector<Band>& avoid) {
  const auto meets = [&](const Band& a) {
    return a.samples.first < free.samples.last && free.samples.first < a.samples.last;
  };
  for (std::size_t i = 0; i < avoid.size(); ++i) {
    const RowRange& rows = avoid[i].rows;
    if (meets(avoid[i]) && rows.first <= free.rows.first && free.rows.first < rows.last) {
      free.rows.first = rows.last;
      i = static_cast<std::size_t>(-1);
    }
  }
  for (const Band& a : avoid) {
    if (meets(a) && a.rows.first > free.rows.first) {
      free.rows.last = std::min(free.rows.last, a.rows.first);
    }
  }
  return free.rows.first < free.rows.last ? std::optional(free) : std::nullopt;
}

}  // namespace

void Core::State::touch(const Job& job) {
  if (job.state == JobState::kRunning) {
    leasable_.insert(rank(job));
  }
}

void Core::State::lease_out() {
  if (waits_for_former()) {
    return;
  }
  hand_out();
  while (share_the_tail()) {
    hand_out();
  }
}

void Core::State::hand_out() {
  for (auto place = hunger_.first_after(std::nullopt); place && !leasable_.empty();
       place = hunger_.first_after(place)) {
    lease_to(*workers_.by_id(place->second));
  }
}

bool Core::State::lease_to(Worker& worker) {
  if (has_suspect(worker)) {
    return false;
  }
  for (auto it = leasable_.begin(); it != leasable_.end();) {
    Job& job = jobs_.at(it->second);
    if (!job.any_free() && !plan_timed(job) && !job.audit_waits()) {
      it = leasable_.erase(it);
      continue;
    }
    if (may_render(worker, job)) {
      if (Audit* audit = audit_for(worker, job)) {
        grant_audit(worker, job, *audit);
        return true;
      }
      const auto first = probe_for(job, worker);
      if (const auto free = first ? first : free_for(job, worker)) {
        const Band band = narrowed(job, *free, sized(job, worker, *free));
        if (is_suspect(job, band) && !(worker.leases.empty() && worker.dropping.empty())) {
          return false;  // The first who has nothing else in hand takes it.
        }
        grant(worker, job, *job.pass_of(band), band, leases_.new_id());
        return true;
      }
    }
    ++it;
  }
  return false;
}

std::optional<Band> Core::State::free_for(const Job& job, const Worker& worker) const {
  const std::vector<Band> avoid = left_to_others(job, worker);
  for (const Pass& pass : job.passes) {
    for (auto free = pass.coverage.free_from(0); free;
         free = pass.coverage.free_from(free->rows.last)) {
      if (const auto piece = without(*free, avoid)) {
        return piece;
      }
    }
  }
  return std::nullopt;
}

std::optional<Band> Core::State::probe_for(Job& job, const Worker& worker) const {
  const std::uint32_t height = job.spec.settings.height;
  while (job.probes < probes_of(height)) {
    const RowRange rows = probe(height, job.probes++);
    if (auto free = job.passes.front().coverage.free_at(rows.first)) {
      free->rows.last = std::min(free->rows.last, rows.last);
      if (const auto band = without(*free, left_to_others(job, worker))) {
        return band;
      }
    }
  }
  return std::nullopt;
}

double Core::State::per_thread(const Job& job) const {
  return job.per_thread.measured() ? job.per_thread.mean() : kGuessedRate;
}

double Core::State::pace(const Worker& worker, const Job& job) const {
  const auto on_job = worker.on_job.find(job.id);
  return on_job != worker.on_job.end() && on_job->second.pace.measured()
             ? on_job->second.pace.mean()
             : per_thread(job) * worker.threads;
}

Band Core::State::sized(const Job& job, const Worker& worker, const Band& free) const {
  const auto own = worker.on_job.find(job.id);
  Sizing sizing;
  sizing.free = free;
  sizing.width = job.spec.settings.width;
  sizing.cost = &job.cost;
  sizing.shares = job.pass_of(free)->shares;
  sizing.pace = pace(worker, job);
  sizing.measured = own != worker.on_job.end() && own->second.pace.measured();
  const double farm =
      std::max(sizing.pace, per_thread(job) * static_cast<double>(hunger_.threads()));
  sizing.share = sizing.pace / farm;
  sizing.left = std::max(work_left(job, free), job.cost_of(free));
  sizing.target_s = options_.band_target_s;
  return size_band(sizing);
}

// What is free lies below the piece that is cut next, and in later passes: not counted row by row.
double Core::State::work_left(const Job& job, const Band& free) const {
  const std::uint32_t height = job.spec.settings.height;
  const Pass* pass = job.pass_of(free);
  const double here = static_cast<double>(pass->coverage.free_samples()) * job.spec.settings.width;
  const double elsewhere = std::max(0.0, job.free_samples() - here * pass->share());
  return here * job.cost.of({free.rows.first, height}, pass->shares) / (height - free.rows.first) +
         elsewhere * job.cost.of_all() / height;
}

void Core::State::grant(Worker& worker, Job& job, Pass& pass, const Band& band, LeaseId id) {
  const Coverage::Change change = pass.coverage.assign(band, id);
  hand_over(worker, job, pass, {.id = id, .job = job.id, .worker = worker.id, .band = band});
  end_overtaken(change.overtaken);
  end_useless_copies(job);
  touch(job);
}

void Core::State::hand_over(Worker& worker, Job& job, const Pass& pass, Lease lease) {
  lease.begun_at = clock_.wall();
  lease.advanced_at = clock_.patience();
  leases_.add(lease);
  worker.leases.push_back(lease.id);
  job.leases.insert(lease.id);
  hunger_.update(worker);
  if (!job.first_lease_at) {
    job.first_lease_at = clock_.wall();
    job.throughput.start(clock_.wall());
  }
  const auto returned = pass.returned.find({lease.band.samples.first, lease.band.rows.first});
  const std::uint32_t attempt = returned == pass.returned.end() ? 1 : 1 + returned->second;
  act(action::Lease{*worker.session, lease.id, job.id, job.spec.manifest, job.spec.settings,
                    lease.band, pass.tiles_of(lease.band), attempt, lease.audit});
}

void Core::State::end_lease(LeaseId id, Revoke revoke) {
  const Lease lease = *leases_.find(id);
  Job& job = jobs_.at(lease.job);
  Worker& worker = *workers_.by_id(lease.worker);
  if (Pass* pass = job.pass_of(lease.band); pass->coverage.holds(lease.band, id)) {
    pass->coverage.give_back(lease.band, id);
    ++pass->returned[{lease.band.samples.first, lease.band.rows.first}];
    touch(job);
  }
  if (Audit* audit = lease.audit ? audit_of(lease) : nullptr) {
    audit->lease = 0;
    touch(job);
  }
  leases_.erase(id);
  job.leases.erase(id);
  job.copies.erase(id);
  const auto place = std::find(worker.leases.begin(), worker.leases.end(), id);
  const auto index = static_cast<std::size_t>(place - worker.leases.begin());
  worker.leases.erase(place);
  advanced(worker, index);
  if (index == 0 && !worker.leases.empty()) {
    leases_.find(worker.leases.front())->begun_at = clock_.wall();
  }
  hunger_.update(worker);
  if (revoke == Revoke::kYes && worker.session) {
    revoked_[*worker.session].push_back(id);
    worker.dropping.insert(id);
  }
  if (lease.copy_of == 0) {
    promote_copies(job, id);
  }
}

void Core::State::end_overtaken(const std::vector<LeaseId>& leases) {
  for (const LeaseId id : leases) {
    if (const Lease* lease = leases_.find(id)) {
      const Pass* pass = jobs_.at(lease->job).pass_of(lease->band);
      if (!pass->coverage.holds(lease->band, id)) {
        end_lease(id, Revoke::kYes);
      }
    }
  }
}

void Core::State::end_all(const std::vector<LeaseId>& leases, Revoke revoke) {
  for (const LeaseId id : leases) {
    // One may have ended with another, of which it was a copy.
    if (leases_.find(id) != nullptr) {
      end_lease(id, revoke);
    }
  }
}

void Core::State::advanced(const Worker& worker, std::size_t from) {
  for (std::size_t i = from; i < worker.leases.size(); ++i) {
    leases_.find(worker.leases[i])->advanced_at = clock_.patience();
  }
}

}  // namespace bandsaw::coordinator
