// join_addresses() returns the addresses for a join string (the line by which a worker or a command
// finds and joins the farm). If the coordinator listens on all addresses, the result is the
// addresses of this machine. Real interfaces come first, virtual ones second and loopback last. In
// each of these groups IPv4 comes before IPv6.

#include "coordinator/cli/serve/join_addresses.h"

#include <arpa/inet.h>
#include <ifaddrs.h>
#include <net/if.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <memory>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "renderlib/base/atomic_file.h"

namespace bandsaw::coordinator {
namespace {

constexpr std::size_t kMaxAddresses = 8;  // a join string has no more (proto/link/join.cpp)

// Returns true for interfaces of containers, bridges and virtual machines.
bool is_virtual(const std::string& name) {
  const std::array<const char*, 5> prefixes = {"docker", "veth", "br-", "virbr", "lxc"};
  return std::any_of(prefixes.begin(), prefixes.end(),
                     [&](const char* prefix) { return absl::StartsWith(name, prefix); });
}

// The best addresses have the lowest rank.
int rank(const LocalAddress& address) {
  return (address.loopback ? 4 : 0) + (is_virtual(address.interface_name) ? 2 : 0) +
         (address.ipv6 ? 1 : 0);
}

// Returns the address as text; empty if it cannot be used in a join string.
std::string text_of(const sockaddr& address) {
  std::array<char, INET6_ADDRSTRLEN> text{};
  if (address.sa_family == AF_INET) {
    sockaddr_in v4{};
    std::memcpy(&v4, &address, sizeof v4);
    inet_ntop(AF_INET, &v4.sin_addr, text.data(), text.size());
  } else if (address.sa_family == AF_INET6) {
    sockaddr_in6 v6{};
    std::memcpy(&v6, &address, sizeof v6);
    if (!IN6_IS_ADDR_LINKLOCAL(&v6.sin6_addr)) {
      inet_ntop(AF_INET6, &v6.sin6_addr, text.data(), text.size());
    }
  }
  return text.data();
}

}  // namespace

absl::StatusOr<std::vector<LocalAddress>> local_addresses() {
  ifaddrs* list = nullptr;
  if (getifaddrs(&list) != 0) {
    return errno_status(errno, "the list of network interfaces");
  }
  const std::unique_ptr<ifaddrs, decltype(&freeifaddrs)> owner(list, &freeifaddrs);
  std::vector<LocalAddress> out;
  for (const ifaddrs* entry = list; entry != nullptr; entry = entry->ifa_next) {
    if (entry->ifa_addr == nullptr || (entry->ifa_flags & IFF_UP) == 0) {
      continue;
    }
    const std::string text = text_of(*entry->ifa_addr);
    if (!text.empty()) {
      out.push_back({.interface_name = entry->ifa_name,
                     .address = text,
                     .ipv6 = entry->ifa_addr->sa_family == AF_INET6,
                     .loopback = (entry->ifa_flags & IFF_LOOPBACK) != 0});
    }
  }
  return out;
}

std::vector<std::string> join_addresses(const std::string& host, int port,
                                        const std::vector<LocalAddress>& local) {
  // 0.0.0.0 stands for every IPv4 address, [::] for every address.
  const bool every = host == "[::]" || host == "::";
  if (!every && host != "0.0.0.0") {
    return {absl::StrCat(host, ":", port)};
  }
  std::vector<LocalAddress> sorted = local;
  std::erase_if(sorted, [&](const LocalAddress& address) { return address.ipv6 && !every; });
  if (sorted.empty()) {  // no interface is up; loopback may come up later
    return {absl::StrCat("127.0.0.1:", port)};
  }
  std::stable_sort(sorted.begin(), sorted.end(),
                   [](const LocalAddress& a, const LocalAddress& b) { return rank(a) < rank(b); });
  if (sorted.size() > kMaxAddresses) {
    // The last one is kept: it is loopback, which always works for workers and commands on this
    // machine.
    sorted.erase(sorted.begin() + kMaxAddresses - 1, sorted.end() - 1);
  }
  std::vector<std::string> out;
  for (const LocalAddress& address : sorted) {
    out.push_back(address.ipv6 ? absl::StrCat("[", address.address, "]:", port)
                               : absl::StrCat(address.address, ":", port));
  }
  return out;
}

}  // namespace bandsaw::coordinator
