#pragma once

// Repeats a call to the farm while the farm cannot be reached, so that commands outlast a restart
// of the coordinator.

#include <chrono>
#include <cstdint>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "coordinator/cli/farm/farm_client.h"
#include "coordinator/engine/clock.h"

namespace bandsaw::coordinator {

/// Returns the status of a result that is a Status or a StatusOr.
inline const absl::Status& status_of(const absl::Status& status) { return status; }
template <class T>
const absl::Status& status_of(const absl::StatusOr<T>& result) {
  return result.status();
}

/// Time for which commands wait for a farm that cannot be reached, and the pause between attempts.
inline constexpr double kMaxRetry_s = 60;
inline constexpr std::chrono::milliseconds kUnreachablePause{200};

/// Repeats `call`, which returns a Status or a StatusOr, while its result is UNAVAILABLE: the farm
/// cannot be reached. Gives up after kMaxRetry_s, or when client.stop() is called. Returns the last
/// result. Calls wait_for_farm(), because gRPC reconnects only while a client waits for the
/// connection.
template <class Call>
auto call_with_retries(FarmClient& client, Call call) {
  const double until = steady_seconds() + kMaxRetry_s;
  auto result = call();
  while (absl::IsUnavailable(status_of(result))) {
    const double left = until - steady_seconds();
    if (left <= 0 ||
        !client.wait_for_farm(std::chrono::milliseconds(static_cast<std::int64_t>(left * 1000)))) {
      break;
    }
    client.pause(kUnreachablePause);
    result = call();
  }
  return result;
}

}  // namespace bandsaw::coordinator
