#pragma once

// What whoever runs a test may ask for in the environment.

#include <cstdint>
#include <cstdlib>

namespace bandsaw::test {

/// A whole number; `otherwise` where the variable is not set.
inline std::uint64_t number_from(const char* variable, std::uint64_t otherwise) {
  const char* const text = std::getenv(variable);
  return text == nullptr ? otherwise : std::strtoull(text, nullptr, 10);
}

}  // namespace bandsaw::test
