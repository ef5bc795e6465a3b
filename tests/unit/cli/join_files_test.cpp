// Tests rotate_secret(), which renews the secret of the workers or of the farm, and writes the join
// string with the new secret to a file. A worker or a command connects to the coordinator with a
// join string. If a coordinator runs, the last argument of rotate_secret() is the coordinator's
// join string.

#include "coordinator/cli/serve/join_files.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "tests/support/temp_dir.h"

namespace bandsaw::coordinator {
namespace {

class JoinFilesTest : public testing::TestWithParam<link::Role> {
 protected:
  std::string file() const { return join_file_of(folder_.path(), GetParam()); }
  /// Returns the join string with the secret that the test's farm has at the beginning.
  link::JoinString first() const {
    return join_string(GetParam(), identity_, {"host:4780"}, /*insecure=*/false);
  }
  /// Checks that the file has the join string of first(), but with the renewed secret.
  void expect_new_string(const absl::StatusOr<RenewedSecret>& renewed) const {
    ASSERT_TRUE(renewed.ok()) << renewed.status();
    EXPECT_TRUE(renewed->written.ok()) << renewed->written;
    EXPECT_EQ(renewed->join_file, file());
    const auto written = link::join_string_from(file());
    ASSERT_TRUE(written.ok()) << written.status();
    EXPECT_NE(written->secret, first().secret);
    EXPECT_EQ(written->text(),
              join_string(GetParam(), renewed->identity, {"host:4780"}, /*insecure=*/false).text());
  }

  test::TempDir folder_;
  link::Identity identity_ = *link::load_or_make_identity(folder_.path());
};

TEST_P(JoinFilesTest, WithACoordinatorAMissingOrDamagedFileIsWritten) {
  expect_new_string(rotate_secret(folder_.path(), GetParam(), first()));
  std::ofstream(file(), std::ios::trunc) << "damaged";
  expect_new_string(rotate_secret(folder_.path(), GetParam(), first()));
}

TEST_P(JoinFilesTest, WithoutACoordinatorTheAddressesAreThoseOfTheFile) {
  ASSERT_TRUE(write_join_file(folder_.path(), first()).ok());
  expect_new_string(rotate_secret(folder_.path(), GetParam(), std::nullopt));
}

TEST_P(JoinFilesTest, WithoutACoordinatorAMissingFileIsNotWritten) {
  const auto renewed = rotate_secret(folder_.path(), GetParam(), std::nullopt);
  ASSERT_TRUE(renewed.ok()) << renewed.status();
  EXPECT_EQ(renewed->join_file, "");
  EXPECT_FALSE(std::filesystem::exists(file()));
}

INSTANTIATE_TEST_SUITE_P(Roles, JoinFilesTest,
                         testing::Values(link::Role::kWorker, link::Role::kFarm),
                         [](const testing::TestParamInfo<link::Role>& role) {
                           return role.param == link::Role::kWorker ? "Worker" : "Farm";
                         });

}  // namespace
}  // namespace bandsaw::coordinator
