// Parses the bytes of messages for worker::Session and serialises its answers.

#include "worker/browser/browser_session.h"

#include <algorithm>
#include <utility>

#include "absl/strings/ascii.h"
#include "absl/strings/str_cat.h"
#include "proto/convert/render_values.h"
#include "proto/wire/limits.h"
#include "renderlib/base/clean_text.h"
#include "renderlib/base/status_macros.h"
#include "worker/session/band_header.h"

namespace bandsaw::worker {
namespace {

constexpr std::size_t kInstanceDigits = 32;
constexpr std::size_t kBuildBytes = 200;  // for display only

std::string bytes_of(const std::optional<farm::FromWorker>& message) {
  return message ? message->SerializeAsString() : "";
}

/// Checks that a text of WorkerInfo has 1 to `most` bytes and no control characters. `name` names
/// the text in the error.
absl::Status check_text(const char* name, const std::string& text, std::size_t most) {
  if (text.empty() || clean_text(text, most) != text) {
    return absl::InvalidArgumentError(
        absl::StrCat(name, " must have 1 to ", most, " bytes of UTF-8 without control characters"));
  }
  return absl::OkStatus();
}

/// Returns the length as 4 bytes, little-endian.
std::string length_bytes(std::size_t length) {
  std::string bytes;
  for (int shift = 0; shift < 32; shift += 8) {
    bytes.push_back(static_cast<char>(length >> shift & 0xff));
  }
  return bytes;
}

}  // namespace

absl::StatusOr<BrowserSession> BrowserSession::create(WorkerInfo info) {
  const bool is_hex = std::all_of(info.instance.begin(), info.instance.end(), absl::ascii_isxdigit);
  if (info.instance.size() != kInstanceDigits || !is_hex) {
    return absl::InvalidArgumentError("the instance must have 32 hexadecimal digits");
  }
  RETURN_IF_ERROR(check_text("the name", info.name, wire::kWorkerNameBytes));
  RETURN_IF_ERROR(check_text("the build", info.build, kBuildBytes));
  if (info.threads < 1 || info.threads > wire::kThreadsPerWorker) {
    return absl::InvalidArgumentError(
        absl::StrCat("the cores must lie in [1, ", wire::kThreadsPerWorker, "]"));
  }
  return BrowserSession(std::move(info));
}

std::string BrowserSession::hello() const { return session_.hello().SerializeAsString(); }

void BrowserSession::offer(std::uint32_t threads, std::uint64_t memory_bytes) {
  session_.offer(std::clamp<std::uint32_t>(threads, 1, wire::kThreadsPerWorker), memory_bytes);
}

absl::StatusOr<BrowserOrders> BrowserSession::receive(const std::string& bytes) {
  farm::ToWorker message;
  if (!message.ParseFromString(bytes)) {
    return absl::InvalidArgumentError(
        "the coordinator sent bytes that are not a message of the protocol");
  }
  SessionEffects effects = session_.receive(message);
  BrowserOrders orders;
  orders.stop = std::move(effects.stop);
  orders.dismissal = std::move(effects.dismissal);
  for (const TaskId task : orders.stop) {
    held_.erase(task);
  }
  for (Task& task : effects.start) {  // at most one: a message has one lease
    held_[task.id] = {.task = task, .counters = {}};
    orders.start = BrowserBand{std::move(task), message.lease().SerializeAsString()};
  }
  for (const farm::FromWorker& answer : effects.send) {
    orders.send.push_back(answer.SerializeAsString());
  }
  return orders;
}

std::string BrowserSession::heartbeat() const { return session_.heartbeat().SerializeAsString(); }

absl::Status BrowserSession::rendering(TaskId task, std::uint32_t rows_done,
                                       const std::string& counters) {
  farm::Counters added;
  if (!added.ParseFromString(counters)) {
    return absl::InvalidArgumentError("the counters of the rows are not a message of the protocol");
  }
  session_.rendering(task, rows_done);
  if (const auto held = held_.find(task); held != held_.end()) {
    held->second.counters.add(counters_of(added));
  }
  return absl::OkStatus();
}

std::string BrowserSession::failed(TaskId task, const std::string& reason,
                                   const std::vector<std::string>& log) {
  held_.erase(task);
  return bytes_of(session_.failed(task, reason, log));
}

absl::StatusOr<std::string> BrowserSession::band_header(TaskId task, std::uint64_t size,
                                                        const wire::Digest& digest,
                                                        const RenderCost& cost) const {
  if (!session_.connected()) {
    return absl::UnavailableError("not connected");
  }
  const auto held = held_.find(task);
  const std::optional<LeaseName> lease = session_.lease_of(task);
  if (held == held_.end() || !lease) {
    return absl::NotFoundError("the band is not held any more");
  }
  const std::string header =
      worker::band_header(held->second.task, {.size = size, .digest = digest},
                          held->second.counters, cost, instance_, *lease)
          .SerializeAsString();
  return length_bytes(header.size()) + header;
}

absl::StatusOr<std::string> BrowserSession::band_reply(TaskId task, const std::string& bytes) {
  farm::PutBandReply reply;
  if (!reply.ParseFromString(bytes)) {
    return absl::InvalidArgumentError("the coordinator's answer to a band is no message");
  }
  drop(task);
  switch (reply.outcome()) {
    case farm::PutBandReply::OUTCOME_DUPLICATE:
      return "duplicate";
    case farm::PutBandReply::OUTCOME_UNWANTED:
      return "unwanted";
    default:
      return "stored";
  }
}

void BrowserSession::drop(TaskId task) {
  held_.erase(task);
  session_.settled(task);
}

std::string BrowserSession::drain(const std::string& reason) {
  return bytes_of(session_.drain(reason));
}

}  // namespace bandsaw::worker
