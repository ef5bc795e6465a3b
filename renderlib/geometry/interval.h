#pragma once

namespace bandsaw {

/// Closed interval of time.
struct Interval {
  double open = 0;
  double close = 0;
  friend bool operator==(const Interval&, const Interval&) = default;
};

}  // namespace bandsaw
