#pragma once

// Messages to JSON and back, statuses to HTTP.

#include <google/protobuf/message.h>
#include <httplib.h>

#include <memory>
#include <string>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"
#include "coordinator/engine/ask.h"

namespace bandsaw::coordinator {

/// No request but a scene has a longer body.
inline constexpr std::size_t kMostJson = 64 << 10;

void reply(httplib::Response& response, const google::protobuf::Message& message);
/// A Problem, with the HTTP status that fits. The status MUST be an error.
void refuse(httplib::Response& response, const absl::Status& status);

/// The one or the other.
template <class Message>
void answer(httplib::Response& response, const absl::StatusOr<Message>& message) {
  message.ok() ? reply(response, *message) : refuse(response, message.status());
}

/// A body that `bytes` holds, which lives as long as the answer or the copies of `held`. Sent in
/// pieces. What a Range header names beyond its end is not sent: httplib 0.11 checks none.
void send_bytes(httplib::Response& response, absl::string_view bytes, const char* type,
                std::shared_ptr<const void> held);

/// The body as a message. INVALID_ARGUMENT: too long, or not of its form.
absl::Status read_json(const httplib::ContentReader& reader, google::protobuf::Message& message);

}  // namespace bandsaw::coordinator
