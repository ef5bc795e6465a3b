#pragma once

// The addresses under which other machines reach this one.

#include <string>
#include <vector>

#include "absl/status/statusor.h"

namespace bandsaw::coordinator {

/// An address of this machine, as numbers and dots (or colons).
struct LocalAddress {
  std::string interface_name;
  std::string address;
  bool ipv6 = false;
  bool loopback = false;
};

/// Those of the interfaces that are up; without IPv6 link-local ones, which need a scope. INTERNAL:
/// the system's reason.
absl::StatusOr<std::vector<LocalAddress>> local_addresses();

/// host:port for a join string, best first, at most 8. A named host is itself; 0.0.0.0 stands for
/// every IPv4 address,
/// [::] for every address: LAN interfaces first, then those of containers and bridges, loopback
/// last.
std::vector<std::string> join_addresses(const std::string& host, int port,
                                        const std::vector<LocalAddress>& local);

}  // namespace bandsaw::coordinator
