#pragma once

// Converts protobuf messages to JSON and back, and error statuses to HTTP responses.

#include <google/protobuf/message.h>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "coordinator/engine/blocking_call.h"
#include "coordinator/web/http.h"

namespace bandsaw::coordinator {

/// Maximum size of a request's body, except for scenes and their files.
inline constexpr std::size_t kMaxJsonBytes = 64 << 10;

/// Returns a response with the message as JSON.
HttpReply reply(const google::protobuf::Message& message);
/// Returns a web::Problem with the corresponding HTTP status. The status MUST be an error.
HttpReply refuse(const absl::Status& status);

/// Returns the message as JSON, or the error as a web::Problem.
template <class Message>
HttpReply answer(const absl::StatusOr<Message>& message) {
  return message.ok() ? reply(*message) : refuse(message.status());
}

/// Parses the body as a message. INVALID_ARGUMENT: it is longer than `most` bytes, incomplete, or
/// not JSON of this message.
absl::Status read_json(const HttpBody& body, google::protobuf::Message& message,
                       std::size_t most = kMaxJsonBytes);

}  // namespace bandsaw::coordinator
