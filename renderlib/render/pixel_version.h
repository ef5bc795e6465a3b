#pragma once

#include <cstdint>

namespace bandsaw {

/// Raised by hand with every change that alters pixels. A worker renders for a farm only when it is
/// equal.
inline constexpr std::uint32_t kPixelVersion = 17;

}  // namespace bandsaw
