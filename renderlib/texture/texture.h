#pragma once

// Textures: colours that may vary over a surface or through space, as a closed set (a
// std::variant). Textures may refer to others, which precede them in the scene's list, so there are
// no cycles. Materials, environment maps and projectors use them (material/look_up.h, light/).

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <variant>
#include <vector>

#include "absl/types/span.h"
#include "renderlib/base/ids.h"
#include "renderlib/base/shared_bytes.h"
#include "renderlib/math/rgb.h"
#include "renderlib/math/vec.h"
#include "renderlib/texture/coordinates.h"

namespace bandsaw {

struct ConstantTexture {
  Rgb value;
};

/// Affine transform of uv coordinates: (a u + b v + c, d u + e v + f).
struct UvTransform {
  std::array<double, 6> m{1, 0, 0, 0, 1, 0};
  Vec2 operator()(const Vec2& uv) const {
    return {m[0] * uv.x + m[1] * uv.y + m[2], m[3] * uv.x + m[4] * uv.y + m[5]};
  }
  friend bool operator==(const UvTransform&, const UvTransform&) = default;
};

/// An image. Its texels keep their original format: an 8-bit image takes a byte per channel and
/// texel. They may lie in a mapped file.
struct ImageTexture {
  /// kSrgb8: 8 bits with the transfer function of sRGB. kLinear8: 8 bits, linear (255 is 1).
  /// kFloat32: linear floats.
  enum class Format : std::uint8_t { kSrgb8, kLinear8, kFloat32 };
  enum class Wrap : std::uint8_t { kRepeat, kClamp, kMirror };
  enum class Filter : std::uint8_t { kBilinear, kNearest };

  std::uint32_t width = 0;   ///< >= 1
  std::uint32_t height = 0;  ///< >= 1
  Format format = Format::kSrgb8;
  Wrap wrap = Wrap::kRepeat;
  Filter filter = Filter::kBilinear;
  SharedBytes texels;         ///< rows from the top (v = 1) down, without padding
  std::uint8_t channels = 3;  ///< 3; or 1 for a grey image
  UvSet uv_set = UvSet::kFirst;
  UvTransform uv_transform;
  /// Vertical wrap mode if it differs from `wrap`, as for a map on a sphere, which repeats in u
  /// alone.
  std::optional<Wrap> wrap_v = std::nullopt;

  Wrap v_wrap() const { return wrap_v.value_or(wrap); }
};

/// Returns the size of the texels of an image, in bytes.
std::uint64_t texel_bytes(const ImageTexture& image);

/// Alternates two textures in cells, which are rectangles of the uv plane or boxes of space. Each
/// cell begins early, so that a plane on a border between cells has one texture. It begins early by
/// 2^-20 of its size, or by more if rounding errors are larger.
struct CheckerTexture {
  enum class Mapping : std::uint8_t { kUv, kPosition };
  TextureId even{};  ///< texture of the cell that begins at the origin
  TextureId odd{};
  Mapping mapping = Mapping::kUv;
  Vec3 size{1, 1, 1};  ///< size of a cell, each component > 0; z is used by kPosition alone
  UvSet uv_set = UvSet::kFirst;
  Space space = Space::kWorld;
};

/// The colour low + (high - low) t, with t in [0, 1] from texture/noise.h at the point p, as in
/// Shirley et al., "Ray Tracing: The Next Week", chapter 5.
struct NoiseTexture {
  enum class Kind : std::uint8_t {
    kNoise,       ///< t = (1 + noise(scale p)) / 2
    kTurbulence,  ///< t = min(1, turbulence(scale p))
    kMarble,      ///< t = (1 + sin(scale axis.p + strength turbulence(p turbulence_scale))) / 2
  };
  Kind kind = Kind::kNoise;
  Space space = Space::kWorld;
  std::uint32_t octaves = 7;    ///< octaves of the turbulence, [1, 16]
  double scale = 1;             ///< finite
  double strength = 10;         ///< finite
  double turbulence_scale = 1;  ///< finite
  Vec3 axis{0, 0, 1};           ///< finite
  Rgb low{0, 0, 0};
  Rgb high{1, 1, 1};
};

/// Maps a number to a colour. The number is another texture's luminance, or a coordinate.
struct RampTexture {
  enum class Over : std::uint8_t { kTexture, kU, kV, kX, kY, kZ };
  struct Stop {
    double at = 0;
    Rgb color;
  };
  Over over = Over::kTexture;  ///< the number that is mapped: the luminance, or this coordinate
  TextureId texture{};         ///< for kTexture alone
  UvSet uv_set = UvSet::kFirst;
  Space space = Space::kWorld;
  /// If true, the colour is constant from each stop to the next; otherwise it is interpolated
  /// linearly between stops.
  bool steps = false;
  /// At least one stop; `at` is finite and strictly increasing. Values before the first stop get
  /// the colour of the first stop, and values after the last stop get the colour of the last stop.
  std::vector<Stop> stops;
};

/// a + (b - a) t, where t is the luminance of `amount` clamped to [0, 1].
struct MixTexture {
  TextureId a{};
  TextureId b{};
  TextureId amount{};
};

/// a times b, by channel.
struct ProductTexture {
  TextureId a{};
  TextureId b{};
};

using Texture = std::variant<ConstantTexture, ImageTexture, CheckerTexture, NoiseTexture,
                             RampTexture, MixTexture, ProductTexture>;

/// Returns the colour of textures[id]. Coordinates that are not finite count as 0, except in a ramp
/// over a coordinate. There, NaN counts as a value before the first stop, and infinities are not
/// changed. Filtering is done on linear values.
Rgb evaluate(absl::Span<const Texture> textures, TextureId id, const TextureCoordinates& at);

/// Returns an upper bound of all channels, for energy checks and light bounds; 1 for 8-bit images.
float max_value(absl::Span<const Texture> textures, TextureId id);

/// Returns the linear mean. It is exact for images. For other textures it is an estimate, which is
/// black only if the texture is black everywhere.
Rgb mean(absl::Span<const Texture> textures, TextureId id);

/// Returns about how many times textures[id] repeats between two points whose coordinates differ by
/// `change`; >= 0, not rounded. A repetition is a whole image, a cell of a checker, a cell of the
/// lattice of noise, a vein of marble or, for a ramp over a coordinate, the distance from its first
/// to its last stop. If the texture refers to other textures, the result is the largest number of
/// repetitions among them and the texture itself. Constants give 0.
double repetitions(absl::Span<const Texture> textures, TextureId id,
                   const TextureCoordinates& change);

/// Returns true if the texture itself uses uv coordinates; textures that it refers to do not count.
bool uses_uv(const Texture& texture);

/// Returns true if textures[id] or one that it refers to uses positions in object space.
bool uses_object_space(absl::Span<const Texture> textures, TextureId id);

}  // namespace bandsaw
