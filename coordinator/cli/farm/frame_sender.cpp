// A thread imports one frame after the other, uploads its package and adds the frame to the
// sequence. It uses a client of its own, so that stop() can end its calls.

#include "coordinator/cli/farm/frame_sender.h"

#include <span>
#include <utility>

#include "absl/strings/str_cat.h"
#include "coordinator/cli/farm/call_with_retries.h"
#include "coordinator/cli/farm/upload.h"
#include "proto/wire/digest.h"
#include "renderlib/base/status_macros.h"

namespace bandsaw::coordinator {
namespace {

/// Makes one attempt of send_frame().
absl::Status try_to_send(FarmClient& client, JobId sequence, FrameNumber frame,
                         ImportedPackage& package, ProgressDisplay& display) {
  RETURN_IF_ERROR(upload(client, package, display));
  const wire::Digest manifest = wire::sha256(package.manifest());
  absl::Status status = client.add_frame(sequence, frame, manifest);
  if (absl::IsFailedPrecondition(status)) {
    // A part of the package is missing: the farm may have removed it after it was sent, because no
    // job used it.
    RETURN_IF_ERROR(upload(client, package, display));
    status = client.add_frame(sequence, frame, manifest);
  }
  return status;
}

}  // namespace

absl::Status send_frame(FarmClient& client, JobId sequence, FrameNumber frame,
                        ImportedPackage& package, ProgressDisplay& display) {
  const absl::Status status = call_with_retries(
      client, [&] { return try_to_send(client, sequence, frame, package, display); });
  if (absl::IsFailedPrecondition(status)) {
    const auto progress = call_with_retries(client, [&] { return client.job(sequence); });
    if (progress.ok() && is_final(progress->job.state)) {
      return absl::AbortedError(status.message());
    }
  }
  return client.stopped() ? absl::CancelledError("interrupted") : status;
}

FrameSender::FrameSender(const FarmClient& client, const Console& console, JobId sequence,
                         std::vector<FrameNumber> frames, ImportFrame import,
                         std::function<void()> failed)
    : client_(client.another()),
      sequence_(sequence),
      frames_(std::move(frames)),
      import_(std::move(import)),
      failed_(std::move(failed)),
      display_(console, {.quiet = true}),
      thread_([this] { run(); }) {}

FrameSender::~FrameSender() {
  stop();
  wait().IgnoreError();
}

void FrameSender::stop() {
  stop_ = true;
  client_->stop();
}

absl::Status FrameSender::wait() {
  if (thread_.joinable()) {
    thread_.join();
  }
  MutexLock lock(mutex_);
  return status_;
}

std::vector<FrameNumber> FrameSender::unsent() const {
  MutexLock lock(mutex_);
  return {frames_.begin() + static_cast<std::ptrdiff_t>(sent_), frames_.end()};
}

void FrameSender::run() {
  for (const FrameNumber frame : frames_) {
    const absl::Status status = stop_ ? absl::CancelledError("interrupted") : send(frame);
    if (!status.ok()) {
      {
        MutexLock lock(mutex_);
        status_ =
            absl::Status(status.code(), absl::StrCat("frame ", frame, ": ", status.message()));
      }
      if (!absl::IsAborted(status)) {
        failed_();
      }
      return;
    }
    MutexLock lock(mutex_);
    ++sent_;
  }
}

absl::Status FrameSender::send(FrameNumber frame) {
  ASSIGN_OR_RETURN(ImportedPackage package, import_(frame, stop_));
  return send_frame(*client_, sequence_, frame, package, display_);
}

}  // namespace bandsaw::coordinator
