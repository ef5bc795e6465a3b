#pragma once

// Checks and prints the measured figures of the hard cases: numerically difficult situations of a
// renderer, which tests/hard_cases/cases.txt lists. Each figure is printed on a line of its own,
// with the file of its test; tests/hard_cases/run.sh collects these lines for the table of
// tests/hard_cases/README.md.

#include <string_view>

namespace bandsaw::test {

/// Expects that `figure` <= `limit`, and prints both. A NaN fails. `id`: the id of the hard case in
/// cases.txt, such as "S1". `what`: description of the figure.
void at_most(std::string_view id, std::string_view what, double figure, double limit);
/// Expects that `figure` >= `limit`, and prints both. A NaN fails.
void at_least(std::string_view id, std::string_view what, double figure, double limit);
/// Prints a property of the hard case `id` that the test has asserted, with the count: "no leak of
/// 20,000 rays". Not printed if the test has failed.
void report_hard_case(std::string_view id, std::string_view what);

/// Returns the number of tries: `few`, or `full` if the environment variable BANDSAW_FULL_COUNTS is
/// set, as in the tests with the CTest label hard_cases_full.
int tries(int few, int full);

/// Maximum of 0 and the numbers seen; NaN once a NaN was seen.
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
