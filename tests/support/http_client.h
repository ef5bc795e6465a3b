#pragma once

// HTTP calls to a server on loopback.

#include <map>
#include <optional>
#include <string>

namespace bandsaw::test {

using HttpHeaders = std::multimap<std::string, std::string>;

struct HttpAnswer {
  int status = 0;
  std::string body;
  HttpHeaders headers;

  /// The value of the first header of this name, whose case does not matter; empty: there is none.
  std::string header(const std::string& name) const;
};

struct HttpCall {
  std::string method = "GET";
  std::string target = "/";
  HttpHeaders headers = {};  ///< Host and Content-Length come by themselves, unless they are given
  std::string body = {};
};

/// Makes a connection to 127.0.0.1 for this call alone, and waits for the whole answer. Nothing: no
/// whole answer came.
std::optional<HttpAnswer> http_call(int port, const HttpCall& call);

/// Makes a connection to 127.0.0.1, sends these bytes, and gives all that is answered until the
/// server closes the connection.
std::string send_bytes_to(int port, const std::string& bytes);

}  // namespace bandsaw::test
