// Records wait here for the journal. Effects (functions that carry out a decision) and completions
// (functions that receive OK or the journal's error) must not be called before the records are on
// disk, so they wait here, too. flush() writes all records at once. If that fails, completions are
// called with the error, while effects and records stay.

#include "coordinator/engine/commit_queue.h"

#include <utility>

namespace bandsaw::coordinator {

absl::Status CommitQueue::write() {
  const absl::Status written = journal_.append(records_);
  if (written.ok()) {
    records_.clear();
  }
  return written;
}

absl::Status CommitQueue::flush() {
  if (const absl::Status written = write(); !written.ok()) {
    fail_completions(written);
    return written;
  }
  // An effect may add entries to the queue; they wait for the next flush.
  for (Waiting& next : std::exchange(waiting_, {})) {
    if (next.effect) {
      next.effect();
    } else {
      next.completion(absl::OkStatus());
    }
  }
  return absl::OkStatus();
}

void CommitQueue::fail_completions(const absl::Status& status) {
  std::deque<Waiting> all = std::exchange(waiting_, {});
  for (Waiting& next : all) {
    if (next.effect) {
      waiting_.push_back(std::move(next));
    }
  }
  for (Waiting& next : all) {
    if (next.completion) {
      next.completion(status);
    }
  }
}

}  // namespace bandsaw::coordinator
