#pragma once

// Limits of the texts in the manifest of a scene package (proto/package.proto): the importer's
// warnings, and the names of cameras in models. Further limits are in proto/wire/limits.h and
// renderlib/render/settings.h.

#include <cstddef>
#include <cstdint>

namespace bandsaw {

inline constexpr std::size_t kMaxWarnings = 100;
inline constexpr std::size_t kMaxWarningBytes = 1'000;
inline constexpr std::size_t kMaxCameraNames = 100;
inline constexpr std::size_t kMaxCameraNameBytes = 200;

}  // namespace bandsaw
