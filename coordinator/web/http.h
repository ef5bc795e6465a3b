#pragma once

// An HTTP request and its answer as the dashboard's handlers see them. These types do not depend on
// the library that reads and writes them (exchange.cpp).

#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"

namespace bandsaw::coordinator {

/// A name and its value.
using HttpField = std::pair<std::string, std::string>;

struct HttpRequest {
  std::string method;                 ///< in capitals: "GET"
  std::string path;                   ///< percent-decoded, without the query
  std::vector<HttpField> parameters;  ///< of the query, decoded, in their order
  std::vector<HttpField> headers;     ///< in their order
  std::string captured;               ///< the part of the path that stands for "*" in its route
  std::string remote_address;         ///< numeric; empty: not known
  int local_port = 0;

  /// The value of the first header of this name, whose case does not matter; empty: there is none.
  std::string header(absl::string_view name) const;
  bool has_header(absl::string_view name) const;
  /// The decoded value of the first parameter of this name; empty: there is none.
  std::string parameter(absl::string_view name) const;
};

/// Sets path and parameters from a request's target, for example "/api/log?name=a%20b". A percent
/// sign that two hexadecimal digits do not follow stands for itself.
void parse_target(absl::string_view target, HttpRequest& request);

/// Reads the body of a request as it arrives. Each call gives the next bytes, which are valid until
/// the following call; no bytes mean that the body has ended. INVALID_ARGUMENT: the body is
/// malformed, or did not come whole in time. The reader bounds how much it takes.
using HttpBody = std::function<absl::StatusOr<absl::string_view>()>;

struct HttpReply {
  int status = 200;
  std::string type = {};                  ///< Content-Type; empty: the answer has no body
  std::vector<HttpField> headers = {};    ///< without Content-Type, Content-Length and Connection
  absl::string_view bytes = {};           ///< the body
  std::shared_ptr<const void> held = {};  ///< keeps `bytes` alive; null: they outlive the server
};

/// The answer 200 with this body, which the answer owns.
HttpReply text_reply(std::string text, std::string type);

/// The answer to a GET with the header Range (RFC 9110, section 14): the one range that it names
/// (206), no bytes where that range begins beyond the end (416), or all bytes (several ranges,
/// another unit, If-Range). Gives answers other than 200 back as they are.
HttpReply with_range(const HttpRequest& request, HttpReply reply);

/// Answers a request. It is called on one of the server's threads, and may wait.
using HttpHandler = std::function<HttpReply(const HttpRequest&, const HttpBody&)>;

}  // namespace bandsaw::coordinator
