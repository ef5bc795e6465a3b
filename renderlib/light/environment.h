#pragma once

// Images all around a scene, seen where a ray leaves it. Looked up by direction, linearly
// interpolated between texels.

#include <cstdint>
#include <vector>

#include "absl/types/span.h"
#include "renderlib/base/ids.h"
#include "renderlib/math/rgb.h"
#include "renderlib/math/vec.h"
#include "renderlib/sampling/basis.h"
#include "renderlib/texture/texture.h"

namespace bandsaw {

struct Environment {
  enum class Kind : std::uint8_t {
    /// One image: its middle lies towards +x, the middle of its right half towards +z, its top row
    /// around +y. So three.js and Blender lay such images around a glTF model.
    kEquirectangular,
    /// Six square images of one size: towards +x, -x, +y, -y, +z, -z, each as the OpenGL 4.6
    /// specification, table 8.19, lays it.
    kCube,
  };
  Kind kind = Kind::kEquirectangular;
  std::vector<TextureId> images;  ///< 1 or 6, each an ImageTexture
  float strength = 1;             ///< times what the images hold; >= 0, finite
  /// Its own axes in world space: orthonormal; left-handed where it is mirrored.
  Basis axes{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
};

/// A place in an environment's images; x from the left, y from the top, in texels.
struct EnvironmentPlace {
  std::uint32_t image = 0;
  double x = 0;
  double y = 0;
};

/// Unit directions in world space.
EnvironmentPlace place_of(const Environment& environment, absl::Span<const Texture> textures,
                          const Vec3& unit_direction);
Vec3 direction_of(const Environment& environment, absl::Span<const Texture> textures,
                  const EnvironmentPlace& place);

/// The four texels around a place, as far apart as its fractions say. Equirectangular images go on
/// at their other side; everywhere else the last texel stays.
struct FourTexels {
  std::uint32_t left = 0;
  std::uint32_t right = 0;
  std::uint32_t top = 0;
  std::uint32_t bottom = 0;
  double fx = 0;  ///< share of the right ones
  double fy = 0;  ///< share of the lower ones
};
FourTexels texels_around(const Environment& environment, const ImageTexture& image,
                         const EnvironmentPlace& place);

Rgb radiance(const Environment& environment, absl::Span<const Texture> textures,
             const Vec3& unit_direction);

}  // namespace bandsaw
