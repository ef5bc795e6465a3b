#pragma once

namespace bandsaw {

/// Closed interval of time, e.g. the time during which the shutter is open. The unit is that of the
/// scene's times (Ray::time, Key::time).
struct Interval {
  double open = 0;
  double close = 0;
  friend bool operator==(const Interval&, const Interval&) = default;
};

}  // namespace bandsaw
