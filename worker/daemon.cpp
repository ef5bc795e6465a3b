#include "worker/daemon.h"

#include <spdlog/spdlog.h>

#include <thread>

#include "proto/wire/limits.h"
#include "renderlib/base/status_macros.h"
#include "worker/executor/backoff.h"
#include "worker/session/desk.h"
#include "worker/session/farm_calls.h"
#include "worker/workshop.h"

namespace bandsaw::worker {
namespace {

constexpr std::chrono::milliseconds kConnectTime{5'000};

using SessionStream = grpc::ClientReaderWriter<farm::FromWorker, farm::ToWorker>;

bool is_refused_for_good(const absl::Status& status) {
  return absl::IsUnauthenticated(status) || absl::IsPermissionDenied(status);
}

/// Differs between workers; nothing but waiting times depends on it.
std::uint64_t seed_of(const Self& self) { return std::hash<std::string>()(self.instance); }

}  // namespace

class Daemon::Impl {
 public:
  Impl(DaemonOptions options, std::unique_ptr<BlobCache> cache)
      : options_(std::move(options)),
        calls_(options_.join),
        desk_(options_.self),
        backoff_(seed_of(options_.self)),
        workshop_(desk_, std::move(cache), static_cast<int>(options_.self.threads), options_.kernel,
                  doors(), options_.log_tail, seed_of(options_.self) + 1) {}
  ~Impl() { leave(); }

  absl::Status run();
  void drain(const std::string& reason) {
    spdlog::info("draining: {}", reason);
    desk_.drain(reason);
  }
  void leave() {
    desk_.leave();
    calls_.leave();
  }

 private:
  absl::Status talk(const link::Connected& connected);
  void write_all(SessionStream& stream, Outbox& outbox);
  bool write_log(SessionStream& stream);
  void handle(const farm::ToWorker& message, const std::string& address);
  void log_loss(const absl::Status& status);

  FarmDoors doors() {
    return {
        .get_blob = [this](const wire::Digest& digest, std::uint64_t offset,
                           const TakeBytes& take) { return calls_.get_blob(digest, offset, take); },
        .put_band =
            [this](const FinishedBand& band, const LeaseName& lease) {
              return calls_.put_band(band, options_.self.instance, lease);
            }};
  }

  const DaemonOptions options_;
  FarmCalls calls_;
  Desk desk_;
  // run()'s own.
  Backoff backoff_;
  std::optional<Away> away_;
  std::string last_loss_;
  std::string epoch_;  ///< names the life of the coordinator that welcomed it last
  bool joined_ = false;
  Workshop workshop_;  ///< last: its threads use the calls and the desk
};

absl::Status Daemon::Impl::run() {
  while (true) {
    absl::StatusOr<link::Connected> connected = link::connect(options_.join, kConnectTime);
    const absl::Status status = connected.ok() ? talk(*connected) : connected.status();
    if (desk_.over() || (away_ && away_->for_ever)) {
      return absl::OkStatus();
    }
    if (is_refused_for_good(status) && !desk_.was_welcomed()) {
      return status;
    }
    log_loss(status);
    const auto wait = away_ ? away_->wait : std::chrono::milliseconds(0);
    away_.reset();
    desk_.pause(std::max(wait, backoff_.next()));
    if (desk_.over()) {
      return absl::OkStatus();
    }
  }
}

absl::Status Daemon::Impl::talk(const link::Connected& connected) {
  FarmCalls::Context context(calls_, std::chrono::milliseconds(0));
  calls_.set_channel(connected.bulk);
  const std::shared_ptr<Outbox> outbox = desk_.open_stream();
  const std::unique_ptr<farm::Work::Stub> stub = farm::Work::NewStub(connected.control);
  const std::unique_ptr<SessionStream> stream = stub->Session(context.get());
  std::thread writer([&] { write_all(*stream, *outbox); });
  farm::ToWorker message;
  while (stream->Read(&message)) {
    handle(message, connected.address);
  }
  outbox->close();
  writer.join();
  const absl::Status status = link::from_grpc(stream->Finish());
  desk_.close_stream();
  calls_.set_channel(nullptr);
  return status;
}

void Daemon::Impl::write_all(SessionStream& stream, Outbox& outbox) {
  farm::FromWorker message;
  while (true) {
    const Outbox::Next next = outbox.next(desk_.heartbeat_interval(), message);
    if (next == Outbox::Next::kClosed) {
      stream.WritesDone();
      return;
    }
    if (next == Outbox::Next::kHeartbeat) {
      std::optional<farm::FromWorker> beat = desk_.heartbeat();
      if (!beat) {
        continue;
      }
      message = *std::move(beat);
    }
    if (!stream.Write(message)) {
      return;  // the reader learns why
    }
    if (next == Outbox::Next::kHeartbeat && !write_log(stream)) {
      return;
    }
  }
}

bool Daemon::Impl::write_log(SessionStream& stream) {
  const std::vector<std::string> lines =
      options_.new_log_lines ? options_.new_log_lines(wire::kLogLines) : std::vector<std::string>();
  return lines.empty() || stream.Write(log_message(lines));
}

void Daemon::Impl::handle(const farm::ToWorker& message, const std::string& address) {
  const Reaction reaction = desk_.receive(message);
  if (message.has_welcome()) {
    backoff_.reset();
    last_loss_.clear();
    workshop_.connected();
    spdlog::info("joined {} as {}", address, desk_.name());
    if (!joined_ && options_.joined) {
      options_.joined(address, desk_.name());
    }
    if (joined_ && message.welcome().epoch() != epoch_ && options_.log_lines_lost) {
      options_.log_lines_lost();
    }
    epoch_ = message.welcome().epoch();
    joined_ = true;
  }
  for (const TaskId task : reaction.stop) {
    workshop_.stop(task);
  }
  if (!reaction.stop.empty()) {
    spdlog::info("{} bands are not wanted any more", reaction.stop.size());
  }
  for (const Task& task : reaction.start) {
    workshop_.start(task);
  }
  if (reaction.away) {
    spdlog::warn("sent away: {}", reaction.away->reason);
    away_ = reaction.away;
  }
}

void Daemon::Impl::log_loss(const absl::Status& status) {
  const std::string why = status.ok() ? "the stream ended" : std::string(status.message());
  if (why != last_loss_) {  // one line for an outage, not one for each try
    spdlog::warn("{}; trying again until it answers", why);
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
