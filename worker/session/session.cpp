// receive() calls one function for each kind of message. A band is found by its task id or, for
// messages of the coordinator, by its lease id.

#include "worker/session/session.h"

#include <algorithm>

#include "absl/strings/ascii.h"
#include "absl/strings/str_cat.h"
#include "proto/convert/render_values.h"
#include "proto/wire/limits.h"
#include "proto/wire/versions.h"
#include "renderlib/base/clean_text.h"
#include "renderlib/render/work_hash.h"
#include "worker/session/lease_task.h"

namespace bandsaw::worker {
namespace {

/// Makes text acceptable to the coordinator: bounded, UTF-8, on one line.
std::string plain(absl::string_view text, std::size_t most) {
  std::string line(absl::StripAsciiWhitespace(text));
  std::replace_if(line.begin(), line.end(), absl::ascii_iscntrl, ' ');
  return clean_text(line, most);
}

/// Returns the message that the band of a lease failed, with the last lines of `log`.
farm::FromWorker failure(std::uint64_t lease, const std::string& reason,
                         const std::vector<std::string>& log) {
  farm::FromWorker message;
  farm::BandFailed* failed = message.mutable_failed();
  failed->set_lease(lease);
  failed->set_reason(plain(reason, wire::kReasonBytes));
  const std::size_t first = log.size() - std::min(log.size(), wire::kLogLines);
  for (std::size_t i = first; i < log.size(); ++i) {
    failed->add_log(plain(log[i], wire::kLogLineBytes));
  }
  return message;
}

}  // namespace

farm::FromWorker log_message(const std::vector<std::string>& lines) {
  farm::FromWorker message;
  for (const std::string& line : lines) {
    message.mutable_log()->add_line(plain(line, wire::kLogLineBytes));
  }
  return message;
}

Session::Session(WorkerInfo info) : info_(std::move(info)) {}

farm::FromWorker Session::hello() const {
  farm::FromWorker message;
  farm::Hello* hello = message.mutable_hello();
  hello->set_protocol(wire::kProtocol);
  hello->set_pixel_version(info_.pixel_version);
  hello->set_canary(info_.canary);
  hello->set_instance(info_.instance);
  hello->set_name(info_.name);
  hello->set_threads(info_.threads);
  hello->set_max_bands(info_.max_bands);
  hello->set_build(info_.build);
  hello->set_memory_bytes(info_.memory_bytes);
  for (const Held& held : held_) {
    farm::Held* h = hello->add_held();
    h->set_job(held.task.job);
    *h->mutable_band() = to_message(held.task.band);
    h->set_lease(held.name.lease);
    h->set_epoch(held.name.epoch);
    h->set_finished(held.stage == Stage::kFinished);
    h->set_work(work_hash(held.task.manifest.hex(), held.task.settings));
  }
  return message;
}

SessionEffects Session::receive(const farm::ToWorker& message) {
  SessionEffects effects;
  switch (message.kind_case()) {
    case farm::ToWorker::kWelcome:
      take_welcome(message.welcome(), effects);
      break;
    case farm::ToWorker::kLease:
      take_lease(message.lease(), effects);
      break;
    case farm::ToWorker::kRevoke:
      take_revoke(message.revoke(), effects);
      break;
    case farm::ToWorker::kRefused:
      effects.dismissal =
          Dismissal{.reason = message.refused().reason(),
                    .wait = std::chrono::milliseconds(message.refused().retry_after_ms())};
      break;
    case farm::ToWorker::kBye:
      for (const Held& held : held_) {
        effects.stop.push_back(held.task.id);
      }
      held_.clear();
      effects.dismissal =
          Dismissal{.reason = message.bye().reason(),
                    .wait = std::chrono::milliseconds(message.bye().retry_after_ms()),
                    .for_ever = message.bye().retry_after_ms() == 0};
      break;
    case farm::ToWorker::KIND_NOT_SET:
      break;  // an optional message of a newer coordinator with the same protocol; ignored
  }
  return effects;
}

void Session::take_welcome(const farm::Welcome& welcome, SessionEffects& effects) {
  connected_ = true;
  name_ = welcome.name().empty() ? info_.name : welcome.name();
  epoch_ = welcome.epoch();
  // Bounded, because an interval of 0 would make the worker send heartbeats without a pause.
  heartbeat_ =
      std::chrono::milliseconds(std::clamp<std::uint32_t>(welcome.heartbeat_ms(), 50, 60'000));
  if (drain_reason_) {
    effects.send.push_back(draining_message());
  }
}

void Session::take_lease(const farm::Lease& lease, SessionEffects& effects) {
  absl::StatusOr<Task> task = task_of(lease);
  if (!task.ok()) {
    effects.send.push_back(failure(lease.lease(), std::string(task.status().message()), {}));
    return;
  }
  // The coordinator may answer Hello with a lease of a band that this worker holds. Rendering then
  // continues under the new lease id.
  const auto same = std::find_if(held_.begin(), held_.end(), [&](const Held& held) {
    return held.task.job == task->job && held.task.band == task->band;
  });
  if (same != held_.end()) {
    if (same->task.manifest == task->manifest && same->task.settings == task->settings) {
      same->name = {.lease = lease.lease(), .epoch = epoch_};
      return;
    }
    // The held band belonged to another job, which had the same number.
    effects.stop.push_back(same->task.id);
    held_.erase(same);
  }
  if (held_.size() >= wire::kBandsPerWorker) {
    effects.send.push_back(failure(lease.lease(), "this worker holds too many bands", {}));
    return;
  }
  task->id = ++last_task_;
  held_.push_back(Held{.task = *task, .name = {.lease = lease.lease(), .epoch = epoch_}});
  effects.start.push_back(*task);
}

void Session::take_revoke(const farm::Revoke& revoke, SessionEffects& effects) {
  for (const std::uint64_t lease : revoke.lease()) {
    // Ids are unique within an epoch only. So a lease of the current epoch with this id is looked
    // for first, and then a lease of an earlier epoch.
    auto meant = std::find_if(held_.begin(), held_.end(), [&](const Held& held) {
      return held.name.lease == lease && held.name.epoch == epoch_;
    });
    if (meant == held_.end()) {
      meant = std::find_if(held_.begin(), held_.end(),
                           [&](const Held& held) { return held.name.lease == lease; });
    }
    if (meant != held_.end()) {
      effects.stop.push_back(meant->task.id);
      held_.erase(meant);
    }
  }
}

farm::FromWorker Session::heartbeat() const {
  farm::FromWorker message;
  farm::Heartbeat* beat = message.mutable_heartbeat();
  beat->set_doing(doing());
  for (const Held& held : held_) {
    if (held.name.epoch != epoch_) {
      continue;  // the coordinator has not assigned an id to this band since it started
    }
    farm::LeaseProgress* progress = beat->add_lease();
    progress->set_lease(held.name.lease);
    progress->set_rows_done(held.rows_done);
    progress->set_prepared(held.prepared);
  }
  return message;
}

std::string Session::doing() const {
  const auto any = [this](Stage stage) {
    return std::any_of(held_.begin(), held_.end(),
                       [stage](const Held& held) { return held.stage == stage; });
  };
  return any(Stage::kRendering)   ? "rendering"
         : any(Stage::kPreparing) ? "fetching scene"
         : any(Stage::kFinished)  ? "sending pixels"
         : drain_reason_          ? "draining"
                                  : "idle";
}

Session::Held* Session::find(TaskId task) {
  const auto found = std::find_if(held_.begin(), held_.end(),
                                  [task](const Held& held) { return held.task.id == task; });
  return found == held_.end() ? nullptr : &*found;
}

void Session::preparing(TaskId task, std::uint64_t prepared) {
  if (Held* held = find(task)) {
    held->stage = Stage::kPreparing;
    held->prepared = std::max(held->prepared, prepared);
  }
}

bool Session::rendering(TaskId task, std::uint32_t rows_done) {
  Held* held = find(task);
  if (held == nullptr) {
    return false;
  }
  const bool first = held->stage != Stage::kRendering;
  held->stage = Stage::kRendering;
  if (rows_done == 0) {  // rendering has begun, or the preparation has done a step
    ++held->prepared;
  }
  held->rows_done = std::max(held->rows_done, rows_done);  // calls may arrive out of order
  return first;
}

bool Session::finished(TaskId task) {
  Held* held = find(task);
  if (held != nullptr) {
    held->stage = Stage::kFinished;
    held->rows_done = held->task.band.rows.count();
  }
  return held != nullptr;
}

std::optional<farm::FromWorker> Session::failed(TaskId task, const std::string& reason,
                                                const std::vector<std::string>& log) {
  const Held* held = find(task);
  if (held == nullptr) {
    return std::nullopt;
  }
  const LeaseName name = held->name;
  settled(task);
  if (!connected_ || name.epoch != epoch_) {
    return std::nullopt;
  }
  return failure(name.lease, reason, log);
}

void Session::settled(TaskId task) {
  std::erase_if(held_, [task](const Held& held) { return held.task.id == task; });
}

std::optional<LeaseName> Session::lease_of(TaskId task) const {
  for (const Held& held : held_) {
    if (held.task.id == task) {
      return held.name;
    }
  }
  return std::nullopt;
}

farm::FromWorker Session::draining_message() const {
  farm::FromWorker message;
  message.mutable_draining()->set_reason(plain(*drain_reason_, wire::kReasonBytes));
  return message;
}

std::optional<farm::FromWorker> Session::drain(const std::string& reason) {
  const bool first = !drain_reason_.has_value();
  drain_reason_ = reason;
  if (!first || !connected_) {
    return std::nullopt;
  }
  return draining_message();
}

void Session::offer(std::uint32_t threads, std::uint64_t memory_bytes) {
  info_.threads = threads;
  info_.memory_bytes = memory_bytes;
}

}  // namespace bandsaw::worker
