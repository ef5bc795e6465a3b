#pragma once

// Replacements of the engine's dependencies for tests: a clock that the test advances, and a
// journal in memory that can fail as on a full disk. From the records of a journal, a restarted
// engine restores its state.

#include <atomic>
#include <functional>
#include <memory>
#include <utility>
#include <vector>

#include "coordinator/engine/clock.h"
#include "coordinator/store/journal.h"
#include "renderlib/base/mutex.h"

namespace bandsaw::coordinator {

/// The time of a FakeClock, in seconds. The test keeps a pointer to the FakeTime and advances the
/// time. Thread-safe.
class FakeTime {
 public:
  void advance(double seconds) { now_ = now_ + seconds; }
  Time now() const { return now_; }

 private:
  std::atomic<double> now_{1000};
};

class FakeClock : public Clock {
 public:
  explicit FakeClock(std::shared_ptr<FakeTime> time) : time_(std::move(time)) {}
  Time now() const override { return time_->now(); }

 private:
  std::shared_ptr<FakeTime> time_;
};

/// The records of a MemoryJournal. They remain when the journal is destroyed, as files on a disk
/// remain over a restart. Thread-safe.
class JournalDisk {
 public:
  /// Appends and rewrites fail until `mend`.
  void break_it() EXCLUDES(mutex_) {
    MutexLock lock(mutex_);
    broken_ = true;
  }
  void mend() EXCLUDES(mutex_) {
    MutexLock lock(mutex_);
    broken_ = false;
    breaks_after_ = -1;
  }
  /// After `appends` more appends, all later appends fail until `mend`.
  void break_after(int appends) EXCLUDES(mutex_) {
    MutexLock lock(mutex_);
    breaks_after_ = appends;
  }
  /// Appends fail while `holds` returns true. nullptr removes the condition.
  void refuse_while(std::function<bool()> holds) EXCLUDES(mutex_) {
    MutexLock lock(mutex_);
    refuse_while_ = std::move(holds);
  }
  absl::Status rewrite(absl::Span<const Record> records) EXCLUDES(mutex_) {
    MutexLock lock(mutex_);
    if (broken_) {
      return absl::ResourceExhaustedError("the journal's disk is full");
    }
    records_.assign(records.begin(), records.end());
    return absl::OkStatus();
  }
  std::vector<Record> records() EXCLUDES(mutex_) {
    MutexLock lock(mutex_);
    return records_;
  }
  std::size_t size() EXCLUDES(mutex_) {
    MutexLock lock(mutex_);
    return records_.size();
  }
  absl::Status append(absl::Span<const Record> records) EXCLUDES(mutex_) {
    MutexLock lock(mutex_);
    if (breaks_after_ == 0) {
      broken_ = true;
    }
    --breaks_after_;
    if (broken_ || (refuse_while_ && refuse_while_())) {
      return absl::ResourceExhaustedError("the journal's disk is full");
    }
    records_.insert(records_.end(), records.begin(), records.end());
    return absl::OkStatus();
  }

 private:
  Mutex mutex_;
  std::vector<Record> records_ GUARDED_BY(mutex_);
  bool broken_ GUARDED_BY(mutex_) = false;
  int breaks_after_ GUARDED_BY(mutex_) = -1;
  std::function<bool()> refuse_while_ GUARDED_BY(mutex_);
};

class MemoryJournal : public Journal {
 public:
  explicit MemoryJournal(std::shared_ptr<JournalDisk> disk) : disk_(std::move(disk)) {}
  absl::Status append(absl::Span<const Record> records) override {
    return records.empty() ? absl::OkStatus() : disk_->append(records);
  }
  absl::Status replay(absl::FunctionRef<void(const Record&)> each) override {
    for (const Record& record : disk_->records()) {
      each(record);
    }
    return absl::OkStatus();
  }
  absl::Status rewrite(absl::Span<const Record> records) override {
    return disk_->rewrite(records);
  }
  std::uint64_t size() const override { return disk_->size(); }

 private:
  std::shared_ptr<JournalDisk> disk_;
};

}  // namespace bandsaw::coordinator
