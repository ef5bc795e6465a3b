// At most one state of the job waits to be sent. While a state is being sent, each new state
// replaces the state that waits.

#include "coordinator/rpc/watch_call.h"

#include "coordinator/convert/farm_messages.h"

namespace bandsaw::coordinator {

void WatchCall::begin() {
  if (const absl::Status status = deps_.streams.add(weak_from_this()); !status.ok()) {
    stop(status);
    return;
  }
  deps_.engine.watch(job_, [self = shared_from_this()](const absl::StatusOr<JobView>& job) {
    return self->changed(job);
  });
}

bool WatchCall::changed(const absl::StatusOr<JobView>& job) {
  MutexLock lock(mutex_);
  if (end_) {
    return false;
  }
  if (!job.ok()) {
    end_ = job.status();
  } else {
    next_ = to_message(*job);
    if (is_final(job->state)) {
      end_ = absl::OkStatus();
    }
  }
  advance();
  return !end_.has_value();
}

void WatchCall::OnWriteDone(bool ok) {
  MutexLock lock(mutex_);
  writing_ = false;
  if (!ok) {
    next_.reset();
    end_ = absl::CancelledError("the client disconnected");
  }
  advance();
}

void WatchCall::stop(const absl::Status& why) {
  MutexLock lock(mutex_);
  if (!end_) {
    next_.reset();
    end_ = why;
  }
  advance();
}

void WatchCall::advance() {
  if (writing_ || finished_) {
    return;
  }
  if (next_) {
    sending_ = *std::move(next_);
    next_.reset();
    writing_ = true;
    StartWrite(&sending_);
  } else if (end_) {
    finished_ = true;
    Finish(link::to_grpc(*end_));
  }
}

}  // namespace bandsaw::coordinator
