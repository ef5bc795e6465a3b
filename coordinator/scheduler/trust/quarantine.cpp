// Quarantining a machine journals a record for each of its worker processes, and disconnects those
// that are connected. The rows that these processes stored in active jobs are freed, so that the
// rows are rendered again.

#include "coordinator/scheduler/trust/quarantine.h"

#include <set>
#include <vector>

#include "absl/strings/str_cat.h"
#include "proto/wire/limits.h"
#include "renderlib/base/clean_text.h"

namespace bandsaw::coordinator {

void Quarantine::impose(const Reporter& reporter, const std::string& cause) {
  const std::string reason = reporter.browser
                                 ? absl::StrCat(cause,
                                                "; a page that is loaded again is a new worker, so "
                                                "take the link back if this goes on")
                                 : cause;
  const std::string name = reporter.browser ? context_.name_of(reporter) : reporter.machine;
  std::set<WorkerProcessId> processes = {reporter.process};
  std::vector<WorkerId> workers;
  for (const auto& [id, worker] : context_.workers.all()) {
    if (const Reporter other = worker.reporter(); other.same_machine(reporter)) {
      processes.insert(other.process);
      workers.push_back(id);
    }
  }
  add_earlier_processes(reporter, processes);
  for (const WorkerProcessId process : processes) {
    if (process != 0 && !context_.quarantine.in_force(process)) {
      context_.emit(record::WorkerQuarantined{process, name, clean_text(reason, wire::kReasonBytes),
                                              reporter.browser});
    }
  }
  for (const WorkerId id : workers) {
    if (Worker* worker = context_.workers.by_id(id)) {
      expel(*worker);
    }
  }
  const std::set<JobId> active = context_.jobs.active();
  for (const JobId id : active) {
    for (const WorkerProcessId process : processes) {
      retract(context_.jobs.at(id), process, absl::StrCat(context_.name_of(reporter), " ", reason));
    }
  }
}

/// Adds those processes of the reporter's machine that returned a result of an open audit (a
/// comparison of results that has no verdict yet), also in an earlier run of the coordinator.
void Quarantine::add_earlier_processes(const Reporter& reporter,
                                       std::set<WorkerProcessId>& processes) const {
  for (const JobId id : context_.jobs.active()) {
    for (const Audit& audit : context_.jobs.at(id).audits) {
      for (const Audit::Result& result : audit.results()) {
        if (result.reporter.same_machine(reporter)) {
          processes.insert(result.reporter.process);
        }
      }
    }
  }
}

/// Disconnects the worker, and marks it as quarantined, so that it gets no more work.
void Quarantine::expel(Worker& worker) {
  worker.quarantined = true;
  worker.reason = context_.quarantine
                      .reason_against(worker.instance, worker.browser ? "" : worker.reported_name)
                      .value_or("");
  if (worker.session) {
    context_.act(action::Close{*worker.session, worker.reason});
    sessions_.disconnect(worker, worker.reason);
  }
}

/// Frees the rows that the process stored in the job. `why` begins the notice that users see.
void Quarantine::retract(Job& job, WorkerProcessId process, const std::string& why) {
  if (job.image_requested) {
    return;
  }
  // The audits of the rows that are freed end, so the leases of these audits are useless.
  std::vector<LeaseId> useless;
  for (const Audit& audit : job.audits) {
    if (audit.stored().reporter.process == process && audit.lease != 0) {
      useless.push_back(audit.lease);
    }
  }
  ledger_.end_all(useless, LeaseLedger::Revoke::kYes);
  if (!job.retract(process)) {
    return;
  }
  job.notice = absl::StrCat(why, "; what it rendered is rendered again");
  context_.emit(record::ErrorForgotten{job.id});
  context_.act(action::Retract{job.id, process});
  context_.jobs.mark_leasable(job);
}

void Quarantine::request(const input::Quarantine& in) {
  std::vector<Reporter> meant;
  for (const auto& [id, worker] : context_.workers.all()) {
    if (worker.name == in.worker || worker.reported_name == in.worker) {
      meant.push_back(worker.reporter());
    }
  }
  if (meant.empty()) {
    context_.answer(
        absl::NotFoundError(absl::StrCat("no worker of this name was connected: ", in.worker,
                                         "; `bandsaw workers` lists all workers")));
  }
  for (const Reporter& reporter : meant) {
    impose(reporter, "was excluded by a user");
  }
}

void Quarantine::lift(const input::LiftQuarantine& in) {
  std::set<std::string> names;
  for (const auto& [process, entry] : context_.quarantine.entries()) {
    const Worker* worker = context_.workers.by_process(process);
    if (!entry.lifted &&
        (entry.name == in.worker || (worker != nullptr && worker->name == in.worker))) {
      names.insert(entry.name);
    }
  }
  if (names.empty()) {
    context_.answer(absl::NotFoundError(
        absl::StrCat(in.worker, " is not under quarantine; `bandsaw workers` lists all workers")));
  }
  for (const std::string& name : names) {
    context_.emit(record::QuarantineLifted{name});
  }
  for (auto& [id, worker] : context_.workers.all()) {
    if (worker.quarantined) {
      worker.reason =
          context_.quarantine
              .reason_against(worker.instance, worker.browser ? "" : worker.reported_name)
              .value_or("");
    }
  }
}

}  // namespace bandsaw::coordinator
