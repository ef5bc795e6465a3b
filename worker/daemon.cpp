// run() connects, talks until the stream ends, waits and connects again. talk() reads messages on
// the calling thread, while a second thread writes the send queue.

#include "worker/daemon.h"

#include <spdlog/spdlog.h>

#include <thread>

#include "proto/wire/limits.h"
#include "renderlib/base/status_macros.h"
#include "worker/band_pipeline.h"
#include "worker/executor/backoff.h"
#include "worker/log_queue.h"
#include "worker/session/farm_calls.h"
#include "worker/session/shared_session.h"

namespace bandsaw::worker {
namespace {

constexpr std::chrono::milliseconds kConnectTime{5'000};  // for one try to connect

using SessionStream = grpc::ClientReaderWriter<farm::FromWorker, farm::ToWorker>;

bool is_refused_for_good(const absl::Status& status) {
  return absl::IsUnauthenticated(status) || absl::IsPermissionDenied(status);
}

/// Returns a seed that differs between workers; it only affects waiting times.
std::uint64_t seed_of(const WorkerInfo& info) { return std::hash<std::string>()(info.instance); }

}  // namespace

class Daemon::Impl {
 public:
  Impl(DaemonOptions options, std::unique_ptr<BlobCache> cache)
      : options_(std::move(options)),
        calls_(options_.join, options_.info.instance),
        wrapped_calls_(options_.wrap_calls ? options_.wrap_calls(calls_) : nullptr),
        session_(options_.info),
        backoff_(seed_of(options_.info)),
        pipeline_(session_, std::move(cache), static_cast<int>(options_.info.threads),
                  options_.kernel, wrapped_calls_ ? *wrapped_calls_ : calls_, options_.log_tail,
                  seed_of(options_.info) + 1) {}
  ~Impl() { leave(); }

  absl::Status run();
  void drain(const std::string& reason) {
    spdlog::info("draining: {}", reason);
    session_.drain(reason);
  }
  void leave() {
    session_.leave();
    calls_.leave();
  }

 private:
  /// Keeps one stream until it ends. Returns why it ended.
  absl::Status talk(const link::Connected& connected);
  /// Writes messages, heartbeats and log lines until the queue is closed or the stream is broken.
  void write_all(SessionStream& stream, SendQueue& queue);
  /// Sends new lines of the log. Returns false if the stream is broken.
  bool write_log(SessionStream& stream);
  /// Updates the queue of log lines. If the message is Welcome, puts lines that may be lost back
  /// into the queue. Any other message, except Refused, means that the lines sent so far have
  /// arrived.
  void note_log(const farm::ToWorker& message);
  /// Passes a message of the coordinator at `address` to the session, and takes the actions that
  /// the session returns.
  void handle(const farm::ToWorker& message, const std::string& address);
  /// Logs why the connection was lost. An outage is logged once, not for each failed try.
  void log_loss(const absl::Status& status);

  const DaemonOptions options_;
  FarmCalls calls_;
  const std::unique_ptr<CoordinatorApi> wrapped_calls_;  ///< nullptr: calls_ is used
  SharedSession session_;
  // Used by run() only.
  Backoff backoff_;
  std::optional<Dismissal> dismissal_;
  std::string last_loss_;
  /// The coordinator's epoch (the id of its run) when it last admitted this worker.
  std::string epoch_;
  bool joined_ = false;
  BandPipeline pipeline_;  ///< last: its threads use the calls and the session
};

absl::Status Daemon::Impl::run() {
  while (true) {
    absl::StatusOr<link::Connected> connected =
        link::connect(options_.join, kConnectTime, [this] { return session_.over(); });
    const absl::Status status = connected.ok() ? talk(*connected) : connected.status();
    if (session_.over() || (dismissal_ && dismissal_->for_ever)) {
      return absl::OkStatus();
    }
    if (is_refused_for_good(status) && !session_.was_welcomed()) {
      return status;
    }
    log_loss(status);
    const auto wait = dismissal_ ? dismissal_->wait : std::chrono::milliseconds(0);
    dismissal_.reset();
    session_.pause(std::max(wait, backoff_.next()));
    if (session_.over()) {
      return absl::OkStatus();
    }
  }
}

absl::Status Daemon::Impl::talk(const link::Connected& connected) {
  FarmCalls::Context context(calls_, std::chrono::milliseconds(0));  // without a deadline
  calls_.set_channel(connected.bulk);
  const std::shared_ptr<SendQueue> queue = session_.open_stream();
  const std::unique_ptr<farm::Work::Stub> stub = farm::Work::NewStub(connected.control);
  const std::unique_ptr<SessionStream> stream = stub->Session(context.get());
  std::thread writer([&] { write_all(*stream, *queue); });
  farm::ToWorker message;
  while (stream->Read(&message)) {
    handle(message, connected.address);
  }
  queue->close();
  writer.join();
  const absl::Status status = link::from_grpc(stream->Finish());
  session_.close_stream();
  calls_.set_channel(nullptr);
  return status;
}

void Daemon::Impl::write_all(SessionStream& stream, SendQueue& queue) {
  farm::FromWorker message;
  while (true) {
    const SendQueue::Next next = queue.next(session_.heartbeat_interval(), message);
    if (next == SendQueue::Next::kClosed) {
      stream.WritesDone();
      return;
    }
    if (next == SendQueue::Next::kHeartbeat) {
      std::optional<farm::FromWorker> beat = session_.heartbeat();
      if (!beat) {
        continue;
      }
      message = *std::move(beat);
    }
    if (!stream.Write(message)) {
      return;  // the reading thread gets the reason from Finish
    }
    if (next == SendQueue::Next::kHeartbeat && !write_log(stream)) {
      return;
    }
  }
}

bool Daemon::Impl::write_log(SessionStream& stream) {
  const std::vector<std::string> lines =
      options_.log ? options_.log->take(wire::kLogLines) : std::vector<std::string>();
  return lines.empty() || stream.Write(log_message(lines));
}

void Daemon::Impl::note_log(const farm::ToWorker& message) {
  if (options_.log == nullptr) {
    return;
  }
  if (message.has_welcome()) {
    options_.log->again(message.welcome().epoch() != epoch_);
  } else if (!message.has_refused()) {  // on a refused stream, no lines were sent
    options_.log->arrived();
  }
}

void Daemon::Impl::handle(const farm::ToWorker& message, const std::string& address) {
  // note_log() must come first, because receive() of a Welcome lets write_all() send lines.
  note_log(message);
  const SessionEffects effects = session_.receive(message);
  if (message.has_welcome()) {
    backoff_.reset();
    last_loss_.clear();
    pipeline_.connected();
    spdlog::info("joined {} as {}", address, session_.name());
    if (!joined_ && options_.joined) {
      options_.joined(address, session_.name());
    }
    epoch_ = message.welcome().epoch();
    joined_ = true;
  }
  for (const TaskId task : effects.stop) {
    pipeline_.stop(task);
  }
  if (!effects.stop.empty()) {
    spdlog::info("{} bands are not wanted any more", effects.stop.size());
  }
  for (const Task& task : effects.start) {
    pipeline_.start(task);
  }
  if (effects.dismissal) {
    spdlog::warn("dismissed: {}", effects.dismissal->reason);
    dismissal_ = effects.dismissal;
  }
}

void Daemon::Impl::log_loss(const absl::Status& status) {
  const std::string why = status.ok() ? "the stream ended" : std::string(status.message());
  if (why != last_loss_) {
    spdlog::warn("{}; trying again until the coordinator answers", why);
    last_loss_ = why;
  }
}

Daemon::Daemon(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Daemon::~Daemon() = default;
absl::Status Daemon::run() { return impl_->run(); }
void Daemon::drain(const std::string& reason) { impl_->drain(reason); }
void Daemon::leave() { impl_->leave(); }

absl::StatusOr<std::unique_ptr<Daemon>> Daemon::create(DaemonOptions options) {
  ASSIGN_OR_RETURN(std::unique_ptr<BlobCache> cache,
                   BlobCache::open(options.cache_folder, options.cache_bytes));
  return std::unique_ptr<Daemon>(
      new Daemon(std::make_unique<Impl>(std::move(options), std::move(cache))));
}

}  // namespace bandsaw::worker
