#pragma once

#include <cstdint>

namespace bandsaw::wire {

/// Version of farm.proto. Raised when an old worker and a new coordinator, or the reverse, would
/// misunderstand each other; a worker of another version is refused.
inline constexpr std::uint32_t kProtocol = 5;
/// Version of scene packages (Manifest.format in package.proto). Raised when an old reader would
/// misread a new package.
inline constexpr std::uint32_t kPackageFormat = 2;

}  // namespace bandsaw::wire
