#pragma once

// An HTTP request and its response as the dashboard's handlers see them. These types do not depend
// on the library that reads and writes them (exchange.cpp).

#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"

namespace bandsaw::coordinator {

/// Name and value of a header or parameter.
using HttpField = std::pair<std::string, std::string>;

struct HttpRequest {
  std::string method;                 ///< in upper case: "GET"
  std::string path;                   ///< percent-decoded, without the query
  std::vector<HttpField> parameters;  ///< parameters of the query, decoded, in their order
  std::vector<HttpField> headers;     ///< in their order
  std::string captured;               ///< the part of the path that stands for "*" in its route
  std::string remote_address;         ///< numeric; empty: not known
  int local_port = 0;

  /// Returns the value of the first header of this name, ignoring case; empty: there is none.
  std::string header(absl::string_view name) const;
  bool has_header(absl::string_view name) const;
  /// Returns the decoded value of the first parameter of this name; empty: there is none.
  std::string parameter(absl::string_view name) const;
};

/// Sets path and parameters from a request's target, for example "/api/log?name=a%20b". A percent
/// sign without two hexadecimal digits after it is taken literally.
void parse_target(absl::string_view target, HttpRequest& request);

/// Reads the body of a request as it arrives. Each call returns the next bytes, which are valid
/// until the next call; no bytes: the body has ended. INVALID_ARGUMENT: the body is malformed, or
/// did not arrive completely in time. The caller limits how much it reads.
using HttpBody = std::function<absl::StatusOr<absl::string_view>()>;

class Connection;
/// A function that takes over a connection whose request asks for another protocol (WebSocket). In
/// the end the function closes the connection's socket.
using TakeOver = std::function<void(std::unique_ptr<Connection>)>;

struct HttpReply {
  int status = 200;
  std::string type = {};  ///< Content-Type; empty: no body
  /// The headers of the response, without Content-Type, Content-Length and Connection. The server
  /// adds its own headers to every response, except those whose names are in this list.
  std::vector<HttpField> headers = {};
  absl::string_view bytes = {};           ///< the body
  std::shared_ptr<const void> held = {};  ///< keeps `bytes` alive; nullptr: they outlive the server
  TakeOver take_over = {};  ///< if set, it gets the connection, and no response is written
};

/// Returns a response 200 that owns this body.
HttpReply text_reply(std::string text, std::string type);

/// Applies the header Range of a GET (RFC 9110, section 14) to a response 200. If the header names
/// one range of bytes, returns these bytes (206), or no bytes if the range begins beyond the end
/// (416). In all other cases, and if the request has the header If-Range, returns the response
/// unchanged.
HttpReply with_range(const HttpRequest& request, HttpReply reply);

/// Returns the response to a request. Called on one of the server's threads; may wait.
using HttpHandler = std::function<HttpReply(const HttpRequest&, const HttpBody&)>;

}  // namespace bandsaw::coordinator
