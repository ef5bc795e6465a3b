#pragma once

// The link by which browsers join as workers: the address of a page of the dashboard, with a
// secret. There is at most one link at a time, and it ends at a given time.

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "absl/status/statusor.h"
#include "coordinator/rpc/failures.h"
#include "proto/link/browser_link.h"
#include "renderlib/base/mutex.h"

namespace bandsaw::coordinator {

/// Thread-safe. A change of the link is on disk before it has an effect.
class BrowserAccess {
 public:
  /// Returns seconds since 1970, UTC. A link stays valid when the coordinator restarts. So the end
  /// of a link is a time of this clock, which goes on while no coordinator runs.
  using UnixSeconds = std::function<double()>;

  /// The duration of a link if the user gives no duration, and the longest duration of a link. Both
  /// durations are in seconds.
  static constexpr double kStandardSeconds = 8 * 60 * 60;
  static constexpr double kMaxSeconds = 30.0 * 24 * 60 * 60;

  struct Link {
    std::string url;    ///< with the secret after the #, which browsers do not send
    double left_s = 0;  ///< seconds until it ends, > 0
  };

  /// Loads the link of an earlier start from the data folder. Errors as link::load_browser_link.
  static absl::StatusOr<std::unique_ptr<BrowserAccess>> load(std::string folder,
                                                             UnixSeconds now = nullptr);

  /// Sets the dashboard's address, for example "https://192.168.1.5:8787". MUST be called before
  /// other threads use the object. Without an address, no link is shown or made.
  void set_address(std::string address) { address_ = std::move(address); }

  /// Returns the present link; std::nullopt: there is none, or it has ended.
  std::optional<Link> present() EXCLUDES(mutex_);
  /// Makes a link that ends after `seconds`. If there is a valid link already, only changes the
  /// time at which it ends. INVALID_ARGUMENT: `seconds` is not in [1, kMaxSeconds].
  /// FAILED_PRECONDITION: there is no dashboard. Other errors: the file cannot be written; the
  /// present link is unchanged. Waits for the disk.
  absl::StatusOr<Link> make(double seconds) EXCLUDES(mutex_);
  /// Ends the present link, if there is one. The link is refused from the moment at which this
  /// function returns. Waits for the disk.
  absl::Status revoke() EXCLUDES(mutex_);

  /// Checks the secret of a request from this address. UNAUTHENTICATED: it is not the secret of the
  /// present link. RESOURCE_EXHAUSTED: the secret is wrong, and this address has sent too many
  /// wrong secrets.
  absl::Status check(const std::string& secret, const std::string& address) EXCLUDES(mutex_);
  /// Returns true if check() would succeed. A wrong secret is not counted.
  bool holds(const std::string& secret) EXCLUDES(mutex_);

 private:
  BrowserAccess(std::string folder, UnixSeconds now, std::optional<link::BrowserLink> link);
  /// Returns the link as users see it. `link_` MUST have a value.
  Link shown() REQUIRES(mutex_);
  /// Returns true if there is no link, or its time is over.
  bool has_ended() REQUIRES(mutex_);

  const std::string folder_;
  const UnixSeconds now_;
  std::string address_;  ///< empty: there is no dashboard
  Mutex mutex_;
  std::optional<link::BrowserLink> link_ GUARDED_BY(mutex_);
  Failures failures_ GUARDED_BY(mutex_);
};

}  // namespace bandsaw::coordinator
