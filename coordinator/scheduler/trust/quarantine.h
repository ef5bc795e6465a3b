#pragma once

// Puts machines that returned wrong pixels under quarantine. Such a machine gets no work until a
// user lifts the quarantine. The rows that it rendered in active jobs are rendered again.

#include <set>
#include <string>

#include "coordinator/scheduler/context/context.h"
#include "coordinator/scheduler/dispatch/lease_ledger.h"
#include "coordinator/scheduler/liveness/sessions.h"

namespace bandsaw::coordinator {

class Quarantine {
 public:
  Quarantine(Context& context, LeaseLedger& ledger, Sessions& sessions)
      : context_(context), ledger_(ledger), sessions_(sessions) {}

  /// Quarantines the machine of the reporter (the origin of a result), that is, all worker
  /// processes that report its name. `reason` continues a sentence that begins with the machine's
  /// name. Jobs whose image was requested keep their rows, since the image may be written already.
  void impose(const Reporter& reporter, const std::string& reason);
  /// A user quarantines a worker or machine by its name. Answers NOT_FOUND if no known worker has
  /// the name.
  void request(const input::Quarantine& in);
  /// A user lifts a quarantine. Answers NOT_FOUND if no worker of this name is under quarantine.
  void lift(const input::LiftQuarantine& in);

 private:
  void add_earlier_processes(const Reporter& reporter, std::set<WorkerProcessId>& processes) const;
  void expel(Worker& worker);
  void retract(Job& job, WorkerProcessId process, const std::string& why);

  Context& context_;
  LeaseLedger& ledger_;
  Sessions& sessions_;
};

}  // namespace bandsaw::coordinator
