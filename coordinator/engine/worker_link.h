#pragma once

// The connection to one worker. It sends the scheduler's actions (scheduler/api/messages.h) to this
// worker. The connection is a gRPC stream, the WebSocket of a browser, or a fake in tests. Calls
// never block and never fail; a broken link drops its messages.

#include "coordinator/scheduler/api/messages.h"

namespace bandsaw::coordinator {

class WorkerLink {
 public:
  virtual ~WorkerLink() = default;
  /// `epoch`: name of this run of the coordinator.
  virtual void welcome(const action::Welcome& welcome, const std::string& epoch) = 0;
  virtual void refuse(const action::Refuse& refuse) = 0;
  virtual void lease(const action::Lease& lease) = 0;
  virtual void revoke(const action::Revoke& revoke) = 0;
  /// Ends the stream.
  virtual void close(const std::string& reason) = 0;
};

}  // namespace bandsaw::coordinator
