#pragma once

// Parameters of surface materials, as the scene stores them. A closed set; material/bsdf.h turns a
// material at a point into a BSDF that can be sampled.

#include <cstdint>
#include <optional>
#include <variant>

#include "renderlib/base/ids.h"
#include "renderlib/math/rgb.h"

namespace bandsaw {

/// Lambertian reflection. Vertex colours multiply the reflectance.
struct Diffuse {
  TextureId reflectance{};
};

/// The mirror direction plus a uniform point in a ball of radius `fuzz` (Shirley et al., "Ray
/// Tracing in One Weekend", 10.6).
struct Metal {
  TextureId reflectance{};                           ///< vertex colours multiply it
  double fuzz = 0;                                   ///< [0, 1]
  std::optional<TextureId> fuzz_map = std::nullopt;  ///< its luminance multiplies `fuzz`
};

/// Clear glass.
struct Dielectric {
  double index_of_refraction = 1.5;  ///< inside over outside, [1, 5]
  double roughness = 0;              ///< [0, 1], the square root of GGX's alpha; 0: smooth
  /// If glasses overlap, only the one of highest priority is present. 0: the glass takes no part in
  /// this, and its outside is always empty space.
  std::uint32_t priority = 0;
  std::optional<TextureId> roughness_map = std::nullopt;  ///< its luminance multiplies `roughness`
  /// The index is 1 where the map's luminance is 0, index_of_refraction where it is 1, and linear
  /// in between. Not allowed with a priority: a glass that contains a path has one index.
  std::optional<TextureId> index_map = std::nullopt;
};

/// Emits light and scatters none.
struct Emissive {
  TextureId radiance{};
  bool one_sided = false;  ///< only to the side of the geometric normal
};

/// A number that may vary over a surface: one channel of the texture times `factor`.
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
  kMask,   ///< present where alpha >= cutoff
  kBlend,  ///< present with probability alpha
};

/// The metallic-roughness material of glTF 2.0 (appendix B) with KHR_materials_ior, _clearcoat,
/// _transmission (thin) and _emissive_strength. GGX's alpha is the square of a roughness.
struct Principled {
  Tint base_color;                   ///< [0, 1]; vertex colours multiply it
  Channel metallic;                  ///< channel b; [0, 1]
  Channel roughness;                 ///< channel g; [0, 1]
  double index_of_refraction = 1.5;  ///< of the dielectric part, [1, 5]
  /// Normal map: tangent-space directions stored as 0.5 + 0.5 n; b points outwards.
  std::optional<TextureId> normal;
  double normal_scale = 1;       ///< finite; scales the tangential part
  Tint emissive{{}, {0, 0, 0}};  ///< radiance, >= 0, below the coat
  bool double_sided = false;     ///< emits to both sides; scattering always does
  AlphaMode alpha_mode = AlphaMode::kOpaque;
  Channel alpha{{}, 1};       ///< channel r; [0, 1]
  double alpha_cutoff = 0.5;  ///< for kMask
  Channel coat;               ///< channel r; [0, 1]: weight of a clear coat of index 1.5
  Channel coat_roughness;     ///< channel g; [0, 1]
  Channel transmission;  ///< channel r; [0, 1]: share transmitted instead of diffusely reflected
  std::optional<TextureId> index_map = std::nullopt;  ///< as in Dielectric
  /// Like `normal`, for the clear coat alone; without it the coat follows the mesh's shading
  /// normal.
  std::optional<TextureId> coat_normal = std::nullopt;
  double coat_normal_scale = 1;  ///< finite
};

using Material = std::variant<Diffuse, Metal, Dielectric, Emissive, Principled>;

}  // namespace bandsaw
