// Prints the measured figure of a hard case (tests/hard_cases/README.md) on a line that
// tests/hard_cases/run.sh collects.

#include "tests/support/hard_case.h"

#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <iostream>
#include <string>

namespace bandsaw::test {
namespace {

/// Returns the number with three significant digits.
std::string text(double number) {
  char digits[32];
  std::snprintf(digits, sizeof digits, "%.3g", number);
  return digits;
}

/// Returns the file of the running test, from "tests/" on.
std::string here() {
  const std::string file = ::testing::UnitTest::GetInstance()->current_test_info()->file();
  const std::size_t tests = file.rfind("/tests/");
  return tests == std::string::npos ? file : file.substr(tests + 1);
}

/// Prints the line of the hard case `id`, with the file of the running test.
void print(std::string_view id, const std::string& figure) {
  std::cout << "[ case " << id << " ] " << here() << " | " << figure << std::endl;
}

}  // namespace

void at_most(std::string_view id, std::string_view what, double figure, double limit) {
  EXPECT_LE(figure, limit) << id << ": " << what;
  print(id, std::string(what) + ": " + text(figure) + " <= " + text(limit));
}

void at_least(std::string_view id, std::string_view what, double figure, double limit) {
  EXPECT_GE(figure, limit) << id << ": " << what;
  print(id, std::string(what) + ": " + text(figure) + " >= " + text(limit));
}

void report_hard_case(std::string_view id, std::string_view what) {
  if (!::testing::Test::HasFailure()) {
    print(id, std::string(what));
  }
}

int tries(int few, int full) { return std::getenv("BANDSAW_FULL_COUNTS") == nullptr ? few : full; }

}  // namespace bandsaw::test
