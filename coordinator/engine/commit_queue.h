#pragma once

// Durable first: records wait here for the journal, and what they led to waits for them.

#include <deque>
#include <vector>

#include "absl/functional/any_invocable.h"
#include "absl/status/status.h"
#include "coordinator/scheduler/api/messages.h"
#include "coordinator/store/journal.h"

namespace bandsaw::coordinator {

/// Used by one thread.
class CommitQueue {
 public:
  /// Done once everything recorded before is on disk.
  using Effect = absl::AnyInvocable<void()>;
  /// Called with OK as a effect is, or with the journal's error; then nothing may be acknowledged.
  using Completion = absl::AnyInvocable<void(const absl::Status&)>;

  explicit CommitQueue(Journal& journal) : journal_(journal) {}

  bool empty() const { return records_.empty() && waiting_.empty(); }

  void record(Record record) { records_.push_back(std::move(record)); }
  void effect(Effect effect) { waiting_.push_back({std::move(effect), nullptr}); }
  void completion(Completion completion) { waiting_.push_back({nullptr, std::move(completion)}); }

  /// Appends all records at once, and no more. On an error they stay.
  absl::Status write();
  /// Appends all records at once, then does and answers everything in the order it came. On an
  /// error the completions are given it, and records and effects stay, in order, for the next
  /// flush.
  absl::Status flush();
  /// Gives all completions that wait this error.
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
