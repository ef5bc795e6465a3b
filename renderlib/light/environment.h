#pragma once

// Environment maps: images around the scene, seen by rays that leave it. They are looked up by
// direction, with bilinear interpolation between texels.

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
    /// One latitude-longitude image: its centre points towards +x, the centre of its right half
    /// towards +z, its top row is around +y. This is how three.js and Blender orient such images
    /// around a glTF model.
    kEquirectangular,
    /// Six square images of equal size for +x, -x, +y, -y, +z, -z, each oriented as in the OpenGL
    /// 4.6 specification, table 8.19.
    kCube,
  };
  Kind kind = Kind::kEquirectangular;
  std::vector<TextureId> images;  ///< 1 or 6, each an ImageTexture
  float strength = 1;             ///< scales the images' radiance; >= 0, finite
  /// The map's axes in world space: orthonormal; left-handed if it is mirrored.
  Basis axes{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
};

/// A position in an environment's images, in texels; x from the left, y from the top.
struct EnvironmentPlace {
  std::uint32_t image = 0;
  double x = 0;
  double y = 0;
};

/// Returns the position in the images of a unit direction in world space. In all functions of this
/// file, `textures` are those of the scene.
EnvironmentPlace place_of(const Environment& environment, absl::Span<const Texture> textures,
                          const Vec3& unit_direction);
/// Returns the unit direction, in world space, of a position in the images.
Vec3 direction_of(const Environment& environment, absl::Span<const Texture> textures,
                  const EnvironmentPlace& place);

/// Columns and rows of the four texels around a position, and the bilinear weights of the position.
/// Latitude-longitude images wrap around horizontally; all other edges are clamped.
struct FourTexels {
  std::uint32_t left = 0;
  std::uint32_t right = 0;
  std::uint32_t top = 0;
  std::uint32_t bottom = 0;
  double fx = 0;  ///< weight of the right column
  double fy = 0;  ///< weight of the lower row
};
/// Returns the four texels around `place`. `image` is the image that contains `place`.
FourTexels texels_around(const Environment& environment, const ImageTexture& image,
                         const EnvironmentPlace& place);

/// Returns the interpolated radiance, times `strength`, in a unit direction in world space.
Rgb radiance(const Environment& environment, absl::Span<const Texture> textures,
             const Vec3& unit_direction);

}  // namespace bandsaw
