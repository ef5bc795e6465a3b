#pragma once

// Write-ahead ordering: the records of decisions wait here for the journal, and their effects are
// run only when the records are on disk.

#include <deque>
#include <vector>

#include "absl/functional/any_invocable.h"
#include "absl/status/status.h"
#include "coordinator/scheduler/api/messages.h"
#include "coordinator/store/journal.h"

namespace bandsaw::coordinator {

/// Not thread-safe.
class CommitQueue {
 public:
  /// An effect is run once all records that were added before it are on disk.
  using Effect = absl::AnyInvocable<void()>;
  /// A completion is called with OK once all records that were added before it are on disk, or with
  /// the journal's error. A completion that gets an error MUST NOT acknowledge the decision to the
  /// user or the worker.
  using Completion = absl::AnyInvocable<void(const absl::Status&)>;

  explicit CommitQueue(Journal& journal) : journal_(journal) {}

  bool empty() const { return records_.empty() && waiting_.empty(); }

  void record(Record record) { records_.push_back(std::move(record)); }
  void effect(Effect effect) { waiting_.push_back({std::move(effect), nullptr}); }
  void completion(Completion completion) { waiting_.push_back({nullptr, std::move(completion)}); }

  /// Appends all records to the journal at once, but runs no effects or completions. On an error
  /// the records stay in the queue.
  absl::Status write();
  /// Appends all records to the journal at once, then runs all effects and completions in the order
  /// in which they were added. On an error the completions are called with it, and records and
  /// effects stay in the queue, in order, for the next flush.
  absl::Status flush();
  /// Calls all waiting completions with this error.
  void fail_completions(const absl::Status& status);

 private:
  struct Waiting {
    Effect effect;
    Completion completion;
  };
  Journal& journal_;
  std::vector<Record> records_;
  std::deque<Waiting> waiting_;
};

}  // namespace bandsaw::coordinator
