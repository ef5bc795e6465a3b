#pragma once

// Access control of the dashboard. Everybody who can reach the port may read the pages, their files
// and the workers' programs. Requests below /join (of browsers that render) are checked by their
// own handlers. All other requests except the login itself need a login. A login needs the users'
// secret; the secret with which workers join is refused. A POST from a page of another site is
// refused.

#include <string>

#include "absl/status/status.h"
#include "coordinator/rpc/failures.h"
#include "coordinator/web/http.h"
#include "proto/link/identity.h"
#include "renderlib/base/mutex.h"

namespace bandsaw::coordinator {

/// Header that a POST must have, with any value: pages of other sites cannot set it without a CORS
/// preflight.
inline constexpr char kOurHeader[] = "X-Bandsaw";

/// Thread-safe.
class Access {
 public:
  /// `secure`: browsers send the cookie over TLS only. `host`: the address or name on which the
  /// dashboard listens. If `host` is a name, requests may use this name as well as this machine's
  /// own name.
  Access(link::Identity identity, bool secure, std::string host);

  /// Replaces the secrets by those in `identity`. Logins with an earlier users' secret become
  /// invalid. Returns true if the users' secret has changed.
  bool renew(link::Identity identity) EXCLUDES(mutex_);

  /// Checks a request. INVALID_ARGUMENT: the method is not GET, HEAD or POST. PERMISSION_DENIED:
  /// the header Host is missing, malformed or names a foreign host, a POST lacks kOurHeader or
  /// comes from another site, or the secret is the workers'. UNAUTHENTICATED: not logged in.
  /// RESOURCE_EXHAUSTED: too many wrong secrets.
  absl::Status check(const HttpRequest& request) EXCLUDES(mutex_);

  /// Returns true if the request has a valid cookie.
  bool logged_in(const HttpRequest& request) EXCLUDES(mutex_);

  /// Sets the cookie in `reply`. `text`: the users' join string, or the secret in it.
  /// UNAUTHENTICATED: the secret is wrong. RESOURCE_EXHAUSTED: it is wrong, and this address has
  /// sent too many wrong secrets. PERMISSION_DENIED: it is the workers' secret.
  absl::Status log_in(const HttpRequest& request, const std::string& text, HttpReply& reply)
      EXCLUDES(mutex_);
  /// Deletes the cookie.
  void log_out(const HttpRequest& request, HttpReply& reply) const;

 private:
  /// Checks that the request has a valid cookie, or the users' secret as bearer_secret(). Errors as
  /// check().
  absl::Status check_login(const HttpRequest& request) EXCLUDES(mutex_);
  /// Checks that this is the users' secret. `address`: the sender's address. Errors as log_in().
  absl::Status check_secret(const std::string& secret, const std::string& address) REQUIRES(mutex_);
  /// Returns the value of the header Set-Cookie that sets the cookie for `seconds`; 0: deletes it.
  std::string cookie(const HttpRequest& request, const std::string& value, long seconds) const;

  const bool secure_;
  const std::string host_;  ///< what the dashboard listens on
  Mutex mutex_;
  link::Identity identity_ GUARDED_BY(mutex_);
  std::string pass_ GUARDED_BY(mutex_);  ///< value of the cookie, derived from the users' secret
  Failures failures_ GUARDED_BY(mutex_);
};

/// Returns true if the header Origin of a request names the site to which the request is sent.
/// Browsers set this header; pages cannot set it.
bool is_of_this_site(const HttpRequest& request);

/// Returns the secret of the header "Authorization: Bearer SECRET"; empty: there is none.
std::string bearer_secret(const HttpRequest& request);

/// Returns true if `host`, the header Host of a request, may name this dashboard. It may be an IP
/// address, localhost, `machine` (this machine's own name, also with ".local" after it) or `named`
/// (the name that the user has given to the dashboard), each with or without a port. A foreign site
/// can make its own name resolve to this machine (DNS rebinding). Then the header Host of a request
/// from its pages has the foreign name, so the result is false.
bool is_own_host(const std::string& host, const std::string& machine, const std::string& named);

}  // namespace bandsaw::coordinator
