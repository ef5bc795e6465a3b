#include "coordinator/rpc/session_call.h"

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

void SessionCall::begin() {
  if (const absl::Status status = deps_.streams.add(weak_from_this()); !status.ok()) {
    stop(status);
    return;
  }
  StartRead(&incoming_);
}

void SessionCall::done() {
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
  deps_.engine.lost(*session_, std::move(reason));
}

void SessionCall::OnReadDone(bool ok) {
  if (!ok) {
    end_with(absl::OkStatus());
    return;
  }
  if (const absl::Status status = receive(incoming_); !status.ok()) {
    end_with(status);
    return;
  }
  MutexLock lock(mutex_);
  if (!finished_) {
    StartRead(&incoming_);
  }
}

absl::Status SessionCall::receive(const farm::FromWorker& message) {
  if (message.has_hello() == session_.has_value()) {
    return absl::InvalidArgumentError("hello: must be the first message, and only the first");
  }
  switch (message.kind_case()) {
    case farm::FromWorker::kHello: {
      ASSIGN_OR_RETURN(WorkerHello hello, worker_hello(message.hello(), peer_));
      session_ = deps_.engine.hello(shared_from_this(), std::move(hello));
      return absl::OkStatus();
    }
    case farm::FromWorker::kHeartbeat: {
      ASSIGN_OR_RETURN(input::Heartbeat beat, heartbeat(message.heartbeat()));
      deps_.engine.heartbeat(*session_, std::move(beat.leases), std::move(beat.doing));
      return absl::OkStatus();
    }
    case farm::FromWorker::kFailed: {
      ASSIGN_OR_RETURN(input::BandFailed failed, band_failed(message.failed()));
      deps_.engine.band_failed(*session_, failed.lease, std::move(failed.reason),
                               std::move(failed.log));
      return absl::OkStatus();
    }
    case farm::FromWorker::kDraining: {
      ASSIGN_OR_RETURN(std::string reason,
                       reason_field("draining.reason", message.draining().reason()));
      deps_.engine.draining(*session_, std::move(reason));
      return absl::OkStatus();
    }
    case farm::FromWorker::kLog: {
      ASSIGN_OR_RETURN(std::vector<std::string> lines, log_lines("log.line", message.log().line()));
      deps_.engine.worker_log(*session_, std::move(lines));
      return absl::OkStatus();
    }
    case farm::FromWorker::KIND_NOT_SET:
      break;
  }
  return absl::InvalidArgumentError("kind: unknown; this worker is newer than the coordinator");
}

void SessionCall::OnWriteDone(bool ok) {
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

void SessionCall::welcome(const action::Welcome& welcome, const std::string& epoch) {
  send(to_message(welcome, epoch));
}

void SessionCall::refuse(const action::Refuse& refuse) {
  send(to_message(refuse));
  end_with(absl::OkStatus());
}

void SessionCall::lease(const action::Lease& lease) {
  absl::StatusOr<farm::ToWorker> message = to_message(lease);
  if (message.ok()) {
    send(*std::move(message));
  } else {
    stop(absl::InternalError(message.status().message()));
  }
}

void SessionCall::revoke(const action::Revoke& revoke) { send(to_message(revoke)); }

void SessionCall::send(farm::ToWorker message) {
  MutexLock lock(mutex_);
  if (!end_) {
    outgoing_.push_back(std::move(message));
    advance();
  }
}

void SessionCall::end_with(const absl::Status& status) {
  MutexLock lock(mutex_);
  if (!end_) {
    end_ = status;
  }
  advance();
}

void SessionCall::stop(const absl::Status& why) {
  MutexLock lock(mutex_);
  if (!end_) {
    end_ = why;
  }
  outgoing_.resize(writing_ ? 1 : 0);
  advance();
}

void SessionCall::advance() {
  if (writing_ || finished_) {
    return;
  }
  if (!outgoing_.empty()) {
    writing_ = true;
    StartWrite(&outgoing_.front());
  } else if (end_) {
    finished_ = true;
    Finish(link::to_grpc(*end_));
  }
}

}  // namespace bandsaw::coordinator
