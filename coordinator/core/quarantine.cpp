// Machines that returned wrong pixels: kept away until a person lets them in again, and what they
// rendered of jobs at work is rendered again.

#include <algorithm>
#include <set>

#include "absl/strings/str_cat.h"
#include "coordinator/core/renderer.h"
#include "coordinator/core/state.h"
#include "proto/wire/limits.h"
#include "renderlib/base/clean_text.h"

namespace bandsaw::coordinator {

std::string Core::State::shown_name(const Witness& witness) const {
  if (const Worker* worker = workers_.by_renderer(witness.renderer)) {
    return worker->name;
  }
  return witness.machine.empty() ? "a worker that has left" : witness.machine;
}

bool Core::State::is_quarantined(const Witness& witness) const {
  return quarantined_.contains(witness.renderer);
}

/// Why a worker is not let in, if it is not.
std::optional<std::string> Core::State::kept_away(const std::string& instance,
                                                  const std::string& said) const {
  if (const auto own = quarantined_.find(renderer_of(instance)); own != quarantined_.end()) {
    return own->second.lifted ? "its quarantine was lifted: start the worker again"
                              : quarantine_reason(own->second);
  }
  for (const auto& [renderer, one] : quarantined_) {
    if (!one.lifted && !one.name.empty() && one.name == said) {
      return quarantine_reason(one);
    }
  }
  return std::nullopt;
}

std::string Core::State::quarantine_reason(const Quarantined& one) {
  return absl::StrCat("quarantined: it ", one.reason,
                      "; check the machine's memory and cooling, then: bandsaw quarantine --lift ",
                      one.name);
}

/// A machine is wrong, not a process: all that bear its name go with it.
void Core::State::quarantine(const Witness& witness, const std::string& reason) {
  std::set<std::uint64_t> renderers = {witness.renderer};
  std::vector<WorkerId> workers;
  for (const auto& [id, worker] : workers_.all()) {
    if (const Witness other = witness_of(worker); other.same_machine(witness)) {
      renderers.insert(other.renderer);
      workers.push_back(id);
    }
  }
  for (const std::uint64_t renderer : renderers) {
    if (renderer != 0 && !quarantined_.contains(renderer)) {
      emit(record::WorkerQuarantined{renderer, witness.machine,
                                     clean_text(reason, wire::kReasonBytes)});
    }
  }
  for (const WorkerId id : workers) {
    if (Worker* worker = workers_.by_id(id)) {
      send_away(*worker);
    }
  }
  const std::set<JobId> active = active_;
  for (const JobId id : active) {
    for (const std::uint64_t renderer : renderers) {
      retract(jobs_.at(id), renderer, absl::StrCat(shown_name(witness), " ", reason));
    }
  }
}

/// What it rendered was found wrong before it was heard of, as after a restart.
void Core::State::learn_name(const WorkerHello& worker) {
  const auto own = quarantined_.find(renderer_of(worker.instance));
  if (own != quarantined_.end() && own->second.name.empty()) {
    emit(record::WorkerQuarantined{own->first, worker.name, own->second.reason});
  }
}

void Core::State::send_away(Worker& worker) {
  worker.quarantined = true;
  worker.reason = kept_away(worker.instance, worker.said).value_or("");
  if (worker.session) {
    act(action::Close{*worker.session, worker.reason});
    lose(worker, worker.reason);
  }
}

/// A job whose image was asked for is over: it may be written already.
void Core::State::retract(Job& job, std::uint64_t renderer, const std::string& why) {
  if (job.image_asked) {
    return;
  }
  std::vector<LeaseId> useless;
  for (const Audit& audit : job.audits) {
    if (audit.stored().witness.renderer == renderer && audit.lease != 0) {
      useless.push_back(audit.lease);
    }
  }
  end_all(useless, Revoke::kYes);
  if (!job.retract(renderer)) {
    return;
  }
  job.notice = absl::StrCat(why, "; what it rendered is rendered again");
  emit(record::ErrorForgotten{job.id});
  act(action::Retract{job.id, renderer});
  touch(job);
}

void Core::State::on(const input::Quarantine& in) {
  std::vector<Witness> meant;
  for (const auto& [id, worker] : workers_.all()) {
    if (worker.name == in.worker || worker.said == in.worker) {
      meant.push_back(witness_of(worker));
    }
  }
  if (meant.empty()) {
    step_.status = absl::NotFoundError(
        absl::StrCat("no worker of this name was here: ", in.worker, "; see: bandsaw workers"));
  }
  for (const Witness& witness : meant) {
    quarantine(witness, "was sent away by a person");
  }
}

void Core::State::on(const input::LiftQuarantine& in) {
  std::set<std::string> names;
  for (const auto& [renderer, one] : quarantined_) {
    const Worker* worker = workers_.by_renderer(renderer);
    if (!one.lifted &&
        (one.name == in.worker || (worker != nullptr && worker->name == in.worker))) {
      names.insert(one.name);
    }
  }
  if (names.empty()) {
    step_.status = absl::NotFoundError(
        absl::StrCat(in.worker, " is not under quarantine; see: bandsaw workers"));
  }
  for (const std::string& name : names) {
    emit(record::QuarantineLifted{name});
  }
  for (auto& [id, worker] : workers_.all()) {
    if (worker.quarantined) {
      worker.reason = kept_away(worker.instance, worker.said).value_or("");
    }
  }
}

void Core::State::apply(const record::WorkerQuarantined& r) {
  if (quarantined_.size() >= kQuarantinedKept) {
    const auto lifted = std::find_if(quarantined_.begin(), quarantined_.end(),
                                     [](const auto& entry) { return entry.second.lifted; });
    quarantined_.erase(lifted == quarantined_.end() ? quarantined_.begin() : lifted);
  }
  quarantined_[r.renderer] = {.name = r.name, .reason = r.reason, .lifted = false};
}

void Core::State::apply(const record::QuarantineLifted& r) {
  for (auto& [renderer, one] : quarantined_) {
    one.lifted = one.lifted || one.name == r.name;
  }
}

/// Those that were not seen in this life of the coordinator.
std::vector<WorkerView> Core::State::quarantined_views() const {
  std::map<std::string, WorkerView> views;
  for (const auto& [renderer, one] : quarantined_) {
    const auto is_it = [&name = one.name](const auto& w) {
      return w.second.quarantined && w.second.said == name;
    };
    const bool here = std::any_of(workers_.all().begin(), workers_.all().end(), is_it);
    if (!one.lifted && !one.name.empty() && !here) {
      WorkerView& view = views[one.name];
      view.name = one.name;
      view.state = "quarantined";
      view.reason = quarantine_reason(one);
    }
  }
  std::vector<WorkerView> out;
  for (auto& [name, view] : views) {
    out.push_back(std::move(view));
  }
  return out;
}

void Core::State::add_quarantine(std::vector<Record>& out) const {
  // A lifted one does not lift those that came after it.
  for (const bool lifted : {true, false}) {
    for (const auto& [renderer, one] : quarantined_) {
      if (one.lifted == lifted) {
        out.push_back(record::WorkerQuarantined{renderer, one.name, one.reason});
      }
    }
    for (const auto& [renderer, one] : quarantined_) {
      if (lifted && one.lifted) {
        out.push_back(record::QuarantineLifted{one.name});
      }
    }
  }
}

}  // namespace bandsaw::coordinator
