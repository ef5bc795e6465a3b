// Tests which addresses of this machine a join string lists. Workers and commands need a join
// string to connect to a coordinator.

#include "coordinator/cli/serve/join_addresses.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace bandsaw::coordinator {
namespace {

using testing::ElementsAre;

/// Each entry: interface, address, true if it is an IPv6 address, true if it is loopback.
const std::vector<LocalAddress> kLocal = {
    {"lo", "127.0.0.1", false, true},      {"docker0", "172.17.0.1", false, false},
    {"eth0", "192.168.1.5", false, false}, {"lo", "::1", true, true},
    {"eth0", "2001:db8::5", true, false},
};

TEST(JoinAddresses, AGivenHostIsTheOnlyAddress) {
  EXPECT_THAT(join_addresses("127.0.0.1", 7878, kLocal), ElementsAre("127.0.0.1:7878"));
  EXPECT_THAT(join_addresses("farm.example", 1, kLocal), ElementsAre("farm.example:1"));
}

// The host 0.0.0.0 stands for all IPv4 addresses of this machine, and the host [::] for all IPv4
// and IPv6 addresses.
TEST(JoinAddresses, RealInterfacesComeBeforeVirtualOnesAndLoopbackIsLast) {
  EXPECT_THAT(join_addresses("0.0.0.0", 7, kLocal),
              ElementsAre("192.168.1.5:7", "172.17.0.1:7", "127.0.0.1:7"));
  EXPECT_THAT(
      join_addresses("[::]", 7, kLocal),
      ElementsAre("192.168.1.5:7", "[2001:db8::5]:7", "172.17.0.1:7", "127.0.0.1:7", "[::1]:7"));
}

TEST(JoinAddresses, AreAtMostEightAndTheLastIsLoopback) {
  std::vector<LocalAddress> many(20, kLocal[2]);
  many.push_back(kLocal[0]);
  const auto addresses = join_addresses("0.0.0.0", 7, many);
  ASSERT_EQ(addresses.size(), 8u);
  EXPECT_EQ(addresses.back(), "127.0.0.1:7");
}

TEST(JoinAddresses, WithoutInterfacesTheAddressIsLoopback) {
  EXPECT_THAT(join_addresses("0.0.0.0", 7, {}), ElementsAre("127.0.0.1:7"));
  EXPECT_THAT(join_addresses("[::]", 7, {}), ElementsAre("127.0.0.1:7"));
  // The only address, ::1, is not an IPv4 address.
  EXPECT_THAT(join_addresses("0.0.0.0", 7, {kLocal[3]}), ElementsAre("127.0.0.1:7"));
}

TEST(JoinAddresses, ThisMachineHasLoopback) {
  const auto local = local_addresses();
  ASSERT_TRUE(local.ok()) << local.status();
  EXPECT_TRUE(
      std::any_of(local->begin(), local->end(), [](const LocalAddress& a) { return a.loopback; }));
}

}  // namespace
}  // namespace bandsaw::coordinator
