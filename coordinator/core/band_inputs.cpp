// A band's pixels are on disk, or a worker could not make them.

#include "absl/strings/str_cat.h"
#include "coordinator/core/probes.h"
#include "coordinator/core/state.h"

namespace bandsaw::coordinator {
namespace {

/// A worker's pace changes less from band to band than what the rows cost.
constexpr double kNewestPace = 0.15;

}  // namespace

std::optional<std::vector<RowRange>> Core::State::wanted(JobId id, const Band& band) const {
  const Job* job = find(id);
  const Pass* pass = job == nullptr || is_final(job->state) ? nullptr : job->pass_of(band);
  if (pass == nullptr) {
    return std::nullopt;
  }
  return pass->coverage.wanted(band);
}

TileSamples Core::State::tiles(JobId id, const Band& band) const {
  const Job* job = find(id);
  const Pass* pass = job == nullptr ? nullptr : job->pass_of(band);
  return pass == nullptr ? TileSamples() : pass->tiles_of(band);
}

void Core::State::on(const input::BandStored& in) {
  Job* job = find(in.job);
  Pass* pass = job == nullptr || is_final(job->state) ? nullptr : job->pass_of(in.band);
  if (pass == nullptr) {
    return;
  }
  if (in.row_digests.size() != in.band.rows.count()) {
    step_.status = absl::InternalError("a stored band needs one digest a row");
    return;
  }
  const Witness witness = witness_of(in);
  if (!is_quarantined(witness)) {
    weigh(*job, *pass, in, witness);
  }
  if (is_quarantined(witness)) {
    settle(*job);
    return;
  }
  Worker* worker = workers_.by_instance(in.instance);
  if (worker != nullptr) {
    measure(*worker, *job, in);
    worker->on_job[job->id].faults = 0;
    if (!is_suspect(*job, in.band)) {
      loss_rate_.add_band();
    }
  }
  const Coverage::Change change = in.written ? store(*job, *pass, in, witness) : Coverage::Change();
  if (worker != nullptr) {
    end_own(*worker, in);
  }
  end_overtaken(change.overtaken);
  end_useless_copies(*job);
  if (!change.rows.empty()) {
    act(action::AddToFilm{.job = job->id,
                          .band = in.band,
                          .rows = change.rows,
                          .worker = worker == nullptr ? std::string() : worker->name,
                          .tiles = pass->tiles_of(in.band)});
  }
  settle(*job);
}

Coverage::Change Core::State::store(Job& job, Pass& pass, const input::BandStored& in,
                                    const Witness& witness) {
  Coverage::Change change = pass.coverage.assign(in.band, kStored);
  job.bands_on_disk = true;
  if (change.rows.empty()) {
    return change;
  }
  pass.digests.keep(in.band, change.rows, in.row_digests);
  shrink_losses(job, in.band);
  std::uint64_t samples = 0;
  for (const RowRange& range : change.rows) {
    samples += job.samples_of({in.band.samples, range});
  }
  pass.credit(witness.renderer, in.band, change.rows, {samples, in.counters, in.cpu_s});
  open_audits(job, in, witness, change.rows);
  job.throughput.add(clock_.wall(), static_cast<double>(samples));
  count_share(job, in, witness.renderer, samples);
  job.advance();
  touch(job);
  return change;
}

void Core::State::count_share(Job& job, const input::BandStored& in, std::uint64_t renderer,
                              std::uint64_t samples) {
  if (renderer == 0 || (job.shares.size() >= Job::kSharesKnown && !job.shares.contains(renderer))) {
    return;
  }
  WorkerShare& share = job.shares[renderer];
  share.renderer = renderer;
  share.samples += samples;
  share.cpu_s += in.cpu_s;
  if (const Worker* worker = workers_.by_instance(in.instance)) {
    share.name = worker->name;
  }
}

void Core::State::measure_pace(Worker& worker, Job& job, const input::BandStored& in) {
  Worker::OnJob& on_job = worker.on_job[job.id];
  const double work = job.cost_of(in.band);  // as was expected
  // Of a worker that is new to the job, what others of as many threads do is as good a guess.
  if (job.per_thread.measured()) {
    const double expected = pace(worker, job);
    job.cost.learn(in.band.rows, in.render_s * expected / work);
    if (!on_job.pace.measured()) {
      on_job.pace.measure(expected);
    }
  }
  on_job.pace.measure(work / in.render_s, std::max(kNewestPace, 1.0 / (2 + on_job.bands++)));
  job.per_thread.measure(on_job.pace.mean() / worker.threads);
}

void Core::State::measure(Worker& worker, Job& job, const input::BandStored& in) {
  if (in.render_s <= 0) {
    return;
  }
  const std::uint64_t samples = job.samples_of(in.band);
  if (samples == 0) {
    return;  // only zeros: it says nothing of anybody's speed
  }
  const double speed = static_cast<double>(samples) / in.render_s;
  worker.speed.measure(speed);
  worker.on_job[job.id].speed.measure(speed);
  if (!is_probe(job.spec.settings.height, in.band)) {
    measure_pace(worker, job, in);
  }
  // Samples are those that pixels took: of so many columns of all rows.
  const double columns = static_cast<double>(samples) / in.band.rows.count();
  job.row_times.measure(in.band.rows, in.render_s * worker.threads / columns);
}

void Core::State::end_own(const Worker& worker, const input::BandStored& in) {
  for (const LeaseId id : worker.leases) {
    if (const Lease& lease = *leases_.find(id); lease.job == in.job && lease.band == in.band) {
      // The answer to a Hello may reach the worker after it has dropped this band as stored.
      end_lease(id, lease.taken_up ? Revoke::kYes : Revoke::kNo);
      return;
    }
  }
}

void Core::State::on(const input::BandFailed& in) {
  Worker* worker = workers_.by_session(in.session);
  const Lease* lease = leases_.find(in.lease);
  if (worker == nullptr || lease == nullptr || lease->worker != worker->id) {
    return;
  }
  Job& job = jobs_.at(lease->job);
  const Band band = lease->band;
  worker->heard_at = clock_.patience();
  if (lease->audit) {
    give_up_audit(*lease, *worker, in.reason);
    return;
  }
  end_lease(in.lease, Revoke::kNo);
  job.log_of = worker->name;
  job.log = in.log;
  add_fault(job, *worker, band, in.reason);
}

}  // namespace bandsaw::coordinator
