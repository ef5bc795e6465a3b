#pragma once

// Vectors of three floats, as meshes and guiding fields store them, and conversions from and to
// Vec3, which has three doubles.

#include <array>

#include "renderlib/math/vec.h"

namespace bandsaw {

using Float3 = std::array<float, 3>;

inline Float3 float3(const Vec3& v) {
  return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}
inline Vec3 vec3(const Float3& v) { return {v[0], v[1], v[2]}; }

}  // namespace bandsaw
