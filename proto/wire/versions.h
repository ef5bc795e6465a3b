#pragma once

#include <cstdint>

namespace bandsaw::wire {

/// Raised when an old worker and a new coordinator, or the reverse, would misunderstand each other.
inline constexpr std::uint32_t kProtocol = 5;
/// Manifest.format.
inline constexpr std::uint32_t kPackageFormat = 2;

}  // namespace bandsaw::wire
