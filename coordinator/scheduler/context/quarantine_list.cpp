// The list of quarantined worker processes. A native worker is recognised by the id of its process
// and by the name that it reports, a browser only by the id of its process. The numbers of native
// workers and of browsers in the list are limited separately.

#include "coordinator/scheduler/context/quarantine_list.h"

#include <algorithm>

#include "absl/strings/str_cat.h"
#include "coordinator/scheduler/api/worker_process.h"

namespace bandsaw::coordinator {

void QuarantineList::add(const record::WorkerQuarantined& r) {
  const auto native = [](const auto& entry) { return !entry.second.browser; };
  const auto natives = std::count_if(entries_.begin(), entries_.end(), native);
  if (!r.browser && !contains(r.process) && static_cast<std::size_t>(natives) >= kMaxNatives) {
    const auto lifted = std::find_if(entries_.begin(), entries_.end(), [&](const auto& entry) {
      return native(entry) && entry.second.lifted;
    });
    entries_.erase(lifted == entries_.end() ? std::find_if(entries_.begin(), entries_.end(), native)
                                            : lifted);
  }
  entries_[r.process] = {.name = r.name, .reason = r.reason, .browser = r.browser, .lifted = false};
}

void QuarantineList::lift(const std::string& name) {
  for (auto& [process, entry] : entries_) {
    entry.lifted = entry.lifted || entry.name == name;
  }
}

bool QuarantineList::in_force(WorkerProcessId process) const {
  const auto entry = entries_.find(process);
  return entry != entries_.end() && !entry->second.lifted;
}

void QuarantineList::forget_browsers() {
  const bool all = too_many_browsers();
  std::erase_if(entries_, [&](const auto& entry) {
    return entry.second.browser && (all || entry.second.lifted);
  });
}

bool QuarantineList::too_many_browsers() const {
  const auto here = std::count_if(entries_.begin(), entries_.end(), [](const auto& entry) {
    return entry.second.browser && !entry.second.lifted;
  });
  return static_cast<std::size_t>(here) >= kMaxBrowsers;
}

std::optional<std::string> QuarantineList::reason_against(const std::string& instance,
                                                          const std::string& reported_name) const {
  if (const auto own = entries_.find(worker_process_id(instance)); own != entries_.end()) {
    return own->second.lifted ? "its quarantine was lifted: start the worker again"
                              : describe(own->second);
  }
  for (const auto& [process, entry] : entries_) {
    if (!entry.lifted && !entry.name.empty() && entry.name == reported_name) {
      return describe(entry);
    }
  }
  return std::nullopt;
}

std::optional<record::WorkerQuarantined> QuarantineList::missing_name(
    const WorkerHello& worker) const {
  const auto own = entries_.find(worker_process_id(worker.instance));
  if (own == entries_.end() || !own->second.name.empty()) {
    return std::nullopt;
  }
  return record::WorkerQuarantined{own->first, worker.reported_name(), own->second.reason,
                                   own->second.browser};
}

std::string QuarantineList::describe(const Entry& entry) {
  return absl::StrCat(
      "quarantined: it ", entry.reason,
      "; check the machine's memory and cooling, then run `bandsaw quarantine --lift ", entry.name,
      "`");
}

// A QuarantineLifted record lifts all earlier entries with its name. So the lifted entries and
// their QuarantineLifted records come first, and then the entries that are in force.
void QuarantineList::add_records(std::vector<Record>& out) const {
  for (const bool lifted : {true, false}) {
    for (const auto& [process, entry] : entries_) {
      if (entry.lifted == lifted) {
        out.push_back(record::WorkerQuarantined{process, entry.name, entry.reason, entry.browser});
      }
    }
    for (const auto& [process, entry] : entries_) {
      if (lifted && entry.lifted) {
        out.push_back(record::QuarantineLifted{entry.name});
      }
    }
  }
}

}  // namespace bandsaw::coordinator
