#pragma once

// Serves one HTTP/1.1 request of a connection, with Boost.Beast.

#include <vector>

#include "coordinator/web/connection.h"
#include "coordinator/web/http.h"

namespace bandsaw::coordinator {

/// Maximum size of the request line and the headers together, in bytes.
inline constexpr std::uint32_t kMaxHeadBytes = 32 << 10;

/// Reads one request, calls `handler`, and writes its response with `headers` added. Malformed HTTP
/// gets an error response. A connection that ends, or whose deadline passes, gets no response.
/// If the handler's reply has a function `take_over`, because the client asked for another protocol
/// (WebSocket), no response is written, and this function is returned. The caller must call it. In
/// all other cases the result is empty.
TakeOver exchange(Connection& connection, const HttpHandler& handler,
                  const std::vector<HttpField>& headers);

}  // namespace bandsaw::coordinator
