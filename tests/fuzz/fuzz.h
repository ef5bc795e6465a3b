#pragma once

// A fuzz target is one .cpp file that defines run(), which gives any bytes to one reader of
// Bandsaw. The reader must take the bytes without a crash or a leak. Many targets also write what
// the reader accepts, and then read it again; it must be unchanged. libFuzzer calls run() through
// libfuzzer.cpp, and CTest calls run() with the stored inputs (the corpus) through replay.cpp.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>

#include "absl/types/span.h"

namespace bandsaw::fuzz {

/// Tries the target with one input; ends the program if the reader does something wrong.
void run(absl::Span<const std::uint8_t> input);

/// Reads the input as a sequence of events: calls step(what, number) for every three bytes, at most
/// `most` times. `what` is the first byte. `number` is the second and the third byte,
/// little-endian.
template <class F>
void each_step(absl::Span<const std::uint8_t> input, std::size_t most, F step) {
  for (std::size_t at = 0; at + 3 <= std::min(input.size(), 3 * most); at += 3) {
    step(input[at], static_cast<std::uint32_t>(input[at + 1] | input[at + 2] << 8));
  }
}

/// Returns the input as a string.
inline std::string text(absl::Span<const std::uint8_t> input) {
  return {input.begin(), input.end()};
}

}  // namespace bandsaw::fuzz
