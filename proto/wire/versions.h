#pragma once

// Versions of what the machines of a farm exchange: messages and scene packages.

#include <cstdint>

namespace bandsaw::wire {

/// Version of farm.proto. It is raised when workers and coordinators of the old and the new version
/// would misunderstand each other. The coordinator refuses a worker of another version.
inline constexpr std::uint32_t kProtocol = 5;
/// Version of scene packages (Manifest.format in package.proto). It is raised when an old reader
/// would misread a new package.
inline constexpr std::uint32_t kPackageFormat = 2;

}  // namespace bandsaw::wire
