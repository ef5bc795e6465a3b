#pragma once

// A fuzz target is one file with fuzz(). It takes any bytes without a crash or a leak, and accepted
// input reads back unchanged. libFuzzer calls it through libfuzzer.cpp, CTest with the corpus
// through replay.cpp.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>

#include "absl/types/span.h"

namespace bandsaw::fuzz {

/// Ends the program if the condition does not hold.
void run(absl::Span<const std::uint8_t> input);

/// Calls step(what, number) for every three bytes, at most `most` times: a sequence of events.
template <class F>
void each_step(absl::Span<const std::uint8_t> input, std::size_t most, F step) {
  for (std::size_t at = 0; at + 3 <= std::min(input.size(), 3 * most); at += 3) {
    step(input[at], static_cast<std::uint32_t>(input[at + 1] | input[at + 2] << 8));
  }
}

inline std::string text(absl::Span<const std::uint8_t> input) {
  return {input.begin(), input.end()};
}

}  // namespace bandsaw::fuzz
