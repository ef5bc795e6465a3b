// A worker's bands (the pixels of some rows and samples) arrive one after the other, each in
// chunks. A complete band is handed over to the engine. Until the answer of the engine has been
// written to the worker, nothing is read, and the call cannot end. Then the next band is read.

#include "coordinator/rpc/put_bands_call.h"

#include <utility>

#include "coordinator/rpc/blob_intake.h"
#include "coordinator/rpc/checked_messages.h"
#include "renderlib/base/status_macros.h"

namespace bandsaw::coordinator {
void PutBandsCall::begin() {
  if (const absl::Status status = deps_.streams.add(weak_from_this()); !status.ok()) {
    stop(status);
    return;
  }
  StartRead(&chunk_);
}

void PutBandsCall::OnReadDone(bool ok) {
  if (!ok) {
    stop(intake_.cut() ? cut_short(intake_.received(), intake_.header().size()) : absl::OkStatus());
  } else if (const absl::Status status = take(chunk_); !status.ok()) {
    stop(status);
  }
}

absl::Status PutBandsCall::take(const farm::BandChunk& chunk) {
  RETURN_IF_ERROR(intake_.add(chunk));
  if (!intake_.whole()) {
    read_next();
    return absl::OkStatus();
  }
  BandIntake whole = std::exchange(intake_, BandIntake(deps_.engine.bands()));
  if (hand_over()) {
    whole.put(
        deps_.engine,
        [self = shared_from_this()](const absl::StatusOr<BandOutcome>& outcome) {
          self->answer(outcome);
        },
        /*browser=*/false);
  }
  return absl::OkStatus();
}

void PutBandsCall::read_next() {
  MutexLock lock(mutex_);
  if (!finished_) {
    StartRead(&chunk_);
  }
}

bool PutBandsCall::hand_over() {
  MutexLock lock(mutex_);
  handed_over_ = !finished_;
  return handed_over_;
}

void PutBandsCall::answer(const absl::StatusOr<BandOutcome>& outcome) {
  MutexLock lock(mutex_);
  if (outcome.ok()) {
    reply_.set_outcome(to_message(*outcome));
    StartWrite(&reply_);
    return;
  }
  handed_over_ = false;
  end_ = outcome.status();
  advance();
}

void PutBandsCall::OnWriteDone(bool ok) {
  MutexLock lock(mutex_);
  handed_over_ = false;
  if (!ok && !end_) {
    end_ = absl::CancelledError("the connection broke");
  }
  if (end_) {
    advance();
  } else {
    StartRead(&chunk_);
  }
}

void PutBandsCall::stop(const absl::Status& why) {
  MutexLock lock(mutex_);
  if (!end_) {
    end_ = why;
  }
  advance();
}

void PutBandsCall::advance() {
  if (end_ && !handed_over_ && !finished_) {
    finished_ = true;
    Finish(link::to_grpc(*end_));
  }
}

}  // namespace bandsaw::coordinator
