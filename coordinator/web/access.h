#pragma once

// Which requests are served. The page itself is for everybody who can reach it; all else needs a
// login, and what changes anything must come from the page.

#include <string>

#include "absl/status/status.h"
#include "coordinator/rpc/failures.h"
#include "coordinator/web/http.h"
#include "proto/link/identity.h"
#include "renderlib/base/mutex.h"

namespace bandsaw::coordinator {

/// What a POST must carry, with any value: other sites cannot set it without asking first.
inline constexpr char kOurHeader[] = "X-Bandsaw";

/// Thread-safe.
class Access {
 public:
  /// `secure`: cookies go over TLS only.
  Access(link::Identity identity, bool secure);

  /// Logins with the secrets of before are void. True: people's secret is another one.
  bool renew(link::Identity identity) EXCLUDES(mutex_);

  /// INVALID_ARGUMENT: no HTTP of ours. PERMISSION_DENIED: under a foreign name, from another site.
  /// UNAUTHENTICATED: not logged in. RESOURCE_EXHAUSTED: too many wrong secrets.
  absl::Status check(const HttpRequest& request) EXCLUDES(mutex_);

  /// By the cookie.
  bool logged_in(const HttpRequest& request) EXCLUDES(mutex_);

  /// Sets the cookie in `reply`. `text`: people's join string, or the secret in it.
  /// UNAUTHENTICATED: a wrong one. RESOURCE_EXHAUSTED: that, too often from one address.
  /// PERMISSION_DENIED: the workers'.
  absl::Status log_in(const HttpRequest& request, const std::string& text, HttpReply& reply)
      EXCLUDES(mutex_);
  /// Takes the cookie away.
  void log_out(const HttpRequest& request, HttpReply& reply) const;

 private:
  absl::Status check_login(const HttpRequest& request) EXCLUDES(mutex_);
  absl::Status check_secret(const std::string& secret, const std::string& address) REQUIRES(mutex_);
  std::string cookie(const HttpRequest& request, const std::string& value, long seconds) const;

  const bool secure_;
  Mutex mutex_;
  link::Identity identity_ GUARDED_BY(mutex_);
  std::string pass_ GUARDED_BY(mutex_);  ///< what a browser holds: made of people's secret
  Failures failures_ GUARDED_BY(mutex_);
};

/// Whether a Host header names this machine by number or by its own name. A page of another site
/// that lets its name point here (DNS rebinding) comes under that name.
bool is_own_host(const std::string& host, const std::string& machine);

}  // namespace bandsaw::coordinator
