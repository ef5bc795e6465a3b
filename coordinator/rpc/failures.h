#pragma once

// Counts wrong secrets per address, to limit the rate of attempts (Gate, BrowserAccess).

#include <cstddef>
#include <map>
#include <string>

namespace bandsaw::coordinator {

/// Not thread-safe. Has no clock: the time is passed with each call, in seconds since an arbitrary
/// start.
class Failures {
 public:
  /// More than `most` failures within a minute are too many.
  explicit Failures(std::size_t most) : most_(most) {}

  enum class Verdict { kFirst, kMore, kTooMany };
  /// Counts one more failure of the address. The first failure begins a minute, and so does the
  /// first failure after this minute. Returns kFirst for a failure that begins a minute, kTooMany
  /// if there were more than `most` failures in this minute, otherwise kMore.
  Verdict add(const std::string& address, double now);

 private:
  struct Count {
    double since = 0;          ///< time of the first failure
    std::size_t failures = 0;  ///< within a minute from `since`
  };
  void forget_old(double now);

  std::size_t most_;
  std::map<std::string, Count> counts_;
};

}  // namespace bandsaw::coordinator
