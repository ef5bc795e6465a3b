// received() checks a message and forwards it to the engine. send() queues a message for the
// worker. When the transport is free, advance() gives it the next message of the queue.

#include "coordinator/rpc/worker_session.h"

#include "absl/strings/str_cat.h"
#include "coordinator/rpc/checked_messages.h"
#include "proto/convert/render_values.h"
#include "renderlib/base/status_macros.h"

namespace bandsaw::coordinator {
namespace {

farm::ToWorker to_message(const action::Welcome& welcome, const std::string& epoch) {
  farm::ToWorker message;
  message.mutable_welcome()->set_name(welcome.name);
  message.mutable_welcome()->set_heartbeat_ms(welcome.heartbeat_ms);
  message.mutable_welcome()->set_epoch(epoch);
  return message;
}

farm::ToWorker to_message(const action::Refuse& refuse) {
  farm::ToWorker message;
  message.mutable_refused()->set_reason(refuse.reason);
  message.mutable_refused()->set_retry_after_ms(refuse.retry_after_ms);
  return message;
}

absl::StatusOr<farm::ToWorker> to_message(const action::Lease& lease) {
  ASSIGN_OR_RETURN(const wire::Digest manifest, wire::digest_from_hex(lease.manifest));
  farm::ToWorker message;
  farm::Lease* l = message.mutable_lease();
  l->set_lease(lease.lease);
  l->set_job(lease.job);
  l->set_manifest_sha256(manifest.raw());
  *l->mutable_settings() = bandsaw::to_message(lease.settings);
  *l->mutable_band() = bandsaw::to_message(lease.band);
  for (const std::uint32_t number : lease.tiles.numbers()) {
    l->add_tile_samples(number);
  }
  l->set_attempt(lease.attempt);
  return message;
}

farm::ToWorker to_message(const action::Revoke& revoke) {
  farm::ToWorker message;
  for (const LeaseId lease : revoke.leases) {
    message.mutable_revoke()->add_lease(lease);
  }
  return message;
}

}  // namespace

void WorkerSession::over() {
  if (!session_) {
    return;
  }
  std::string reason = "it disconnected";
  {
    MutexLock lock(mutex_);
    if (end_ && !end_->ok()) {
      reason = std::string(end_->message());
    }
  }
  engine_.lost(*session_, std::move(reason));
}

void WorkerSession::received(const farm::FromWorker& message,
                             const std::shared_ptr<WorkerLink>& self) {
  if (const absl::Status status = forward(message, self); !status.ok()) {
    end_after_queue(status);
    return;
  }
  MutexLock lock(mutex_);
  if (!finished_) {
    read_next();
  }
}

absl::Status WorkerSession::forward(const farm::FromWorker& message,
                                    const std::shared_ptr<WorkerLink>& self) {
  if (message.has_hello() == session_.has_value()) {
    return absl::InvalidArgumentError("hello: must be the first message, and only the first");
  }
  switch (message.kind_case()) {
    case farm::FromWorker::kHello: {
      ASSIGN_OR_RETURN(WorkerHello hello, worker_hello(message.hello(), peer_));
      hello.browser = browser_;
      session_ = engine_.hello(self, std::move(hello));
      return absl::OkStatus();
    }
    case farm::FromWorker::kHeartbeat: {
      ASSIGN_OR_RETURN(input::Heartbeat beat, heartbeat(message.heartbeat()));
      engine_.heartbeat(*session_, std::move(beat.leases), std::move(beat.doing));
      return absl::OkStatus();
    }
    case farm::FromWorker::kFailed: {
      ASSIGN_OR_RETURN(input::BandFailed failed, band_failed(message.failed()));
      engine_.band_failed(*session_, failed.lease, std::move(failed.reason), std::move(failed.log));
      return absl::OkStatus();
    }
    case farm::FromWorker::kDraining: {
      ASSIGN_OR_RETURN(std::string reason,
                       reason_field("draining.reason", message.draining().reason()));
      engine_.draining(*session_, std::move(reason));
      return absl::OkStatus();
    }
    case farm::FromWorker::kLog: {
      ASSIGN_OR_RETURN(std::vector<std::string> lines, log_lines("log.line", message.log().line()));
      engine_.worker_log(*session_, std::move(lines));
      return absl::OkStatus();
    }
    case farm::FromWorker::KIND_NOT_SET:
      break;
  }
  return absl::InvalidArgumentError("kind: unknown; this worker is newer than the coordinator");
}

void WorkerSession::sent(bool ok) {
  MutexLock lock(mutex_);
  writing_ = false;
  outgoing_.pop_front();
  if (!ok) {
    outgoing_.clear();
    if (!end_) {
      end_ = absl::CancelledError("the connection broke");
    }
  }
  advance();
}

void WorkerSession::welcome(const action::Welcome& welcome, const std::string& epoch) {
  send(to_message(welcome, epoch));
}

void WorkerSession::refuse(const action::Refuse& refuse) {
  send(to_message(refuse));
  end_after_queue(absl::OkStatus());
}

void WorkerSession::lease(const action::Lease& lease) {
  absl::StatusOr<farm::ToWorker> message = to_message(lease);
  if (message.ok()) {
    send(*std::move(message));
  } else {
    end_now(absl::InternalError(message.status().message()));
  }
}

void WorkerSession::revoke(const action::Revoke& revoke) { send(to_message(revoke)); }

void WorkerSession::send(farm::ToWorker message) {
  MutexLock lock(mutex_);
  if (end_) {
    return;
  }
  if (outgoing_.size() < kMaxQueued) {
    outgoing_.push_back(std::move(message));
  } else {
    outgoing_.resize(1);  // the message that is being written
    end_ = absl::ResourceExhaustedError(
        absl::StrCat("it does not read the messages that are sent to it: ", kMaxQueued, " wait"));
  }
  advance();
}

void WorkerSession::end_after_queue(const absl::Status& status) {
  MutexLock lock(mutex_);
  if (!end_) {
    end_ = status;
  }
  advance();
}

void WorkerSession::end_now(const absl::Status& status) {
  MutexLock lock(mutex_);
  if (!end_) {
    end_ = status;
  }
  outgoing_.resize(writing_ ? 1 : 0);
  advance();
}

void WorkerSession::advance() {
  if (writing_ || finished_) {
    return;
  }
  if (!outgoing_.empty()) {
    writing_ = true;
    write(outgoing_.front());
  } else if (end_) {
    finished_ = true;
    finish(*end_);
  }
}

}  // namespace bandsaw::coordinator
