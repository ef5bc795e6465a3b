#pragma once

// Work that has to be done before the samples of a scene are rendered: the training of path
// guiding, and photon maps.

#include <atomic>
#include <cstdint>
#include <functional>

#include "renderlib/base/pool.h"

namespace bandsaw {

/// Where a preparation runs, what stops it, and who is told that it goes on.
struct Preparation {
  Pool& pool;
  const std::atomic<bool>& stop;
  /// Called from any thread whenever a part is done: in each few seconds of a slow core at least
  /// once. May be empty.
  std::function<void()> step = {};

  bool stopped() const { return stop.load(std::memory_order_relaxed); }

  /// Tells that a part is done.
  void advance() const {
    if (step) {
      step();
    }
  }

  /// Calls `part` with each number in [0, parts) on the threads of the pool, until it is stopped.
  /// Returns false if it was.
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
