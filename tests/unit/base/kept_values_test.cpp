// A cache that forgets, at the end of a round, the values which the round did not use.

#include "renderlib/base/kept_values.h"

#include <gtest/gtest.h>

#include <string>

namespace bandsaw {
namespace {

TEST(KeptValues, ForgetsValuesThatARoundDidNotUse) {
  KeptValues<int, std::string> values;
  values.set(1, "one");
  values.set(2, "two");
  values.end_round();
  ASSERT_NE(values.find(1), nullptr);
  EXPECT_EQ(*values.find(1), "one");
  values.set(3, "three");
  values.end_round();
  // A round uses a value if find() or set() is called for the value. A call of contains() does not
  // count.
  EXPECT_TRUE(values.contains(1));
  EXPECT_FALSE(values.contains(2));
  EXPECT_EQ(values.find(2), nullptr);
  EXPECT_TRUE(values.contains(3));
  values.end_round();
  EXPECT_FALSE(values.contains(1));
  EXPECT_FALSE(values.contains(3));
}

}  // namespace
}  // namespace bandsaw
