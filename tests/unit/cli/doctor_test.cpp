// The checks of `bandsaw doctor`: certificate, clocks, versions, disk, and the connection to a
// farm.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include "coordinator/cli/machines/doctor_checks.h"
#include "proto/wire/versions.h"
#include "renderlib/render/pixel_version.h"
#include "tests/support/temp_dir.h"

namespace bandsaw::coordinator {
namespace {

using testing::HasSubstr;

// The arguments are the time from which the certificate is valid, the time until which it is valid,
// and the present time.
TEST(Doctor, ACertificateIsValidInItsTime) {
  EXPECT_TRUE(certificate_check(100, 200, 150).ok);
  EXPECT_THAT(certificate_check(100, 200, 99).found, HasSubstr("not valid yet"));
  const Check over = certificate_check(100, 200, 201);
  EXPECT_FALSE(over.ok);
  EXPECT_THAT(over.found, HasSubstr("not valid any more"));
}

// The arguments are this machine's time before the coordinator's answer, the coordinator's time,
// and this machine's time after the answer.
TEST(Doctor, ClocksMayDifferALittle) {
  EXPECT_TRUE(clock_check(100, 103, 102).ok);
  const Check slow = clock_check(100, 1, 102);
  EXPECT_FALSE(slow.ok);
  EXPECT_THAT(slow.found, HasSubstr("-100 s"));  // 1 - (100 + 102) / 2, in whole seconds
}

TEST(Doctor, VersionsMustBeEqual) {
  farm::AboutReply about;
  about.set_protocol(wire::kProtocol);
  about.set_pixel_version(kPixelVersion);
  EXPECT_TRUE(versions_check(about).ok);
  about.set_pixel_version(kPixelVersion + 1);
  EXPECT_FALSE(versions_check(about).ok);
  about.set_pixel_version(kPixelVersion);
  about.set_protocol(wire::kProtocol + 1);
  EXPECT_FALSE(versions_check(about).ok);
}

TEST(Doctor, ADiskNeedsFreeSpace) {
  EXPECT_TRUE(disk_space_check("disk", "/x", 2ull << 30).ok);
  const Check full = disk_space_check("disk", "/x", 100'000'000);
  EXPECT_FALSE(full.ok);
  EXPECT_THAT(full.found, HasSubstr("only 0.1 GB"));
}

TEST(Doctor, AMissingFolderIsReportedAsNotYetExisting) {
  const test::TempDir folder;
  EXPECT_THAT(check_data_folder(folder / "a/b").found, HasSubstr("does not exist yet"));
}

// A program listens on a port of 127.0.0.1. The check of this port passes only if the program is
// the farm. The arguments of check_port() are the address to listen on, the address at which the
// farm answers ("" if it does not answer), and all addresses in the farm's join string.
TEST(Doctor, ATakenPortIsFineOnlyIfTheFarmListensThere) {
  const int taken = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof(address);
  ASSERT_EQ(bind(taken, reinterpret_cast<sockaddr*>(&address), size), 0);
  ASSERT_EQ(listen(taken, 1), 0);
  ASSERT_EQ(getsockname(taken, reinterpret_cast<sockaddr*>(&address), &size), 0);
  const std::string port = ":" + std::to_string(ntohs(address.sin_port));
  const std::string here = "127.0.0.1" + port;
  const std::string also_here = "127.0.0.2" + port;
  const std::string elsewhere = "192.0.2.77" + port;  // an address for documentation

  EXPECT_TRUE(check_port(here, here, {here}).ok);
  EXPECT_TRUE(check_port("0.0.0.0" + port, here, {here}).ok);
  EXPECT_TRUE(check_port(here, also_here, {also_here, here}).ok)
      << "must pass, because the farm has both addresses";
  EXPECT_FALSE(check_port(here, "", {here}).ok) << "must fail, because the farm does not answer";
  EXPECT_FALSE(check_port(here, also_here, {also_here}).ok)
      << "must fail, because the farm has another address";
  EXPECT_FALSE(check_port(here, elsewhere, {elsewhere, here}).ok)
      << "must fail, because the farm is elsewhere";
  EXPECT_FALSE(check_port("0.0.0.0" + port, elsewhere, {elsewhere, here}).ok);
  EXPECT_FALSE(check_port(here, "127.0.0.1:1", {"127.0.0.1:1"}).ok);
  close(taken);
}

TEST(Doctor, AMissingJoinStringIsNotFoundAndAMalformedOneIsInvalid) {
  const test::TempDir folder;
  EXPECT_TRUE(absl::IsNotFound(doctor_join({}, folder.path()).status()));
  EXPECT_TRUE(absl::IsInvalidArgument(doctor_join({.farm = "bsw1-x"}, folder.path()).status()));
}

}  // namespace
}  // namespace bandsaw::coordinator
