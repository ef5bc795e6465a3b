#pragma once

// The quarantine list: worker processes whose results are void because they returned wrong pixels
// (or a user said so), and the machines that are not admitted because of them. All of it is
// journalled. A native worker is known by the name of its machine; a browser, which may choose any
// name, only by its process.

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "coordinator/scheduler/api/ids.h"
#include "coordinator/scheduler/api/messages.h"

namespace bandsaw::coordinator {

class QuarantineList {
 public:
  struct Entry {
    /// Name that the worker reports, or displayed name of a browser; empty: unknown, because the
    /// process has not connected since the coordinator started.
    std::string name;
    std::string reason;
    bool browser = false;
    bool lifted = false;  ///< the machine is admitted again; the process's results stay void
  };
  /// While this many browsers are under quarantine, no browser is admitted. Without this limit the
  /// list could grow without end, because a page that is loaded again is a new worker process: a
  /// browser could return wrong pixels, be quarantined and join again any number of times.
  static constexpr std::size_t kMaxBrowsers = 256;

  /// Adds an entry, or replaces the entry of the same process, lifted or not. If the list has
  /// kMaxNatives native workers (workers that are no browsers) already, one of their entries is
  /// forgotten before another native worker is added: a lifted entry if there is one.
  void add(const record::WorkerQuarantined& r);
  /// Lifts the quarantine of all processes with this name.
  void lift(const std::string& name);

  /// Forgets the lifted entries of browsers. If too_many_browsers(), forgets all entries of
  /// browsers, so that browsers are admitted again. MUST be called only while no active job has
  /// bands that browsers rendered: an entry is needed as long as results of its process may have to
  /// be discarded. An entry cannot keep a browser out, because a page that is loaded again is a new
  /// process without an entry.
  void forget_browsers();

  /// Returns true if the process has an entry, lifted or not.
  bool contains(WorkerProcessId process) const { return entries_.contains(process); }
  /// Returns true if the process has an entry that is not lifted.
  bool in_force(WorkerProcessId process) const;
  /// Returns why a worker is not admitted; std::nullopt: it is admitted. `instance` identifies its
  /// process. `reported_name`: empty for a browser, which is recognised by its process only.
  std::optional<std::string> reason_against(const std::string& instance,
                                            const std::string& reported_name) const;
  /// Returns true if kMaxBrowsers browsers are under quarantine.
  bool too_many_browsers() const;
  /// A process that has not connected since the coordinator started can be quarantined. Then its
  /// entry has no name. If this is the case for the process of `worker`, returns the record that
  /// sets the name of the entry to the name that `worker` reports. Otherwise returns std::nullopt.
  std::optional<record::WorkerQuarantined> missing_name(const WorkerHello& worker) const;
  /// Returns the sentence that is shown for an entry.
  static std::string describe(const Entry& entry);

  const std::map<WorkerProcessId, Entry>& entries() const { return entries_; }
  /// Appends the records from which a replay of the journal makes this list again.
  void add_records(std::vector<Record>& out) const;

 private:
  static constexpr std::size_t kMaxNatives = 1'024;
  std::map<WorkerProcessId, Entry> entries_;
};

}  // namespace bandsaw::coordinator
