#pragma once

// The connections to workers, by session. perform() carries out an action of the scheduler: it
// sends the action as a message to the worker of the session that the action names.

#include <map>
#include <memory>
#include <string>

#include "coordinator/engine/worker_link.h"
#include "coordinator/scheduler/api/messages.h"

namespace bandsaw::coordinator {

/// Not thread-safe. Messages to a session that has ended are dropped.
class Links {
 public:
  explicit Links(std::string epoch) : epoch_(std::move(epoch)) {}

  void add(SessionId session, std::shared_ptr<WorkerLink> link, const WorkerHello& hello);
  /// MUST be called when the stream of the session has ended. Does nothing if action::Close has
  /// ended the session before.
  void lost(SessionId session, const std::string& reason);

  /// Returns the worker's displayed name; empty: no such session.
  std::string name(SessionId session) const;

  void perform(const action::Welcome& welcome);
  void perform(const action::Refuse& refuse);
  void perform(const action::Close& close);
  void perform(const action::Lease& lease);
  void perform(const action::Revoke& revoke);

 private:
  /// The connection to one worker.
  struct One {
    std::shared_ptr<WorkerLink> link;
    std::string name;  ///< for the log
    std::string address;
  };
  One* find(SessionId session);

  std::string epoch_;  ///< name of this run of the coordinator, which each worker is told
  std::map<SessionId, One> sessions_;
};

}  // namespace bandsaw::coordinator
