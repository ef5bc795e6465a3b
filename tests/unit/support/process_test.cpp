// Tests the environment of child processes. A test gives variables to a child process as entries
// "NAME=value". The child process inherits all other variables from the test.

#include "tests/support/process.h"

#include <gtest/gtest.h>

#include <cstdlib>

namespace bandsaw::test {
namespace {

TEST(Process, AGivenEntryReplacesTheInheritedOne) {
  ASSERT_EQ(setenv("BANDSAW_TEST_ENTRY", "inherited", 1), 0);
  const Finished finished =
      run({"/bin/bash", "-c", "echo $BANDSAW_TEST_ENTRY"}, {"BANDSAW_TEST_ENTRY=given"});
  EXPECT_EQ(finished.out, "given\n");
}

TEST(Process, EntriesOfOtherNamesAreInherited) {
  ASSERT_EQ(setenv("BANDSAW_TEST_ENTRY_2", "inherited", 1), 0);
  const Finished finished =
      run({"/bin/bash", "-c", "echo $BANDSAW_TEST_ENTRY_2"}, {"BANDSAW_TEST_ENTRY=given"});
  EXPECT_EQ(finished.out, "inherited\n");
}

}  // namespace
}  // namespace bandsaw::test
