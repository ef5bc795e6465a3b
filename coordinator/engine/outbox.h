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
class Outbox {
 public:
  /// Done once everything recorded before is on disk.
  using Deed = absl::AnyInvocable<void()>;
  /// Called with OK as a deed is, or with the journal's error; then nothing may be acknowledged.
  using Reply = absl::AnyInvocable<void(const absl::Status&)>;

  explicit Outbox(Journal& journal) : journal_(journal) {}

  bool empty() const { return records_.empty() && waiting_.empty(); }

  void record(Record record) { records_.push_back(std::move(record)); }
  void deed(Deed deed) { waiting_.push_back({std::move(deed), nullptr}); }
  void reply(Reply reply) { waiting_.push_back({nullptr, std::move(reply)}); }

  /// Appends all records at once, and no more. On an error they stay.
  absl::Status write();
  /// Appends all records at once, then does and answers everything in the order it came. On an
  /// error the replies are given it, and records and deeds stay, in order, for the next flush.
  absl::Status flush();
  /// Gives all replies that wait this error.
  void fail_replies(const absl::Status& status);

 private:
  struct Waiting {
    Deed deed;
    Reply reply;
  };
  Journal& journal_;
  std::vector<Record> records_;
  std::deque<Waiting> waiting_;
};

}  // namespace bandsaw::coordinator
