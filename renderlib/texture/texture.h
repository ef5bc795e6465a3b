#pragma once

// A colour that may vary over a surface or through space. A closed set. Textures may be made of
// others, which stand before them in the scene's list: so there are no cycles.

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

/// Where in an image a uv is looked up: (a u + b v + c, d u + e v + f).
struct UvTransform {
  std::array<double, 6> m{1, 0, 0, 0, 1, 0};
  Vec2 operator()(const Vec2& uv) const {
    return {m[0] * uv.x + m[1] * uv.y + m[2], m[3] * uv.x + m[4] * uv.y + m[5]};
  }
  friend bool operator==(const UvTransform&, const UvTransform&) = default;
};

/// Texels stay in the format they came in: an 8-bit image costs a byte a channel and texel. They
/// may lie in a mapped file.
struct ImageTexture {
  enum class Format : std::uint8_t { kSrgb8, kLinear8, kFloat32 };
  enum class Wrap : std::uint8_t { kRepeat, kClamp, kMirror };
  enum class Filter : std::uint8_t { kBilinear, kNearest };

  std::uint32_t width = 0;   ///< >= 1
  std::uint32_t height = 0;  ///< >= 1
  Format format = Format::kSrgb8;
  Wrap wrap = Wrap::kRepeat;
  Filter filter = Filter::kBilinear;
  SharedBytes texels;         ///< rows from the top (v = 1) down, no padding
  std::uint8_t channels = 3;  ///< 3, or 1: grey
  UvSet uv_set = UvSet::kFirst;
  UvTransform uv_transform;
  std::optional<Wrap> wrap_v =
      std::nullopt;  ///< where it is not that of u: a map on a sphere repeats in u alone

  Wrap v_wrap() const { return wrap_v.value_or(wrap); }
};

/// How many bytes the texels of an image of this size take.
std::uint64_t texel_bytes(const ImageTexture& image);

/// Two textures by turns: in squares of the uv plane, or in boxes of space. A coordinate counts to
/// the next cell when it is nearer to it than 2^-20 of a cell (or its rounding), so that a plane
/// that lies on a border between cells has one side.
struct CheckerTexture {
  enum class Mapping : std::uint8_t { kUv, kPosition };
  TextureId even{};  ///< of the cell that begins at the origin
  TextureId odd{};
  Mapping mapping = Mapping::kUv;
  Vec3 size{1, 1, 1};  ///< of a cell, each > 0; z is of kPosition alone
  UvSet uv_set = UvSet::kFirst;
  Space space = Space::kWorld;
};

/// low + (high - low) t with t in [0, 1] from texture/noise.h, as Shirley et al., "Ray Tracing: The
/// Next Week", chapter 5.
struct NoiseTexture {
  enum class Kind : std::uint8_t {
    kNoise,       ///< t = (1 + noise(scale p)) / 2
    kTurbulence,  ///< t = min(1, turbulence(scale p))
    kMarble,      ///< t = (1 + sin(scale axis.p + strength turbulence(p turbulence_scale))) / 2
  };
  Kind kind = Kind::kNoise;
  Space space = Space::kWorld;
  std::uint32_t octaves = 7;    ///< of the turbulence, [1, 16]
  double scale = 1;             ///< finite
  double strength = 10;         ///< finite
  double turbulence_scale = 1;  ///< finite
  Vec3 axis{0, 0, 1};           ///< finite
  Rgb low{0, 0, 0};
  Rgb high{1, 1, 1};
};

/// A colour by a number: another texture's luminance, or a coordinate.
struct RampTexture {
  enum class Over : std::uint8_t { kTexture, kU, kV, kX, kY, kZ };
  struct Stop {
    double at = 0;
    Rgb color;
  };
  Over over = Over::kTexture;
  TextureId texture{};  ///< of kTexture alone
  UvSet uv_set = UvSet::kFirst;
  Space space = Space::kWorld;
  bool steps = false;       ///< each colour from its stop to the next; else linear between stops
  std::vector<Stop> stops;  ///< at least one; `at` finite and rising. Before the first and after
                            ///< the last: their colour.
};

/// a + (b - a) t, t the luminance of `amount` brought into [0, 1].
struct MixTexture {
  TextureId a{};
  TextureId b{};
  TextureId amount{};
};

/// a times b, channel by channel.
struct ProductTexture {
  TextureId a{};
  TextureId b{};
};

using Texture = std::variant<ConstantTexture, ImageTexture, CheckerTexture, NoiseTexture,
                             RampTexture, MixTexture, ProductTexture>;

/// The colour of textures[id] there. Any coordinates; those that are not finite count as 0.
/// Filtering is done on linear values.
Rgb evaluate(absl::Span<const Texture> textures, TextureId id, const TextureCoordinates& at);

/// No channel is larger anywhere: what energy checks and light power bounds use. 8-bit images: 1.
float max_value(absl::Span<const Texture> textures, TextureId id);

/// The mean, linear: of images exactly, over all texels; of others an estimate that is black only
/// where they are black everywhere.
Rgb mean(absl::Span<const Texture> textures, TextureId id);

/// Whether the texture itself, not one that it refers to, is looked up by uv.
bool uses_uv(const Texture& texture);

}  // namespace bandsaw
