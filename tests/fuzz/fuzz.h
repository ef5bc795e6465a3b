#pragma once

// A fuzz target is one file with fuzz(): any bytes, no crash, no leak, and what it takes is what it
// gives back. libFuzzer calls it through run_fuzzer.cpp, CTest with the corpus through replay.cpp.

#include <cstddef>
#include <cstdint>
#include <string>

#include "absl/types/span.h"

namespace bandsaw::fuzz {

/// Ends the program when something that must hold does not.
void run(absl::Span<const std::uint8_t> input);

inline std::string text(absl::Span<const std::uint8_t> input) {
  return {input.begin(), input.end()};
}

}  // namespace bandsaw::fuzz
