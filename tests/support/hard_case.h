#pragma once

// Figures of the hard cases (tests/hard_cases/cases.txt). Each is printed with its test on a line
// of its own; tests/hard_cases/run.sh collects them for the table of tests/hard_cases/README.md.

#include <string_view>

namespace bandsaw::test {

/// Fails unless `figure` <= `limit`; NaN fails. `id`: the id of the hard case in cases.txt, such as
/// "S1". `what`: description of the figure.
void at_most(std::string_view id, std::string_view what, double figure, double limit);
/// Fails unless `figure` >= `limit`; NaN fails.
void at_least(std::string_view id, std::string_view what, double figure, double limit);
/// Prints a property of the hard case `id` that the test has asserted, with the count: "no leak of
/// 20,000 rays". Not printed if the test has failed.
void report_hard_case(std::string_view id, std::string_view what);

/// Returns the number of tries: `few` in the default tests, `full` if BANDSAW_FULL_COUNTS is set in
/// the environment (label hard_cases_full).
int tries(int few, int full);

/// Maximum of the numbers seen; NaN once a NaN was seen.
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
