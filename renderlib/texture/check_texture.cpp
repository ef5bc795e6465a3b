// CheckParts checks the numbers of each kind of texture, and adds up how many textures one lookup
// of the texture evaluates.

#include "renderlib/texture/check_texture.h"

#include <cmath>
#include <initializer_list>

#include "absl/strings/str_cat.h"
#include "renderlib/base/status_macros.h"

namespace bandsaw {
namespace {

absl::Status invalid(absl::string_view field, absl::string_view why) {
  return absl::InvalidArgumentError(absl::StrCat(field, ": ", why));
}

absl::Status check_finite(absl::string_view field, double value) {
  return std::isfinite(value) ? absl::OkStatus()
                              : invalid(field, absl::StrCat("must be finite, is ", value));
}

absl::Status check_color(absl::string_view field, const Rgb& c) {
  if (is_finite(c) && c.r >= 0 && c.g >= 0 && c.b >= 0) {
    return absl::OkStatus();
  }
  return invalid(field,
                 absl::StrCat("must be finite and >= 0, is [", c.r, ", ", c.g, ", ", c.b, "]"));
}

/// Checks one texture; called by std::visit. The cost of a texture is the number of textures that
/// one lookup of it evaluates.
struct CheckParts {
  std::size_t index;                        ///< index of the texture that is checked
  const std::vector<std::uint64_t>& costs;  ///< costs of the textures before it
  std::uint64_t& cost;                      ///< cost of this texture, to which part() adds

  /// Checks a reference to another texture.
  absl::Status part(absl::string_view field, TextureId id) const {
    if (index_of(id) >= index) {
      return invalid(field, absl::StrCat("must be below ", index,
                                         ", the index of this texture; it is ", index_of(id)));
    }
    cost += costs[index_of(id)];
    return absl::OkStatus();
  }

  absl::Status operator()(const ConstantTexture&) const { return absl::OkStatus(); }

  absl::Status operator()(const ImageTexture& t) const {
    if (t.channels != 1 && t.channels != 3) {
      return invalid("image.channels", absl::StrCat("must be 1 or 3, is ", int{t.channels}));
    }
    for (const double entry : t.uv_transform.m) {
      RETURN_IF_ERROR(check_finite("image.uv_transform", entry));
    }
    return absl::OkStatus();
  }

  absl::Status operator()(const CheckerTexture& t) const {
    for (const double size : {t.size.x, t.size.y, t.size.z}) {
      if (!(std::isfinite(size) && size > 0)) {
        return invalid("checker.size", absl::StrCat("must be finite and > 0, is ", size));
      }
    }
    RETURN_IF_ERROR(part("checker.even", t.even));
    return part("checker.odd", t.odd);
  }

  absl::Status operator()(const NoiseTexture& t) const {
    if (t.octaves < 1 || t.octaves > kMaxOctaves) {
      return invalid("noise.octaves",
                     absl::StrCat("must lie in [1, ", kMaxOctaves, "], is ", t.octaves));
    }
    RETURN_IF_ERROR(check_finite("noise.scale", t.scale));
    RETURN_IF_ERROR(check_finite("noise.strength", t.strength));
    RETURN_IF_ERROR(check_finite("noise.turbulence_scale", t.turbulence_scale));
    for (const double entry : {t.axis.x, t.axis.y, t.axis.z}) {
      RETURN_IF_ERROR(check_finite("noise.axis", entry));
    }
    RETURN_IF_ERROR(check_color("noise.low", t.low));
    return check_color("noise.high", t.high);
  }

  absl::Status operator()(const RampTexture& t) const {
    if (t.stops.empty() || t.stops.size() > kMaxRampStops) {
      return invalid("ramp.stop", absl::StrCat("must have 1 to ", kMaxRampStops, " stops; it has ",
                                               t.stops.size()));
    }
    for (std::size_t i = 0; i < t.stops.size(); ++i) {
      const std::string field = absl::StrCat("ramp.stop[", i, "]");
      RETURN_IF_ERROR(check_finite(field + ".at", t.stops[i].at));
      RETURN_IF_ERROR(check_color(field + ".color", t.stops[i].color));
      if (i > 0 && !(t.stops[i].at > t.stops[i - 1].at)) {
        return invalid(field + ".at",
                       absl::StrCat("must be above ", t.stops[i - 1].at,
                                    ", the position of the stop before; it is ", t.stops[i].at));
      }
    }
    return t.over == RampTexture::Over::kTexture ? part("ramp.texture", t.texture)
                                                 : absl::OkStatus();
  }

  absl::Status operator()(const MixTexture& t) const {
    RETURN_IF_ERROR(part("mix.a", t.a));
    RETURN_IF_ERROR(part("mix.b", t.b));
    return part("mix.amount", t.amount);
  }

  absl::Status operator()(const ProductTexture& t) const {
    RETURN_IF_ERROR(part("product.a", t.a));
    return part("product.b", t.b);
  }
};

}  // namespace

absl::Status check_parts(absl::Span<const Texture> textures, std::size_t index,
                         std::vector<std::uint64_t>& cost) {
  std::uint64_t own = 1;
  RETURN_IF_ERROR(std::visit(CheckParts{index, cost, own}, textures[index]));
  if (own > kMaxTextureParts) {
    return absl::InvalidArgumentError(absl::StrCat(
        "look-up: must evaluate at most ", kMaxTextureParts, " textures; it evaluates ", own));
  }
  cost.push_back(own);
  return absl::OkStatus();
}

}  // namespace bandsaw
