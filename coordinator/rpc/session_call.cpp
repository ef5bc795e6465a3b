// Reads the messages of a worker one after the other, and passes each to the engine.

#include "coordinator/rpc/session_call.h"

namespace bandsaw::coordinator {

void SessionCall::begin() {
  if (const absl::Status status = deps_.streams.add(weak_from_this()); !status.ok()) {
    stop(status);
    return;
  }
  read_next();
}

void SessionCall::OnReadDone(bool ok) {
  if (ok) {
    received(incoming_, shared_from_this());
  } else {
    end_after_queue(absl::OkStatus());
  }
}

}  // namespace bandsaw::coordinator
