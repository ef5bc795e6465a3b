// The checks of `bandsaw doctor`: certificate, clocks, versions, disk, and the connection to a
// farm.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "coordinator/cli/machines/doctor_checks.h"
#include "proto/wire/versions.h"
#include "renderlib/render/pixel_version.h"
#include "tests/support/temp_dir.h"

namespace bandsaw::coordinator {
namespace {

using testing::HasSubstr;

// The arguments are the times from and until which the certificate is valid, and the present.
TEST(Doctor, ACertificateIsValidInItsTime) {
  EXPECT_TRUE(certificate_check(100, 200, 150).ok);
  EXPECT_THAT(certificate_check(100, 200, 99).found, HasSubstr("not valid yet"));
  const Check over = certificate_check(100, 200, 201);
  EXPECT_FALSE(over.ok);
  EXPECT_THAT(over.found, HasSubstr("not valid any more"));
}

// The arguments are our time before the coordinator's answer, its time, and our time after it.
TEST(Doctor, ClocksMayDifferALittle) {
  EXPECT_TRUE(clock_check(100, 103, 102).ok);
  const Check slow = clock_check(100, 1, 102);
  EXPECT_FALSE(slow.ok);
  EXPECT_THAT(slow.found, HasSubstr("-100 s"));
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

TEST(Doctor, ADiskNeedsRoom) {
  EXPECT_TRUE(disk_space_check("disk", "/x", 2ull << 30).ok);
  const Check full = disk_space_check("disk", "/x", 100'000'000);
  EXPECT_FALSE(full.ok);
  EXPECT_THAT(full.found, HasSubstr("only 0.1 GB"));
}

TEST(Doctor, AMissingFolderIsCheckedByItsParent) {
  const test::TempDir folder;
  EXPECT_THAT(check_data_folder(folder / "a/b").found, HasSubstr("does not exist yet"));
}

TEST(Doctor, NoFarmIsNotFoundAndAWrongOneIsReported) {
  const test::TempDir folder;
  EXPECT_TRUE(absl::IsNotFound(doctor_join({}, folder.path()).status()));
  EXPECT_TRUE(absl::IsInvalidArgument(doctor_join({.farm = "bsw1-x"}, folder.path()).status()));
}

}  // namespace
}  // namespace bandsaw::coordinator
