// Computes the value of a texture at a point, its maximum, its mean and its repetitions, and finds
// out whether it uses positions in object space. Each of these functions has a visitor of the
// variant, which follows references to other textures.

#include "renderlib/texture/texture.h"

#include <algorithm>

#include "renderlib/texture/blend.h"
#include "renderlib/texture/image_texture.h"
#include "renderlib/texture/procedural.h"

namespace bandsaw {
namespace {

struct Evaluate {
  absl::Span<const Texture> textures;
  const TextureCoordinates& at;

  Rgb of(TextureId id) const { return std::visit(*this, textures[index_of(id)]); }

  Rgb operator()(const ConstantTexture& t) const { return t.value; }
  Rgb operator()(const ImageTexture& t) const { return evaluate(t, at); }
  Rgb operator()(const CheckerTexture& t) const { return of(is_even(t, at) ? t.even : t.odd); }
  Rgb operator()(const NoiseTexture& t) const { return evaluate(t, at); }
  Rgb operator()(const RampTexture& t) const {
    if (t.over != RampTexture::Over::kTexture) {
      return evaluate(t, coordinate(t, at));
    }
    const Rgb inner = of(t.texture);
    return evaluate(t, t.steps ? luminance_exact_for_grays(inner) : luminance(inner));
  }
  Rgb operator()(const MixTexture& t) const {
    const float amount = std::clamp(luminance(of(t.amount)), 0.0f, 1.0f);
    return blend(of(t.a), of(t.b), amount);
  }
  Rgb operator()(const ProductTexture& t) const { return of(t.a) * of(t.b); }
};

struct MaxValue {
  absl::Span<const Texture> textures;

  float of(TextureId id) const { return std::visit(*this, textures[index_of(id)]); }

  float operator()(const ConstantTexture& t) const { return max_component(t.value); }
  float operator()(const ImageTexture& t) const { return max_value(t); }
  float operator()(const CheckerTexture& t) const { return std::max(of(t.even), of(t.odd)); }
  float operator()(const NoiseTexture& t) const {
    return std::max(max_component(t.low), max_component(t.high));
  }
  float operator()(const RampTexture& t) const {
    float most = 0;
    for (const RampTexture::Stop& stop : t.stops) {
      most = std::max(most, max_component(stop.color));
    }
    return most;
  }
  float operator()(const MixTexture& t) const { return std::max(of(t.a), of(t.b)); }
  float operator()(const ProductTexture& t) const { return of(t.a) * of(t.b); }
};

struct Mean {
  absl::Span<const Texture> textures;

  Rgb of(TextureId id) const { return std::visit(*this, textures[index_of(id)]); }
  static Rgb average(const Rgb& a, const Rgb& b) { return (a + b) * 0.5f; }

  Rgb operator()(const ConstantTexture& t) const { return t.value; }
  Rgb operator()(const ImageTexture& t) const { return mean(t); }
  Rgb operator()(const CheckerTexture& t) const { return average(of(t.even), of(t.odd)); }
  Rgb operator()(const NoiseTexture& t) const { return average(t.low, t.high); }
  Rgb operator()(const RampTexture& t) const {
    Rgb sum;
    for (const RampTexture::Stop& stop : t.stops) {
      sum += stop.color;
    }
    return sum * (1 / static_cast<float>(t.stops.size()));
  }
  Rgb operator()(const MixTexture& t) const { return average(of(t.a), of(t.b)); }
  Rgb operator()(const ProductTexture& t) const { return of(t.a) * of(t.b); }
};

struct Repetitions {
  absl::Span<const Texture> textures;
  const TextureCoordinates& change;

  double of(TextureId id) const { return std::visit(*this, textures[index_of(id)]); }

  double operator()(const ConstantTexture&) const { return 0; }
  double operator()(const ImageTexture& t) const { return repetitions(t, change); }
  double operator()(const CheckerTexture& t) const {
    return std::max({repetitions(t, change), of(t.even), of(t.odd)});
  }
  double operator()(const NoiseTexture& t) const { return repetitions(t, change); }
  double operator()(const RampTexture& t) const {
    return t.over == RampTexture::Over::kTexture ? of(t.texture) : repetitions(t, change);
  }
  double operator()(const MixTexture& t) const {
    return std::max({of(t.a), of(t.b), of(t.amount)});
  }
  double operator()(const ProductTexture& t) const { return std::max(of(t.a), of(t.b)); }
};

struct UsesObjectSpace {
  absl::Span<const Texture> textures;

  bool of(TextureId id) const { return std::visit(*this, textures[index_of(id)]); }

  bool operator()(const ConstantTexture&) const { return false; }
  bool operator()(const ImageTexture&) const { return false; }
  bool operator()(const CheckerTexture& t) const {
    return (t.mapping == CheckerTexture::Mapping::kPosition && t.space == Space::kObject) ||
           of(t.even) || of(t.odd);
  }
  bool operator()(const NoiseTexture& t) const { return t.space == Space::kObject; }
  bool operator()(const RampTexture& t) const {
    const bool in_space = t.over == RampTexture::Over::kX || t.over == RampTexture::Over::kY ||
                          t.over == RampTexture::Over::kZ;
    return t.over == RampTexture::Over::kTexture ? of(t.texture)
                                                 : in_space && t.space == Space::kObject;
  }
  bool operator()(const MixTexture& t) const { return of(t.a) || of(t.b) || of(t.amount); }
  bool operator()(const ProductTexture& t) const { return of(t.a) || of(t.b); }
};

}  // namespace

Rgb evaluate(absl::Span<const Texture> textures, TextureId id, const TextureCoordinates& at) {
  return Evaluate{textures, at}.of(id);
}

float max_value(absl::Span<const Texture> textures, TextureId id) {
  return MaxValue{textures}.of(id);
}

Rgb mean(absl::Span<const Texture> textures, TextureId id) { return Mean{textures}.of(id); }

double repetitions(absl::Span<const Texture> textures, TextureId id,
                   const TextureCoordinates& change) {
  return Repetitions{textures, change}.of(id);
}

bool uses_uv(const Texture& texture) {
  if (const auto* checker = std::get_if<CheckerTexture>(&texture)) {
    return checker->mapping == CheckerTexture::Mapping::kUv;
  }
  if (const auto* ramp = std::get_if<RampTexture>(&texture)) {
    return ramp->over == RampTexture::Over::kU || ramp->over == RampTexture::Over::kV;
  }
  return std::holds_alternative<ImageTexture>(texture);
}

bool uses_object_space(absl::Span<const Texture> textures, TextureId id) {
  return UsesObjectSpace{textures}.of(id);
}

}  // namespace bandsaw
