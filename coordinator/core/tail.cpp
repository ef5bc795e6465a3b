// The end of a job: nothing is free any more, and workers are idle while others are late. A band
// that its worker has not begun is taken from it; one that is being rendered is given to idle
// workers as well, in parts where that is sooner, and whoever is first ends the others.

#include <algorithm>

#include "coordinator/core/state.h"

namespace bandsaw::coordinator {
namespace {

/// What handing over costs beside rendering.
constexpr double kTrip_s = 0.03;
/// Copies must be expected in less than this part of the time that the original still takes; as
/// many idle workers are put to it as are needed for the smaller part.
constexpr double kSoonEnough = 0.75;
constexpr double kSoon = 0.5;
/// How long after a look that found nothing to share the next one comes, for each lease: what keeps
/// a large farm's coordinator free for its results.
constexpr double kLookPerLease_s = 2e-5;
/// Of a band that takes longer than expected.
constexpr double kLeastRest = 0.25;

RowRange meet(const RowRange& a, const RowRange& b) {
  return {std::max(a.first, b.first), std::min(a.last, b.last)};
}

}  // namespace

/// A lease, and when it is expected to be done.
struct Core::State::Late {
  LeaseId lease = 0;
  double begins_in_s = 0;
  double done_in_s = 0;
  bool untouched = true;  ///< no copy, and no copy of it
};

/// Whether an idle worker has got something: so it ends, since there are ever fewer of them.
bool Core::State::share_the_tail() {
  std::vector<Worker*> idle = idle_workers();
  if (idle.empty() || leases_.all().empty()) {
    return false;
  }
  if (clock_.wall() < tail_again_at_) {
    return false;
  }
  bool any = false;
  for (const Late& late : late_leases()) {
    if (idle.empty() || late.done_in_s < 2 * kTrip_s) {
      break;
    }
    const Lease* lease = leases_.find(late.lease);
    if (lease == nullptr) {
      continue;  // a copy of one that was moved
    }
    const Job& job = jobs_.at(lease->job);
    const bool queued = late.untouched && late.begins_in_s > kTrip_s;
    any = (lease->audit ? move_audit(late, idle)
           : queued     ? steal(late, idle)
                        : copy(late, idle)) ||
          any;
    if (any && job.any_free()) {
      return true;
    }
  }
  if (!any) {
    tail_again_at_ = clock_.wall() + kLookPerLease_s * static_cast<double>(leases_.all().size());
  }
  return any;
}

std::vector<Worker*> Core::State::idle_workers() {
  std::vector<Worker*> idle;
  for (auto place = hunger_.first_after(std::nullopt); place && place->first == 0;
       place = hunger_.first_after(place)) {
    idle.push_back(workers_.by_id(place->second));
  }
  return idle;
}

std::vector<Core::State::Late> Core::State::late_leases() const {
  std::vector<Late> late;
  for (const auto& [id, lease] : leases_.all()) {
    const Job& job = jobs_.at(lease.job);
    if (job.state != JobState::kRunning) {
      continue;
    }
    Late one{.lease = id};
    const auto is_its_copy = [this, &id = id](LeaseId copy) {
      return leases_.find(copy)->copy_of == id;
    };
    one.untouched =
        lease.copy_of == 0 && std::none_of(job.copies.begin(), job.copies.end(), is_its_copy);
    for (const LeaseId ahead : workers_.by_id(lease.worker)->leases) {
      if (ahead == id) {
        break;
      }
      one.begins_in_s += rest_of(*leases_.find(ahead));
    }
    one.done_in_s = one.begins_in_s + rest_of(lease);
    late.push_back(one);
  }
  std::sort(late.begin(), late.end(), [](const Late& a, const Late& b) {
    return a.done_in_s != b.done_in_s ? a.done_in_s > b.done_in_s : a.lease < b.lease;
  });
  return late;
}

// By the rows that it has told of, else by what its rows cost elsewhere. One that is late already
// is taken to need as much again as it is late: whatever holds it up, what took long will take
// longer.
double Core::State::rest_of(const Lease& lease) const {
  const Job& job = jobs_.at(lease.job);
  const Worker& worker = *workers_.by_id(lease.worker);
  double takes = job.cost_of(lease.band) / pace(worker, job);
  if (worker.leases.front() != lease.id) {
    return takes;
  }
  if (lease.rows_done > 0 && lease.told_at > lease.begun_at) {
    const RowRange done{lease.band.rows.first,
                        lease.band.rows.first + std::min(lease.rows_done, lease.band.rows.count())};
    takes = (lease.told_at - lease.begun_at) * job.cost_of(lease.band) /
            job.cost_of({lease.band.samples, done});
  }
  const double passed = clock_.wall() - lease.begun_at;
  return std::max({takes - passed, passed - takes, takes * kLeastRest});
}

std::vector<Worker*> Core::State::helpers(const Job& job, const Lease& lease,
                                          const std::vector<Worker*>& idle) const {
  std::vector<Worker*> able;
  for (Worker* worker : idle) {
    if (worker->id != lease.worker && may_render(*worker, job) &&
        !left_to_others(job, *worker, lease.band)) {
      able.push_back(worker);
    }
  }
  std::sort(able.begin(), able.end(), [&](const Worker* a, const Worker* b) {
    const double pace_a = pace(*a, job);
    const double pace_b = pace(*b, job);
    return pace_a != pace_b ? pace_a > pace_b : a->id < b->id;
  });
  return able;
}

bool Core::State::steal(const Late& late, std::vector<Worker*>& idle) {
  const Lease lease = *leases_.find(late.lease);
  Job& job = jobs_.at(lease.job);
  const std::vector<Worker*> able = helpers(job, lease, idle);
  if (able.empty()) {
    return false;
  }
  Worker& thief = *able.front();
  const Band least = sized(job, thief, lease.band);
  if (job.cost_of(least) / pace(thief, job) + kTrip_s >= late.done_in_s) {
    return false;
  }
  const Worker& from = *workers_.by_id(lease.worker);
  act(action::Revoke{*from.session, {lease.id}});
  workers_.by_id(lease.worker)->dropping.insert(lease.id);
  act(action::Shared{job.id, lease.band, from.name, thief.name, false});
  end_lease(lease.id, Revoke::kNo);
  std::erase(idle, &thief);
  const auto free = free_for(job, thief);
  if (!free) {
    return false;
  }
  const Band band = narrowed(job, *free, sized(job, thief, *free));
  grant(thief, job, *job.pass_of(band), band, leases_.new_id());
  return true;
}

/// An audit has no owner: if idle workers are much sooner together they take it, begun or not, and
/// each machine once, so that it does not wander.
bool Core::State::move_audit(const Late& late, std::vector<Worker*>& idle) {
  const Lease lease = *leases_.find(late.lease);
  Job& job = jobs_.at(lease.job);
  Audit& audit = *audit_of(lease);
  std::vector<Worker*> able = helpers(job, lease, idle);
  std::erase_if(able, [&](const Worker* worker) {
    return audit.given.contains(worker->said) || !may_audit(*worker, job, audit);
  });
  double together = 0;
  for (const Worker* worker : able) {
    together += pace(*worker, job);
  }
  if (job.cost_of(lease.band) >= (late.done_in_s * kSoonEnough - kTrip_s) * together) {
    return false;
  }
  Worker& first = *able.front();  // the others are given what it leaves
  act(action::Shared{job.id, lease.band, workers_.by_id(lease.worker)->name, first.name, false});
  end_lease(lease.id, Revoke::kYes);
  grant_audit(first, job, audit);
  std::erase(idle, &first);
  return true;
}

bool Core::State::copy(const Late& late, std::vector<Worker*>& idle) {
  const Lease lease = *leases_.find(late.lease);
  Job& job = jobs_.at(lease.job);
  if (has_witness(job, lease.band)) {
    return false;  // one worker at a time
  }
  RowRange rows = not_copied(job, lease);
  std::vector<Worker*> able = helpers(job, lease, idle);
  able.resize(std::min<std::size_t>(able.size(), rows.count()));
  const double all = job.cost_of({lease.band.samples, rows});
  double together = 0;
  std::size_t count = 0;
  while (count < able.size() && all > (late.done_in_s * kSoon - kTrip_s) * together) {
    together += pace(*able[count++], job);
  }
  if (count == 0 || all > (late.done_in_s * kSoonEnough - kTrip_s) * together) {
    return false;
  }
  Pass& pass = *job.pass_of(lease.band);
  const double column = static_cast<double>(lease.band.samples.samples()) * job.spec.settings.width;
  const LeaseId original = lease.copy_of == 0 ? lease.id : lease.copy_of;
  for (std::size_t i = 0; i < count && rows.count() > 0; ++i) {
    Worker& helper = *able[i];
    const double part = all * pace(helper, job) / together;
    Band band{lease.band.samples, rows};
    if (i + 1 < count) {
      band.rows.last = rows.first + job.cost.fitting(rows, part / column, pass.shares);
    }
    rows.first = band.rows.last;
    act(action::Shared{job.id, band, workers_.by_id(lease.worker)->name, helper.name, true});
    const LeaseId id = leases_.new_id();
    job.copies.insert(id);
    ++job.bands_copied;
    hand_over(helper, job, pass,
              {.id = id, .job = job.id, .worker = helper.id, .band = band, .copy_of = original});
    std::erase(idle, &helper);
  }
  return true;
}

/// The first rows of a lease that are wanted and that no copy of it has, or, when it is a copy
/// itself, no later one.
RowRange Core::State::not_copied(const Job& job, const Lease& lease) const {
  for (RowRange rows : job.pass_of(lease.band)->coverage.wanted(lease.band)) {
    bool again = true;
    while (again && rows.first < rows.last) {
      again = false;
      for (const LeaseId id : job.copies) {
        const Lease& copy = *leases_.find(id);
        const RowRange both = meet(copy.band.rows, rows);
        const bool later = lease.copy_of == 0 ? copy.copy_of == lease.id
                                              : copy.copy_of == lease.copy_of && copy.id > lease.id;
        if (!later || both.first >= both.last) {
          continue;
        }
        again = both.first == rows.first;
        (again ? rows.first : rows.last) = again ? both.last : both.first;
        break;
      }
    }
    if (rows.first < rows.last) {
      return rows;
    }
  }
  return {};
}

void Core::State::promote_copies(Job& job, LeaseId ended) {
  const std::set<LeaseId> copies = job.copies;
  for (const LeaseId id : copies) {
    Lease* lease = leases_.find(id);
    if (lease == nullptr || lease->copy_of != ended) {
      continue;
    }
    Pass* pass = job.pass_of(lease->band);
    if (!pass->coverage.adoptable(lease->band)) {
      end_lease(id, Revoke::kYes);
      continue;
    }
    pass->coverage.assign(lease->band, id);
    lease->copy_of = 0;
    job.copies.erase(id);
    touch(job);
  }
}

void Core::State::end_useless_copies(Job& job) {
  const std::set<LeaseId> copies = job.copies;
  for (const LeaseId id : copies) {
    const Lease* lease = leases_.find(id);
    if (lease != nullptr && job.pass_of(lease->band)->coverage.wanted(lease->band).empty()) {
      end_lease(id, Revoke::kYes);
    }
  }
}

}  // namespace bandsaw::coordinator
