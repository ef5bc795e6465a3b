#pragma once

// Which passes' samples of a row a film has: rendered, or left out by all that plan says.

#include <cstdint>
#include <optional>
#include <vector>

#include "renderlib/render/band.h"

namespace bandsaw {

class CoveredSamples {
 public:
  /// What of these is there already, with all that it touches.
  std::optional<SampleRange> overlap(const SampleRange& samples) const;
  /// None of them is there yet.
  void add(const SampleRange& samples);
  /// The largest n of which [0, n) is there.
  std::uint64_t from_start() const;

 private:
  std::vector<SampleRange> ranges_;  ///< in order; none touch
};

}  // namespace bandsaw
