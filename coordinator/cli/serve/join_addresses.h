#pragma once

// Addresses under which other machines can reach this one.

#include <string>
#include <vector>

#include "absl/status/statusor.h"

namespace bandsaw::coordinator {

/// An address of this machine in numeric form.
struct LocalAddress {
  std::string interface_name;
  std::string address;
  bool ipv6 = false;
  bool loopback = false;
};

/// Returns the addresses of the interfaces that are up, without IPv6 link-local addresses, which
/// need a scope. INTERNAL: the system's error.
absl::StatusOr<std::vector<LocalAddress>> local_addresses();

/// Returns host:port for a join string, best first, at most 8. A host name or address stands for
/// itself; 0.0.0.0 stands for every IPv4 address, [::] for every address: LAN interfaces first,
/// then those of containers and bridges, loopback last.
std::vector<std::string> join_addresses(const std::string& host, int port,
                                        const std::vector<LocalAddress>& local);

}  // namespace bandsaw::coordinator
