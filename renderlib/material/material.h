#pragma once

// Parameters of surface materials, as the scene stores them: a kind of scattering, which is one of
// a closed set, and properties that every kind can have. material/bsdf.h turns a material at a
// point into a BSDF that can be sampled.

#include <cstdint>
#include <memory>
#include <optional>
#include <type_traits>
#include <utility>
#include <variant>

#include "renderlib/base/ids.h"
#include "renderlib/math/rgb.h"

namespace bandsaw {

/// Lambertian reflection. Vertex colours multiply the reflectance.
struct Diffuse {
  TextureId reflectance{};
};

/// Metal that scatters light to the mirror direction plus a uniform point in a ball of radius
/// `fuzz` (Shirley et al., "Ray Tracing in One Weekend", 10.6).
struct Metal {
  TextureId reflectance{};                           ///< vertex colours multiply it
  double fuzz = 0;                                   ///< [0, 1]
  std::optional<TextureId> fuzz_map = std::nullopt;  ///< its luminance multiplies `fuzz`
};

/// The distribution of the facets of a rough surface, with one roughness along u and one along v.
/// These numbers are alpha, not its square root.
struct Microfacets {
  enum class Distribution : std::uint8_t { kGgx, kBeckmann };
  enum class Masking : std::uint8_t {
    kSeparable,   ///< G1(wo) G1(wi), as in Walter et al. 2007
    kCorrelated,  ///< masking and shadowing both depend on the facet's height (Heitz 2014)
  };
  Distribution distribution = Distribution::kGgx;
  Masking masking = Masking::kSeparable;
  /// Each alpha is in [0, 1]. The surface is smooth where both are below kMinAlpha
  /// (material/ggx.h).
  double alpha_u = 0;
  double alpha_v = 0;
  std::optional<TextureId> alpha_u_map = std::nullopt;  ///< its luminance multiplies alpha_u
  std::optional<TextureId> alpha_v_map = std::nullopt;

  bool isotropic() const { return alpha_u == alpha_v && alpha_u_map == alpha_v_map; }
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
  /// in between. Not allowed with a priority, because a nested glass has only one index.
  std::optional<TextureId> index_map = std::nullopt;
  std::optional<Microfacets> surface = std::nullopt;  ///< replaces `roughness`
};

/// Emits light and scatters none.
struct Emissive {
  TextureId radiance{};
  bool one_sided = false;  ///< only to the side of the geometric normal
  /// The camera does not see the surface, and the surface stops no light. Scattered rays that meet
  /// the surface from a side to which it emits receive its radiance and go on.
  bool hidden = false;
};

/// A number that may vary over a surface: one channel of the texture times `factor`. Each member of
/// this type says which channel.
struct Channel {
  TextureId texture{};
  double factor = 0;
};

/// A colour that may vary over a surface: the texture times `factor`.
struct Tint {
  TextureId texture{};
  Rgb factor{1, 1, 1};
};

/// The metallic-roughness material of glTF 2.0 (appendix B) with KHR_materials_ior, _clearcoat and
/// _transmission (thin). GGX's alpha is the square of a roughness. The coat covers the emission,
/// and Relief bends the normal of the layer below the coat only.
struct MetallicRoughness {
  Tint base_color;                   ///< [0, 1]; vertex colours multiply it
  Channel metallic;                  ///< channel b; [0, 1]
  Channel roughness;                 ///< channel g; [0, 1]
  double index_of_refraction = 1.5;  ///< index of the dielectric part, [1, 5]
  Channel coat;                      ///< channel r; [0, 1]: weight of a clear coat of index 1.5
  Channel coat_roughness;            ///< channel g; [0, 1]
  Channel transmission;  ///< channel r; [0, 1]: share transmitted instead of diffusely reflected
  std::optional<TextureId> index_map = std::nullopt;  ///< as in Dielectric
  /// Like Relief::normal, for the clear coat alone; without it the coat follows the mesh's shading
  /// normal.
  std::optional<TextureId> coat_normal = std::nullopt;
  double coat_normal_scale = 1;  ///< finite
};

class PlasticCoat;

/// A diffuse surface below a dielectric coat, with the light that is reflected to and fro between
/// the coat and the surface: `plastic` and `roughplastic` of Mitsuba 3.
struct Plastic {
  TextureId reflectance{};           ///< diffuse reflectance; vertex colours multiply it
  double index_of_refraction = 1.5;  ///< index of the coat, (1, 5]
  Microfacets surface = {};          ///< surface of the coat; isotropic
  Rgb specular{1, 1, 1};             ///< factor of the coat's reflection, [0, 1]
  /// True: each reflection inside the coat is tinted, so colours become more saturated. False:
  /// these reflections change the brightness only.
  bool nonlinear = false;
  /// Set by prepare_materials(). It MUST be set before bsdf_at() is called.
  std::shared_ptr<const PlasticCoat> coat = nullptr;
};

/// The complex index of refraction of a metal.
struct ConductorIndex {
  Rgb eta;  ///< real part, (0, 100]
  Rgb k;    ///< imaginary part, [0, 100]
};

/// A metal, given by its index of refraction.
struct Conductor {
  std::optional<ConductorIndex> index = std::nullopt;  ///< without it, everything is reflected
  Microfacets surface = {};
  TextureId specular{};  ///< factor of the reflection, [0, 1]; vertex colours multiply it
};

/// A thin pane of clear glass, with the reflections between its faces. Light passes straight on.
struct ThinDielectric {
  double index_of_refraction = 1.5;  ///< [1, 5]
  Rgb specular{1, 1, 1};             ///< factor of the reflected light, [0, 1]
  Rgb transmission{1, 1, 1};         ///< factor of the transmitted light, [0, 1]
  bool free_passage = false;         ///< light that passes does not count towards max_depth
};

/// Lambertian reflection and transmission. Where reflectance and transmittance add up to more than
/// 1, both are scaled down. Vertex colours multiply both.
struct DiffuseTransmission {
  TextureId reflectance{};
  TextureId transmittance{};
};

/// A number in [0, 1] that may vary over a surface.
struct Number {
  double value = 0;                             ///< [0, 1]
  std::optional<TextureId> map = std::nullopt;  ///< its luminance multiplies `value`
};

/// The principled BSDF of Mitsuba 3 for solid bodies (Burley 2012, "Physically Based Shading at
/// Disney"; 2015, "Extending the Disney BRDF to a BSDF"). Members have the names and meanings of
/// Mitsuba's parameters. If `spec_trans` is 0, both sides reflect; otherwise the side opposite to
/// the normal is inside.
struct Principled {
  TextureId base_color{};            ///< [0, 1]; vertex colours multiply it
  double index_of_refraction = 1.5;  ///< [1, 5]
  Number roughness{0.5};             ///< alpha is its square
  Number anisotropic = {};
  Number metallic = {};
  Number spec_trans = {};
  Number spec_tint = {};
  Number sheen = {};
  Number sheen_tint = {};
  Number flatness = {};
  Number clearcoat = {};
  Number clearcoat_gloss = {};
};

/// The principled BSDF of Mitsuba 3 for thin sheets; members are as in Principled.
struct ThinPrincipled {
  TextureId base_color{};            ///< [0, 1]; vertex colours multiply it
  double index_of_refraction = 1.5;  ///< [1, 5]
  Number roughness{0.5};
  Number anisotropic = {};
  Number spec_trans = {};
  Number spec_tint = {};
  Number sheen = {};
  Number sheen_tint = {};
  Number flatness = {};
  /// Share of the diffuse light that is transmitted. It is half of Mitsuba's parameter diff_trans.
  Number diff_trans = {};
};

/// A mixture: at each point one of two materials is present (material/mixture.h). Both materials
/// precede the mixture in the scene's list, and neither of them is a glass with a priority.
struct Mix {
  MaterialId a{};
  MaterialId b{};
  TextureId amount{};  ///< its luminance is the probability of b, [0, 1]
};

/// Unevenness that changes the shading normal only: a normal map or a height map, not both.
struct Relief {
  /// Normal map: tangent-space directions stored as 0.5 + 0.5 n; b points outwards.
  std::optional<TextureId> normal = std::nullopt;
  double normal_scale = 1;  ///< finite; scales the tangential part
  /// Height map: the surface is shaded as if displaced along its normal by the texture's luminance
  /// times height_scale. The texture is in uv or world space.
  std::optional<TextureId> height = std::nullopt;
  double height_scale = 1;  ///< scene units, finite
};

enum class AlphaMode : std::uint8_t {
  kOpaque,
  kMask,   ///< present where alpha >= cutoff
  kBlend,  ///< present with probability alpha
};

/// Opacity of a surface.
struct Alpha {
  AlphaMode mode = AlphaMode::kOpaque;
  Channel value{{}, 1};    ///< channel r, or the luminance; [0, 1]; unused if kOpaque
  bool luminance = false;  ///< true: the texture's luminance instead of channel r
  double cutoff = 0.5;     ///< >= 0; for kMask
};

/// Radiance that a surface emits, in addition to what it scatters.
struct Emission {
  Tint radiance{{}, {0, 0, 0}};  ///< >= 0; the texture is unused if the factor is black
  bool one_sided = false;        ///< only to the side of the geometric normal
};

/// A kind of scattering, and the properties that every kind can have.
struct Material {
  using Kind =
      std::variant<Diffuse, Metal, Dielectric, Emissive, MetallicRoughness, Plastic, Conductor,
                   ThinDielectric, DiffuseTransmission, Principled, ThinPrincipled, Mix>;

  Material() = default;
  /// The constructor is implicit, so that a kind can stand for a material without further
  /// properties.
  template <class K>
  requires std::is_constructible_v<Kind, K> Material(K of_kind) : kind(std::move(of_kind)) {}

  Kind kind;
  Relief relief;      ///< without effect on Emissive; not with Mix, whose parts have their own
  Alpha alpha;        ///< not with Emissive and Mix
  Emission emission;  ///< not with Emissive and Mix
  /// Scatters nothing on the side opposite to the geometric normal. Not with Mix and materials that
  /// transmit light.
  bool one_sided = false;
};

}  // namespace bandsaw
