#pragma once

// Samples of a row that a film has covered: rendered, or skipped by the plan in all their tiles.

#include <cstdint>
#include <optional>
#include <vector>

#include "renderlib/render/band.h"

/// A set of sample ranges; adjacent ranges are merged.
namespace bandsaw {

class CoveredSamples {
 public:
  /// Returns the covered range (after merging) that overlaps `samples`, if any.
  std::optional<SampleRange> overlap(const SampleRange& samples) const;
  /// Adds `samples`, none of which may be covered.
  void add(const SampleRange& samples);
  /// Returns the largest n for which [0, n) is covered.
  std::uint64_t from_start() const;

 private:
  std::vector<SampleRange> ranges_;  ///< in ascending order; no two are adjacent
};

}  // namespace bandsaw
