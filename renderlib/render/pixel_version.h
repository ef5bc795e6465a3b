#pragma once

#include <cstdint>

namespace bandsaw {

/// Incremented by hand with every change that alters pixels. A worker renders for a coordinator
/// only if both have the same version.
inline constexpr std::uint32_t kPixelVersion = 37;

}  // namespace bandsaw
