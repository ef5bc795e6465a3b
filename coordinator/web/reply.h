#pragma once

// Messages to JSON and back, statuses to HTTP.

#include <google/protobuf/message.h>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "coordinator/engine/blocking_call.h"
#include "coordinator/web/http.h"

namespace bandsaw::coordinator {

/// The longest body of a request that carries no scene.
inline constexpr std::size_t kMaxJsonBytes = 64 << 10;

/// The message as JSON.
HttpReply reply(const google::protobuf::Message& message);
/// A web::Problem, with the HTTP status that fits. The status MUST be an error.
HttpReply refuse(const absl::Status& status);

/// The one or the other.
template <class Message>
HttpReply answer(const absl::StatusOr<Message>& message) {
  return message.ok() ? reply(*message) : refuse(message.status());
}

/// Reads the body as a message. INVALID_ARGUMENT: it is longer than kMaxJsonBytes, does not come
/// whole, or is not of the message's form.
absl::Status read_json(const HttpBody& body, google::protobuf::Message& message);

}  // namespace bandsaw::coordinator
