#pragma once

// All settings besides the scene that determine pixels.

#include <cstdint>

#include "absl/status/status.h"
#include "renderlib/scene/integrator.h"

namespace bandsaw {

/// A RenderSettings and a scene determine every sample of every pixel.
struct RenderSettings {
  std::uint32_t width = 600;     ///< pixels, [1, 65536]
  std::uint32_t height = 400;    ///< pixels, [1, 65536]; width x height <= kMaxPixels
  std::uint32_t max_depth = 32;  ///< maximum number of scatterings of a path, [1, 1024]
  std::uint64_t seed = 0;
  Integrator integrator = Integrator::kPath;
  friend bool operator==(const RenderSettings&, const RenderSettings&) = default;
};

inline constexpr std::uint32_t kMaxSide = 65536;
inline constexpr std::uint64_t kMaxPixels = 64'000'000;
inline constexpr std::uint32_t kMaxDepth = 1024;
inline constexpr std::uint64_t kMaxSamples = std::uint64_t{1} << 30;  ///< of a pixel

/// Returns INVALID_ARGUMENT, with the field, its range and the value, if a field is out of range.
absl::Status validate(const RenderSettings& settings);

}  // namespace bandsaw
