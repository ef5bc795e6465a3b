#pragma once

// Wrong secrets, counted by address, so that whoever tries many is turned away.

#include <cstddef>
#include <map>
#include <string>

namespace bandsaw::coordinator {

/// A pure counter: the time comes with each call, in seconds since any start. Used by one thread at
/// a time.
class Failures {
 public:
  /// More than `most` within a minute is too many.
  explicit Failures(std::size_t most) : most_(most) {}

  enum class Verdict { kFirst, kMore, kTooMany };
  /// Counts one more of this address. kFirst: of its minute.
  Verdict add(const std::string& address, double now);

 private:
  struct Count {
    double since = 0;
    std::size_t failures = 0;
  };
  void forget_old(double now);

  std::size_t most_;
  std::map<std::string, Count> counts_;
};

}  // namespace bandsaw::coordinator
