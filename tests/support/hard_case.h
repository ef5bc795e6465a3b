#pragma once

// Figures of the hard cases (tests/hard_cases/cases.txt). Each is printed with its test on a line
// of its own; tests/hard_cases/run.sh gathers these into the table of tests/hard_cases/README.md.

#include <string_view>

namespace bandsaw::test {

/// Fails unless `figure` <= `limit`; NaN fails. `id`: "S1". `what`: what the figure is, in words.
void at_most(std::string_view id, std::string_view what, double figure, double limit);
/// Fails unless `figure` >= `limit`; NaN fails.
void at_least(std::string_view id, std::string_view what, double figure, double limit);
/// What this test has asserted one by one, in words with its count: "no leak of 20,000 rays".
/// Printed unless the test has failed.
void holds(std::string_view id, std::string_view what);

/// How often a test tries: few times in the default tests, as often as the case asks for in the
/// same ones with BANDSAW_FULL_COUNTS in the environment (label hard_cases_full).
int tries(int few, int full);

/// The largest of the numbers that it has seen; NaN once it has seen one.
class Worst {
 public:
  void see(double x) {
    if (!(x <= value_)) {
      value_ = x;
    }
  }
  double value() const { return value_; }

 private:
  double value_ = 0;
};

}  // namespace bandsaw::test
