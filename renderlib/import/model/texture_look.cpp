#include "renderlib/import/model/texture_look.h"

#include <array>
#include <cmath>

#include "renderlib/math/elementary.h"

namespace bandsaw {

ImageTexture::Wrap wrap_of(aiTextureMapMode mode) {
  switch (mode) {
    case aiTextureMapMode_Clamp:
    case aiTextureMapMode_Decal:
      return ImageTexture::Wrap::kClamp;
    case aiTextureMapMode_Mirror:
      return ImageTexture::Wrap::kMirror;
    default:
      return ImageTexture::Wrap::kRepeat;
  }
}

UvTransform uv_transform_of(const aiUVTransform& from) {
  const double su = from.mScaling.x;
  const double sv = from.mScaling.y;
  constexpr double kTurn = 6.283185307179586;
  const double turns = from.mRotation / kTurn;
  if (!std::isfinite(su) || !std::isfinite(sv) || !std::isfinite(turns) ||
      !std::isfinite(from.mTranslation.x) || !std::isfinite(from.mTranslation.y)) {
    return {};
  }
  const SinCos turn = sincos_turns(turns - std::floor(turns));
  const double a = turn.cos * su;
  const double b = -turn.sin * sv;
  const double c = turn.sin * su;
  const double d = turn.cos * sv;
  // Turned around the middle: R (s uv - m) + m, m = (1/2, 1/2).
  const double mu = 0.5 - 0.5 * (turn.cos - turn.sin);
  const double mv = 0.5 - 0.5 * (turn.sin + turn.cos);
  return {{a, b, mu + from.mTranslation.x, c, d, mv + from.mTranslation.y}};
}

bool looks_like_normals(const ImageTexture& image) {
  if (image.format == ImageTexture::Format::kFloat32 || image.channels != 3) {
    return false;
  }
  const std::size_t texels = image.texels.size() / 3;
  std::array<std::uint64_t, 3> sums{};
  for (std::size_t i = 0; i < 3 * texels; ++i) {
    sums[i % 3] += static_cast<std::uint64_t>(image.texels[i]);
  }
  const auto mean = [&](std::size_t channel) {
    return static_cast<double>(sums[channel]) / (255.0 * static_cast<double>(texels));
  };
  const auto is_about_half = [](double v) { return std::abs(v - 0.5) < 0.1; };
  return is_about_half(mean(0)) && is_about_half(mean(1)) && mean(2) > 0.8;
}

}  // namespace bandsaw
