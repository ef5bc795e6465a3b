#pragma once

// Work that has to be done before the samples of a scene are rendered: the training of path
// guiding, and photon maps.

#include <atomic>
#include <cstdint>
#include <functional>

#include "renderlib/base/pool.h"

namespace bandsaw {

/// The environment in which a preparation runs: its threads, the flag that stops it, and the
/// function that is told of its progress. render/render_band.cpp makes it.
struct Preparation {
  Pool& pool;
  const std::atomic<bool>& stop;  ///< true: return as soon as possible, without a result
  /// Called from any thread whenever a part is done. Parts are so small that even a slow core
  /// finishes one every few seconds. May be empty.
  std::function<void()> step = {};

  bool stopped() const { return stop.load(std::memory_order_relaxed); }

  /// Reports that a part is done.
  void advance() const {
    if (step) {
      step();
    }
  }

  /// Calls `part` with each number in [0, parts) on the threads of the pool. If the preparation is
  /// stopped meanwhile, leaves out the remaining numbers and returns false.
  template <class Part>
  bool run(std::uint32_t parts, const Part& part) const {
    pool.parallel_for(parts, [&](std::int64_t number) {
      if (!stopped()) {
        part(static_cast<std::uint32_t>(number));
        advance();
      }
    });
    return !stopped();
  }
};

}  // namespace bandsaw
