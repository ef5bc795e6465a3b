// Limits the values of textures to 1, because pbrt clamps reflectances to 1 when it renders. If an
// image exceeds 1, by itself or by its factor, the converter makes an image with
// the limited values and adds it to the scene as a made file.

#include <algorithm>

#include "absl/strings/str_cat.h"
#include "renderlib/base/status_macros.h"
#include "renderlib/image/write_image.h"
#include "renderlib/import/image/decode_image.h"
#include "renderlib/import/pbrt/builder.h"
#include "renderlib/texture/image_texture.h"

namespace bandsaw::pbrt {
namespace {

/// Maximum number of textures within one texture that are limited one by one. Further textures are
/// scaled. The maximum bounds the time for a hostile scene, in which a texture can contain the
/// same texture very often.
constexpr int kMaxSteps = 100;

/// most_of() returns the largest channel.
double most_of(const Rgb3& rgb) { return *std::max_element(rgb.begin(), rgb.end()); }
double most_of(const scene::Color& color) {
  return *std::max_element(color.rgb().begin(), color.rgb().end());
}

/// Returns the texture `a` times the colour `b`.
scene::Texture product(scene::Texture a, const Rgb3& b) {
  scene::Texture out;
  *out.mutable_product()->mutable_a() = std::move(a);
  *out.mutable_product()->mutable_b() = constant_texture(b);
  return out;
}

/// Returns the colour times `factor`, each channel at most 1.
scene::Texture limited_color(const scene::Color& color, Rgb3 factor) {
  for (int c = 0; c < 3; ++c) {
    double& channel = factor[static_cast<std::size_t>(c)];
    channel = std::min(channel * color.rgb(c), 1.0);
  }
  return constant_texture(factor);
}

/// Limits one texture, with all textures in it.
struct Limiter {
  const Place& place;
  Builder& builder;
  int steps = kMaxSteps;  ///< number of textures that may still be limited one by one

  /// Returns `from` times `factor`, with 1 in place of larger values.
  absl::StatusOr<scene::Texture> times(const scene::Texture& from, const Rgb3& factor) {
    if (from.has_color()) {
      return limited_color(from.color(), factor);
    }
    if (--steps < 0 || largest_value(from, builder) * most_of(factor) <= 1) {
      return scaled(from, factor);
    }
    if (from.has_image()) {
      return image(from, factor);
    }
    if (from.has_use()) {
      for (const scene::Texture& named : builder.out.texture()) {
        if (named.name() == from.use()) {
          return times(named, factor);
        }
      }
    }
    if (from.has_checker()) {
      scene::Texture out = from;
      out.clear_name();
      ASSIGN_OR_RETURN(*out.mutable_checker()->mutable_even(),
                       times(from.checker().even(), factor));
      ASSIGN_OR_RETURN(*out.mutable_checker()->mutable_odd(), times(from.checker().odd(), factor));
      return out;
    }
    if (from.has_product()) {
      const bool is_first = from.product().a().has_color();
      const scene::Texture& by = is_first ? from.product().a() : from.product().b();
      if (by.has_color()) {
        const auto& rgb = by.color().rgb();
        return times(is_first ? from.product().b() : from.product().a(),
                     {factor[0] * rgb[0], factor[1] * rgb[1], factor[2] * rgb[2]});
      }
    }
    return scaled(from, factor);
  }

  /// Returns the texture times `factor`. If this product exceeds 1, warns and scales the product so
  /// that its largest value is 1.
  scene::Texture scaled(const scene::Texture& from, Rgb3 factor) {
    scene::Texture out = from;
    out.clear_name();
    const double most = largest_value(from, builder) * most_of(factor);
    if (most > 1) {
      builder.warn(place, absl::StrCat("a texture reaches ", most,
                                       "; instead of being clamped, it is scaled to reach 1"));
      for (double& channel : factor) {
        channel *= 0.9999999 / most;  // the product must not exceed 1 by rounding
      }
    }
    return factor == Rgb3{1, 1, 1} ? out : product(std::move(out), factor);
  }

  /// Returns the image times `factor`, with 1 in place of larger values, as a made file.
  absl::StatusOr<scene::Texture> image(const scene::Texture& from, const Rgb3& factor) {
    scene::Texture out = from;
    out.clear_name();
    const std::string& file = from.image().file();
    const std::string* made = builder.made.find(file);
    ASSIGN_OR_RETURN(
        const auto bytes,
        made != nullptr ? *made : read_or_warn(file, place, "it is not limited", builder));
    std::vector<std::string> unused;
    auto texels = decode_image(bytes.value_or(""), unused);
    if (!texels.ok()) {
      return error_at(place, absl::StrCat("\"", file, "\": ", texels.status().message()));
    }
    if (texels->format == ImageTexture::Format::kSrgb8 &&
        from.image().encoding() == scene::ImageTexture::ENCODING_LINEAR) {
      texels->format = ImageTexture::Format::kLinear8;
    }
    const auto exr = encode_image(limited_image(*texels, factor), ImageFormat::kExr);
    if (!exr.ok()) {
      return error_at(place, absl::StrCat("\"", file, "\": ", exr.status().message()));
    }
    out.mutable_image()->set_file(builder.made.add(
        "limited", ".exr", std::string(reinterpret_cast<const char*>(exr->data()), exr->size())));
    return out;
  }

  /// Returns the texels times `factor`, each channel at most 1.
  static Image limited_image(const ImageTexture& from, const Rgb3& factor) {
    Image to{from.width, from.height, {}};
    to.pixels.reserve(std::size_t{to.width} * to.height);
    const auto limited = [](float value, double by) {
      return static_cast<float>(std::min(value * by, 1.0));
    };
    for (std::uint32_t y = 0; y < to.height; ++y) {
      for (std::uint32_t x = 0; x < to.width; ++x) {
        const Rgb rgb = texel(from, x, y);
        to.pixels.push_back(
            {limited(rgb.r, factor[0]), limited(rgb.g, factor[1]), limited(rgb.b, factor[2])});
      }
    }
    return to;
  }
};

}  // namespace

double largest_value(const scene::Texture& texture, const Builder& builder) {
  switch (texture.kind_case()) {
    case scene::Texture::kColor:
      return most_of(texture.color());
    case scene::Texture::kImage: {
      const auto known = builder.largest_of_image.find(texture.image().file());
      return known == builder.largest_of_image.end() ? 1 : known->second;
    }
    case scene::Texture::kChecker:
      return std::max(largest_value(texture.checker().even(), builder),
                      largest_value(texture.checker().odd(), builder));
    case scene::Texture::kMix:
      return std::max(largest_value(texture.mix().a(), builder),
                      largest_value(texture.mix().b(), builder));
    case scene::Texture::kProduct:
      return largest_value(texture.product().a(), builder) *
             largest_value(texture.product().b(), builder);
    case scene::Texture::kUse:
      return builder.largest_of_texture.at(texture.use());
    default:
      return 1;  // noise, and ramps to white
  }
}

absl::StatusOr<scene::Texture> limited(scene::Texture texture, const Place& place,
                                       Builder& builder) {
  if (texture.has_color()) {
    return limited_color(texture.color(), {1, 1, 1});
  }
  if (largest_value(texture, builder) <= 1) {
    return texture;
  }
  const std::string name = texture.use();
  const auto known = builder.limited_textures.find(name);
  if (known != builder.limited_textures.end()) {
    return known->second;
  }
  ASSIGN_OR_RETURN(scene::Texture out, (Limiter{place, builder}.times(texture, {1, 1, 1})));
  out = named_texture(name, std::move(out), builder);
  builder.limited_textures.emplace(name, out);
  return out;
}

}  // namespace bandsaw::pbrt
