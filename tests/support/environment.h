#pragma once

// Reads parameters of tests from environment variables.

#include <cstdint>
#include <cstdlib>

namespace bandsaw::test {

/// Returns the whole number in the environment variable; `otherwise` if it is not set.
inline std::uint64_t number_from(const char* variable, std::uint64_t otherwise) {
  const char* const text = std::getenv(variable);
  return text == nullptr ? otherwise : std::strtoull(text, nullptr, 10);
}

}  // namespace bandsaw::test
