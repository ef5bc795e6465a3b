// Carries out the scheduler's actions on a simulated journal, disk and film, each with random
// delays and failures.

#include "sim_coordinator.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "absl/strings/str_cat.h"
#include "farm_driver.h"

namespace bandsaw::coordinator::sim {

void SimCoordinator::fail(const std::string& what) {
  if (!broken) {
    broken = absl::StrCat("at ", agenda_.now(), " s, epoch ", epoch_number_, ": ", what);
  }
}

void SimCoordinator::after(double seconds, std::function<void()> what) {
  agenda_.in(seconds, [this, epoch_number = epoch_number_, what = std::move(what)] {
    if (up() && epoch_number == epoch_number_) {
      what();
    }
  });
}

void SimCoordinator::start() {
  ++epoch_number_;
  SchedulerOptions options = test_options();
  options.epoch = epoch();
  // The timeout is short, so that bands that hang are revoked before the simulated failures end.
  options.progress_timeout_s = 8;
  options.audit_share = audit_share;
  options.browser_audit_share = browser_audit_share;
  options.browsers = browsers;
  scheduler_ = std::make_unique<Scheduler>(options);
  for (const Record& record : journal_) {
    scheduler_->replay(record);
    note(record);
  }
  if (chance_.happens(0.3)) {
    journal_ = scheduler_->snapshot();  // as when a long journal is compacted
  }
  for (auto& [id, disk] : disk_) {
    disk.stored = {};
    for (const input::BandStored& band : disk.bands) {
      const auto rows = scheduler_->wanted(id, band.band);
      // A record on disk has the id of the process that rendered the band, not the instance.
      input::BandStored found = band;
      found.process = worker_process_id(found.instance);
      found.instance.clear();
      scheduler_->replay(found);
      const auto left = scheduler_->wanted(id, band.band);
      if (rows && left && left->empty()) {
        for (const RowRange& range : *rows) {
          disk.stored.add(found, range);
        }
        add_to_film(id, found, *rows);
      }
    }
  }
  take(scheduler_->replayed(agenda_.now() + time_skew));
  tick();
}

void SimCoordinator::on_film(std::function<void()> what) {
  film_at_ = std::max(film_at_, agenda_.now() + chance_.between(0, 0.2));
  after(film_at_ - agenda_.now(), std::move(what));
}

void SimCoordinator::crash() {
  if (tear_steps && !committing_.empty()) {
    const std::vector<Record>& records = committing_.front().step.records;
    const auto kept = static_cast<std::ptrdiff_t>(chance_.pick(0, records.size()));
    journal_.insert(journal_.end(), records.begin(), records.begin() + kept);
  }
  committing_.clear();
  links_.clear();
  films_.clear();
  writing_.clear();
  film_at_ = 0;
  scheduler_.reset();
}

void SimCoordinator::tick() {
  input(input::Tick{});
  after(chance_.between(0.2, 0.9), [this] { tick(); });
}

SessionId SimCoordinator::open(ToWorker link) {
  links_[next_session_] = std::move(link);
  return next_session_++;
}

void SimCoordinator::input(const Input& input) {
  if (!up()) {
    return;
  }
  held_.clear();
  if (const auto* hello = std::get_if<input::Hello>(&input)) {
    for (const auto& held : hello->worker.held) {
      held_.insert(held.lease);
    }
  }
  take(scheduler_->step(input, agenda_.now() + time_skew));
}

void SimCoordinator::take_stored(const input::BandStored& band, std::function<void()> then) {
  held_.clear();
  band_ = band;
  take(scheduler_->step(band, agenda_.now() + time_skew), std::move(then));
  band_.reset();
}

void SimCoordinator::take(Step step, std::function<void()> then) {
  ++steps;
  if (const auto invariant = scheduler_->broken_invariant()) {
    fail(*invariant);
  }
  if (absl::IsInternal(step.status)) {
    fail(step.status.ToString());
  }
  for (const Record& record : step.records) {
    note(record);
  }
  // `stored` follows the scheduler's decisions at once; the film follows them later.
  for (const Action& action : step.actions) {
    if (const auto* lease = std::get_if<action::Lease>(&action)) {
      check_lease(*lease, held_);
    } else if (const auto* add = std::get_if<action::AddToFilm>(&action)) {
      for (const RowRange& rows : add->rows) {
        if (!disk_[add->job].stored.add(*band_, rows)) {
          fail(absl::StrCat("row ", rows.first, " of job ", add->job, " is in the image twice"));
        }
      }
    } else if (const auto* retract = std::get_if<action::Retract>(&action)) {
      disk_[retract->job].stored.retract(retract->process);
    }
  }
  committing_.push_back({std::move(step), {}, band_});
  if (then) {
    committing_.back().then.push_back(std::move(then));
  }
  after(chance_.happens(0.1) ? chance_.between(0, 0.3) : 0.002, [this] { commit(); });
}

void SimCoordinator::check_lease(const action::Lease& lease, const std::set<LeaseId>& held) {
  if (!lease.audit && !held.contains(lease.lease) &&
      disk_[lease.job].stored.any_of(lease.band.samples, lease.band.rows)) {
    fail(absl::StrCat("row ", lease.band.rows.first, " of job ", lease.job,
                      " is leased though it is stored"));
  }
}

void SimCoordinator::commit() {
  if (committing_.empty()) {
    return;
  }
  Committing done = std::move(committing_.front());
  committing_.pop_front();
  journal_.insert(journal_.end(), done.step.records.begin(), done.step.records.end());
  for (const Action& action : done.step.actions) {
    perform(action, done.band);
  }
  for (const auto& then : done.then) {
    then();
  }
}

void SimCoordinator::note(const Record& record) {
  if (const auto* added = std::get_if<record::JobAdded>(&record)) {
    disk_[added->job].spec = added->spec;
  } else if (const auto* wrong = std::get_if<record::WorkerQuarantined>(&record)) {
    quarantined.insert(wrong->name);
  } else if (const auto* pass = std::get_if<record::PassPlanned>(&record)) {
    films_[pass->job].pass_ends.insert(pass->samples.last);
  }
}

void SimCoordinator::perform(const Action& action, const std::optional<input::BandStored>& band) {
  if (const auto* add = std::get_if<action::AddToFilm>(&action)) {
    on_film([this, a = *add, band = *band] { add_to_film(a.job, band, a.rows); });
  } else if (const auto* retract = std::get_if<action::Retract>(&action)) {
    on_film([this, r = *retract] {
      Filming& filming = films_[r.job];
      filming.film.retract(r.process);
      std::erase_if(filming.added, [&](const Added& a) { return a.process == r.process; });
      filming.pass_ends.merge(filming.reported);
      tell_passes(r.job);
    });
  } else if (const auto* write = std::get_if<action::WriteResult>(&action)) {
    writing_.insert(write->job);
    after(chance_.between(0.3, 1), [this, w = *write] { write_result(w); });
  } else if (const auto* drop = std::get_if<action::DropBands>(&action)) {
    disk_[drop->job].bands.clear();
    on_film([this, job = drop->job] { films_.erase(job); });
  } else {
    std::visit(
        [&](const auto& a) {
          if constexpr (requires { a.session; }) {
            if (const auto link = links_.find(a.session); link != links_.end()) {
              link->second(action);
            }
          }
        },
        action);
  }
}

void SimCoordinator::add_to_film(JobId job, const input::BandStored& band,
                                 const std::vector<RowRange>& rows) {
  for (const RowRange& range : rows) {
    if (!films_[job].film.add(band, range)) {
      fail(absl::StrCat("the film of job ", job, " refuses row ", range.first));
    }
    films_[job].added.push_back(
        {band.band,
         {band.band.samples, range},
         band.instance.empty() ? band.process : worker_process_id(band.instance)});
  }
  after(chance_.between(0, 0.1), [this, job] { tell_passes(job); });
}

void SimCoordinator::tell_passes(JobId job) {
  Filming& filming = films_[job];
  const JobSpec& spec = disk_[job].spec;
  while (!filming.pass_ends.empty() &&
         filming.film.least(spec.settings.height) >= *filming.pass_ends.begin()) {
    const std::uint64_t samples = *filming.pass_ends.begin();
    filming.reported.insert(samples);
    filming.pass_ends.erase(filming.pass_ends.begin());
    // A job with an error target decides at checkpoints (numbers of samples) if its error is small
    // enough. The last planned pass ends at a checkpoint. Nothing may be rendered beyond the
    // checkpoint, so that the same job stops at the same sample on every farm.
    const bool at_checkpoint =
        std::holds_alternative<StopAtError>(spec.stop) && filming.pass_ends.empty();
    if (at_checkpoint && filming.film.last_sample() != samples) {
      fail(absl::StrCat("the error of job ", job, " is looked at while its film has more than ",
                        samples, " samples"));
    }
    std::optional<ErrorEstimate> error;
    // The film estimates no error of fewer than 32 samples. The exponent is between those of random
    // and of well stratified samples, 0.5 and 1.
    if (samples >= 32) {
      error = ErrorEstimate{.relative_rmse = 0.3 / std::pow(static_cast<double>(samples), 0.6)};
    }
    input(input::PassMerged{job, samples, error});
  }
}

void SimCoordinator::damage_log() {
  const auto at =
      std::next(disk_.begin(),
                static_cast<std::ptrdiff_t>(disk_.empty() ? 0 : chance_.pick(0, disk_.size() - 1)));
  if (at == disk_.end() || at->second.bands.empty()) {
    return;
  }
  // Damages either the records from number `tail` on, or each one with the probability `share`.
  const double share = chance_.happens(0.2) ? 1 : chance_.between(0, 0.5);
  const std::size_t tail = chance_.happens(0.3) ? chance_.pick(0, at->second.bands.size()) : 0;
  std::vector<Added> records;
  for (std::size_t i = tail; i < at->second.bands.size(); ++i) {
    const input::BandStored& band = at->second.bands[i];
    if (tail > 0 || chance_.happens(share)) {
      records.push_back({band.band, band.band, worker_process_id(band.instance)});
    }
  }
  std::erase_if(at->second.bands, [&](const input::BandStored& band) {
    return std::any_of(records.begin(), records.end(), [&](const Added& record) {
      return record.record == band.band && record.process == worker_process_id(band.instance);
    });
  });
  if (up() && chance_.happens(0.7)) {
    after(chance_.between(0, 3), [this, job = at->first, records] {
      on_film([this, job, records] { find_damage(job, records); });
    });
  }
}

void SimCoordinator::find_damage(JobId job, const std::vector<Added>& records) {
  const auto filming = films_.find(job);
  if (filming == films_.end()) {
    return;
  }
  input::BandsDamaged damaged{.job = job, .bands = {}};
  std::erase_if(filming->second.added, [&](const Added& added) {
    const bool lost = std::any_of(records.begin(), records.end(), [&](const Added& record) {
      return record.record == added.record && record.process == added.process;
    });
    if (lost) {
      filming->second.film.lose(added.band, added.process);
      damaged.bands.push_back({added.band, added.process});
    }
    return lost;
  });
  if (!damaged.bands.empty()) {
    writing_.erase(job);
    filming->second.pass_ends.merge(filming->second.reported);
    after(chance_.between(0, 0.1), [this, damaged] { take_damaged(damaged); });
    ++damages;
  }
}

void SimCoordinator::take_damaged(const input::BandsDamaged& damaged) {
  writing_.erase(damaged.job);
  held_.clear();
  Step step = scheduler_->step(damaged, agenda_.now() + time_skew);
  for (const Record& record : step.records) {
    if (const auto* lost = std::get_if<record::BandLost>(&record)) {
      disk_[lost->job].stored.lose(lost->band, lost->process);
    }
  }
  take(std::move(step));
}

void SimCoordinator::write_result(const action::WriteResult& write) {
  if (!writing_.contains(write.job)) {
    return;
  }
  if (films_[write.job].film.least(disk_[write.job].spec.settings.height) < write.samples) {
    after(0.1, [this, write] { write_result(write); });
    return;
  }
  if (agenda_.now() < disk_full_until_) {
    input(input::StorageFailed{write.job, "the disk is full"});
    return;
  }
  const OnDisk& disk = disk_[write.job];
  if (disk.stored.least(disk.spec.settings.height) < write.samples) {
    fail(absl::StrCat("the image of job ", write.job, " has a hole"));
  }
  if (const auto row = disk.stored.wrong_row(write.samples, honest_digest); row && must_be_right) {
    fail(absl::StrCat("row ", *row, " of the image of job ", write.job, " is wrong"));
  }
  writing_.erase(write.job);
  results[write.job] = write.samples;
  input(input::ResultWritten{write.job});
}

void SimCoordinator::put_band(const input::BandStored& band,
                              std::function<void(PutOutcome)> reply) {
  const auto wanted = scheduler_->wanted(band.job, band.band);
  if (!wanted) {
    reply(PutOutcome::kUnwanted);
  } else if (wanted->empty()) {
    input::BandStored compared = band;
    compared.written = false;
    take_stored(compared, [reply = std::move(reply)] { reply(PutOutcome::kDuplicate); });
  } else if (agenda_.now() < disk_full_until_) {
    input(input::StorageFailed{band.job, "the disk is full"});
    reply(PutOutcome::kTryAgain);
  } else {
    after(chance_.between(0.001, 0.05), [this, band, reply = std::move(reply)]() mutable {
      write_band(std::move(band), std::move(reply));
    });
  }
}

void SimCoordinator::write_band(input::BandStored band, std::function<void(PutOutcome)> reply) {
  disk_[band.job].bands.push_back(band);
  after(chance_.between(0, 0.05), [this, band, reply = std::move(reply)] {
    take_stored(band, [reply] { reply(PutOutcome::kStored); });
  });
}

void SimCoordinator::fill_disk(double seconds) {
  disk_full_until_ = agenda_.now() + seconds;
  agenda_.in(seconds + 0.01, [this] {
    if (agenda_.now() >= disk_full_until_) {
      input(input::StorageBack{});
    }
  });
}

bool SimCoordinator::all_final() const {
  if (scheduler_ == nullptr) {
    return false;
  }
  for (const JobView& job : scheduler_->jobs(agenda_.now())) {
    if (!is_final(job.state)) {
      return false;
    }
  }
  return true;
}

}  // namespace bandsaw::coordinator::sim
