#pragma once

// One request of a connection and its answer: HTTP/1.1 by Boost.Beast.

#include <vector>

#include "coordinator/web/connection.h"
#include "coordinator/web/http.h"

namespace bandsaw::coordinator {

/// The request line and the headers together have at most so many bytes.
inline constexpr std::uint32_t kMaxHeadBytes = 32 << 10;

/// Reads one request, has it answered by `handler`, and writes the answer with `headers` added.
/// What is no HTTP is answered with an error; a connection that ends, or whose time is over, is not
/// answered.
void exchange(Connection& connection, const HttpHandler& handler,
              const std::vector<HttpField>& headers);

}  // namespace bandsaw::coordinator
