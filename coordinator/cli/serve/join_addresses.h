#pragma once

// Finds the addresses under which other machines can reach this one, for the join strings and the
// dashboard of `bandsaw serve`.

#include <string>
#include <vector>

#include "absl/status/statusor.h"

namespace bandsaw::coordinator {

/// An address of this machine in numeric form.
struct LocalAddress {
  std::string interface_name;  ///< of the system, such as "eth0"
  std::string address;
  bool ipv6 = false;
  bool loopback = false;
};

/// Returns the addresses of the interfaces that are up, without IPv6 link-local addresses, which
/// need a scope. INTERNAL: the system's error.
absl::StatusOr<std::vector<LocalAddress>> local_addresses();

/// Returns at most 8 addresses HOST:PORT for a join string, the best one first. `host`: the host on
/// which the coordinator listens. If it is 0.0.0.0, the result is every IPv4 address in `local`. If
/// it is [::], the result is every address in `local`. Addresses of real interfaces come first,
/// then those of containers and bridges, then loopback. If `local` has no address of the wanted
/// kind, the result is 127.0.0.1. If `host` is any other host, the result is only this host.
std::vector<std::string> join_addresses(const std::string& host, int port,
                                        const std::vector<LocalAddress>& local);

}  // namespace bandsaw::coordinator
