// Each broken_X() checks one part of the state, and returns a sentence about the first invariant
// that does not hold; std::nullopt: all hold.

#include "coordinator/scheduler/replay/invariants.h"

#include <algorithm>

#include "absl/strings/str_cat.h"
#include "proto/wire/limits.h"

namespace bandsaw::coordinator {
namespace {

/// Checks that each lease, its job and its connected worker know each other. A lease owns rows of
/// its band, unless it is for an audit (a second render, to compare) or a backup task (a second
/// lease of a late band). The band of a backup task lies in the band of another worker's lease.
std::optional<std::string> broken_leases(const Context& context) {
  for (const auto& [id, lease] : context.leases.all()) {
    const Job* job = context.jobs.find(lease.job);
    if (job == nullptr || is_final(job->state) || !job->leases.contains(id)) {
      return absl::StrCat("lease ", id, " belongs to a job that does not know it");
    }
    const Pass* pass = job->pass_of(lease.band);
    if (pass == nullptr ||
        (lease.backup_of == 0 && !lease.audit) != pass->coverage.holds(lease.band, id)) {
      return absl::StrCat("lease ", id,
                          " should own a part of its band and does not, or the reverse");
    }
    const auto is_its_audit = [&id = id, &lease = lease](const Audit& a) {
      return a.lease == id && a.band() == lease.band;
    };
    if (lease.audit && std::count_if(job->audits.begin(), job->audits.end(), is_its_audit) != 1) {
      return absl::StrCat("lease ", id, " is for an audit that its job does not know");
    }
    if ((lease.backup_of != 0) != job->backups.contains(id)) {
      return absl::StrCat("lease ", id,
                          " is a backup task that its job does not know, or the reverse");
    }
    if (const Lease* of = context.leases.find(lease.backup_of);
        lease.backup_of != 0 &&
        (of == nullptr || of->backup_of != 0 || of->worker == lease.worker ||
         of->job != lease.job || of->band.samples != lease.band.samples ||
         lease.band.rows.first < of->band.rows.first ||
         lease.band.rows.last > of->band.rows.last)) {
      return absl::StrCat("lease ", id, " is a backup task for no lease that contains its band");
    }
    const Worker* worker = context.workers.by_id(lease.worker);
    if (worker == nullptr || !worker->session ||
        std::count(worker->leases.begin(), worker->leases.end(), id) != 1) {
      return absl::StrCat("lease ", id, " does not belong to a connected worker");
    }
  }
  return std::nullopt;
}

/// Checks the leases of the workers, that connected workers are journalled, and that the workers
/// with spare credits (they may hold more leases) are those that are listed as available.
std::optional<std::string> broken_workers(const Context& context) {
  std::size_t available = 0;
  std::uint64_t threads = 0;
  for (const auto& [id, worker] : context.workers.all()) {
    for (const LeaseId lease : worker.leases) {
      if (context.leases.find(lease) == nullptr) {
        return absl::StrCat(worker.name, " has a lease that does not exist");
      }
    }
    if (worker.leases.size() > wire::kBandsPerWorker) {
      return absl::StrCat(worker.name, " has too many leases");
    }
    if (worker.has_spare_credit() != context.available.contains({worker.leases.size(), id})) {
      return absl::StrCat(worker.name,
                          " has spare credits and is not listed as available, or the reverse");
    }
    available += worker.has_spare_credit() ? 1 : 0;
    threads += worker.eligible() ? worker.threads : 0;
    if (worker.session && !context.joined.contains(worker.instance)) {
      return absl::StrCat(worker.name, " is connected and not journalled");
    }
  }
  if (available != context.available.size() || threads != context.available.threads()) {
    return "workers that have left are listed as available";
  }
  return std::nullopt;
}

/// Checks the coverage of a pass, which is divided into cells (each a range of rows and samples
/// with one owner; model/coverage.h). The cells MUST partition the pass. If the owner of a cell is
/// a lease, this MUST be a lease of the job, and its band MUST contain the cell.
std::optional<std::string> broken_pass(const Context& context, const Job& job, const Pass& pass) {
  std::optional<std::string> broken;
  auto partition = pass.coverage.check([&](LeaseId id, const Band& cell) {
    const Lease* lease = context.leases.find(id);
    if (lease == nullptr || lease->job != job.id || lease->band.samples != cell.samples ||
        cell.rows.first < lease->band.rows.first || cell.rows.last > lease->band.rows.last) {
      broken = absl::StrCat("row ", cell.rows.first, " is owned by lease ", id,
                            ", which does not exist or does not contain the row");
    }
  });
  return broken ? broken : std::move(partition);
}

/// Checks that the state of the job agrees with its leases, audits, passes and place in the lists
/// of jobs. Passes MUST follow each other as nodes of the summation tree, that is, as aligned
/// power-of-two numbers of blocks of 8 samples.
std::optional<std::string> broken_job(const Context& context, const Job& job) {
  if (is_final(job.state) == context.jobs.active().contains(job.id)) {
    return "it is counted as active and final, or as neither";
  }
  if (is_final(job.state)) {
    return job.leases.empty() && job.passes.empty() ? std::nullopt
                                                    : std::optional("it is final and has leases");
  }
  if (job.state == JobState::kFinishing && (!job.complete() || !job.leases.empty())) {
    return "it is finishing and not all of it is stored";
  }
  if (job.state == JobState::kRunning && job.complete() && job.audits.empty()) {
    return "all of it is stored and it is not finishing";
  }
  for (const Audit& audit : job.audits) {
    if (audit.lease != 0 && !job.leases.contains(audit.lease)) {
      return "an audit has a lease that the job does not know";
    }
    if (context.quarantine.contains(audit.stored().reporter.process)) {
      return "it has rows of a machine that is under quarantine";
    }
  }
  if (job.state == JobState::kRunning && (job.any_free() || job.audit_waits()) &&
      !context.jobs.leasable().contains(JobTable::rank(job))) {
    return "it has free rows and is not leasable";
  }
  if (job.state != JobState::kRunning && context.jobs.leasable().contains(JobTable::rank(job))) {
    return "it is leasable and does not run";
  }
  if (job.held && job.state == JobState::kRunning) {
    return "a user paused it and it runs";
  }
  if (job.passes.empty() || (job.fixed_samples && job.planned_samples() > *job.fixed_samples)) {
    return "its passes do not follow from its stop rule";
  }
  std::uint64_t end = 0;
  for (const Pass& pass : job.passes) {
    if (pass.samples.first != end || !is_node(pass.samples)) {
      return absl::StrCat("the pass after sample ", end,
                          " does not begin there or is not a node of the summation tree");
    }
    end = pass.samples.last;
    if (auto broken = broken_pass(context, job, pass)) {
      return broken;
    }
  }
  return std::nullopt;
}

/// Checks that the state of each frame agrees with the job that renders it, and the state of the
/// sequence (a job of many frames) with its frames.
std::optional<std::string> broken_sequence(const Context& context, const Sequence& sequence) {
  if (is_final(sequence.state) == context.sequences.active().contains(sequence.id)) {
    return "it is counted as active and final, or as neither";
  }
  if (is_final(sequence.state) && !sequence.open_jobs().empty()) {
    return "it is final and a frame is rendered";
  }
  FrameCounts counts;
  for (const Sequence::Frame& frame : sequence.frames()) {
    ++counts.in[static_cast<std::size_t>(frame.state)];
    const Job* job = context.jobs.find(frame.job);
    const bool known =
        job != nullptr && job->spec.sequence == sequence.id && job->spec.frame == frame.number;
    const bool open = sequence.open_jobs().contains(frame.job);
    const bool right =
        frame.state == FrameState::kRendering ? known && open && !is_final(job->state)
        : frame.state == FrameState::kDone    ? known && !open && job->state == JobState::kDone
        : frame.state == FrameState::kFailed  ? known && !open && is_final(job->state)
                                              : frame.job == 0;
    if (!right) {
      return absl::StrCat("frame ", frame.number, " is ", frame_state_name(frame.state),
                          " and its job says otherwise");
    }
  }
  const std::size_t over = counts.of(FrameState::kDone) + counts.of(FrameState::kFailed);
  if (counts != sequence.counts() ||
      (sequence.state == JobState::kRunning && over == counts.all())) {
    return "the counts of its frames are wrong, or it runs and all of them are over";
  }
  return std::nullopt;
}

}  // namespace

std::optional<std::string> broken_invariant(const Context& context) {
  if (auto broken = broken_leases(context)) {
    return broken;
  }
  if (auto broken = broken_workers(context)) {
    return broken;
  }
  for (const auto& [id, job] : context.jobs.all()) {
    if (auto broken = broken_job(context, job)) {
      return absl::StrCat("job ", id, ": ", *broken);
    }
  }
  for (const auto& [id, sequence] : context.sequences.all()) {
    if (auto broken = broken_sequence(context, sequence)) {
      return absl::StrCat("sequence ", id, ": ", *broken);
    }
  }
  if (!context.step_is_empty()) {
    return "a step ended with actions or records left";
  }
  // The frame jobs of active sequences do not count against the limit.
  std::size_t active = context.jobs.active().size();
  for (const JobId id : context.sequences.active()) {
    active -= context.sequences.at(id).open_jobs().size();
  }
  if (active > wire::kActiveJobs || context.workers.connected() > wire::kWorkers) {
    return "there are more jobs or workers than the limits allow";
  }
  return std::nullopt;
}

}  // namespace bandsaw::coordinator
