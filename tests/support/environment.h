#pragma once

// Test parameters from the environment.

#include <cstdint>
#include <cstdlib>

namespace bandsaw::test {

/// Returns a whole number; `otherwise` if the variable is not set.
inline std::uint64_t number_from(const char* variable, std::uint64_t otherwise) {
  const char* const text = std::getenv(variable);
  return text == nullptr ? otherwise : std::strtoull(text, nullptr, 10);
}

}  // namespace bandsaw::test
