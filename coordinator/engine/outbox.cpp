#include "coordinator/engine/outbox.h"

#include <utility>

namespace bandsaw::coordinator {

absl::Status Outbox::write() {
  const absl::Status written = journal_.append(records_);
  if (written.ok()) {
    records_.clear();
  }
  return written;
}

absl::Status Outbox::flush() {
  if (const absl::Status written = write(); !written.ok()) {
    fail_replies(written);
    return written;
  }
  // What is done here may put more into the outbox: that waits for the next flush.
  for (Waiting& next : std::exchange(waiting_, {})) {
    if (next.deed) {
      next.deed();
    } else {
      next.reply(absl::OkStatus());
    }
  }
  return absl::OkStatus();
}

void Outbox::fail_replies(const absl::Status& status) {
  std::deque<Waiting> all = std::exchange(waiting_, {});
  for (Waiting& next : all) {
    if (next.deed) {
      waiting_.push_back(std::move(next));
    }
  }
  for (Waiting& next : all) {
    if (next.reply) {
      next.reply(status);
    }
  }
}

}  // namespace bandsaw::coordinator
