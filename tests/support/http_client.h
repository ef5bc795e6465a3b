#pragma once

// Blocking HTTP calls to a server on loopback, for tests of the coordinator's web server.

#include <map>
#include <optional>
#include <string>

namespace bandsaw::test {

using HttpHeaders = std::multimap<std::string, std::string>;

struct HttpAnswer {
  int status = 0;
  std::string body;
  HttpHeaders headers;

  /// Returns the value of the first header of this name, ignoring case; empty: there is none.
  std::string header(const std::string& name) const;
};

struct HttpCall {
  std::string method = "GET";
  std::string target = "/";
  HttpHeaders headers = {};  ///< Host and Content-Length are added unless they are given
  std::string body = {};
};

/// Opens a connection to 127.0.0.1 for this call only, and waits for the whole response. Returns
/// std::nullopt if no complete response arrived.
std::optional<HttpAnswer> http_call(int port, const HttpCall& call);

/// Opens a connection to 127.0.0.1, sends these bytes, and returns all bytes received until the
/// server closes the connection.
std::string send_bytes_to(int port, const std::string& bytes);

}  // namespace bandsaw::test
