#pragma once

// How surfaces scatter. A closed set of parameters as the scene holds them; material/bsdf.h turns
// one, at a point, into something that can be sampled.

#include <cstdint>
#include <optional>
#include <variant>

#include "renderlib/base/ids.h"
#include "renderlib/math/rgb.h"

namespace bandsaw {

/// Lambertian reflection. Colours of vertices multiply the reflectance.
struct Diffuse {
  TextureId reflectance{};
};

/// The mirror direction plus a uniform point in a ball of radius `fuzz` (Shirley et al., "Ray
/// Tracing in One Weekend", 10.6).
struct Metal {
  TextureId reflectance{};                           ///< colours of vertices multiply it
  double fuzz = 0;                                   ///< [0, 1]
  std::optional<TextureId> fuzz_map = std::nullopt;  ///< its luminance multiplies `fuzz`
};

/// Clear glass.
struct Dielectric {
  double index_of_refraction = 1.5;  ///< inside over outside, [1, 5]
  double roughness = 0;              ///< [0, 1], the square root of GGX's alpha; 0: smooth
  /// Where glasses overlap, the one of the highest priority is there and the others are not. 0:
  /// takes no part, its outside is always empty space.
  std::uint32_t priority = 0;
  std::optional<TextureId> roughness_map = std::nullopt;  ///< its luminance multiplies `roughness`
  /// The index is 1 where its luminance is 0, index_of_refraction where it is 1, linear between.
  /// None where there is a priority: what a path is inside of has one index.
  std::optional<TextureId> index_map = std::nullopt;
};

/// Gives light, scatters none.
struct Emissive {
  TextureId radiance{};
  bool one_sided = false;  ///< only to the side of the geometric normal
};

/// A number that may vary over a surface: one channel of the texture, times `factor`.
struct Channel {
  TextureId texture{};
  double factor = 0;
};

/// A colour that may vary over a surface: the texture times `factor`.
struct Tint {
  TextureId texture{};
  Rgb factor{1, 1, 1};
};

enum class AlphaMode : std::uint8_t {
  kOpaque,
  kMask,   ///< there where alpha >= cutoff, else not there
  kBlend,  ///< there with probability alpha
};

/// glTF 2.0's metallic-roughness material (appendix B) with KHR_materials_ior, _clearcoat,
/// _transmission (thin) and _emissive_strength. Alpha of GGX is the square of a roughness.
struct Principled {
  Tint base_color;                   ///< [0, 1]; vertex colours multiply it
  Channel metallic;                  ///< channel b; [0, 1]
  Channel roughness;                 ///< channel g; [0, 1]
  double index_of_refraction = 1.5;  ///< of what is not metal, [1, 5]
  /// Directions in the frame of the uvs, 0.5 + 0.5 n; b towards the outside.
  std::optional<TextureId> normal;
  double normal_scale = 1;       ///< finite; of the part along the surface
  Tint emissive{{}, {0, 0, 0}};  ///< radiance, >= 0, below the coat
  bool double_sided = false;     ///< emits to both sides; scattering always does
  AlphaMode alpha_mode = AlphaMode::kOpaque;
  Channel alpha{{}, 1};       ///< channel r; [0, 1]
  double alpha_cutoff = 0.5;  ///< of kMask
  Channel coat;               ///< channel r; [0, 1]: a clear coat of index 1.5
  Channel coat_roughness;     ///< channel g; [0, 1]
  Channel transmission;       ///< channel r; [0, 1]: what passes instead of being diffused
  std::optional<TextureId> index_map = std::nullopt;  ///< as Dielectric's
  /// As `normal`, of the clear coat alone; without it the coat is as smooth as the mesh.
  std::optional<TextureId> coat_normal = std::nullopt;
  double coat_normal_scale = 1;  ///< finite
};

using Material = std::variant<Diffuse, Metal, Dielectric, Emissive, Principled>;

}  // namespace bandsaw
