// Estimates the error of a denoised image from denoised images of the two parts of its samples. The
// estimate uses nothing else of the filter, so any filter can be used, for example
// OpenImageDenoise.

#include "renderlib/denoise/halves.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <utility>

#include "renderlib/denoise/maps.h"
#include "renderlib/denoise/prepare.h"
#include "renderlib/denoise/squared_error.h"

namespace bandsaw {
namespace {

constexpr int kSmoothing = 2;  ///< radius, in pixels, of the mean that smooths the map of errors

std::array<double, 3> channels(const Rgb& color) { return {color.r, color.g, color.b}; }

bool finite(const Rgb& color) {
  return std::isfinite(color.r) && std::isfinite(color.g) && std::isfinite(color.b);
}

}  // namespace

Image second_part(const DenoiseInput& input) {
  Image second = input.mean;
  for (std::size_t i = 0; i < second.pixels.size(); ++i) {
    const float share = input.first_share[i];
    if (share > 0 && share < 1) {
      Rgb& pixel = second.pixels[i];
      const Rgb& first = input.first.pixels[i];
      pixel = {second_value(pixel.r, first.r, share), second_value(pixel.g, first.g, share),
               second_value(pixel.b, first.b, share)};
    }
  }
  return second;
}

void add_samples(const Image& image, double samples, Image further, double further_samples,
                 DenoiseInput& input) {
  const double all = samples + further_samples;
  const auto share = static_cast<float>(further_samples / all);
  input.rendered_share = samples / all;
  input.mean = image;
  input.first_share.assign(image.pixels.size(), share);
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    Rgb& mean = input.mean.pixels[i];
    const Rgb& more = further.pixels[i];
    if (finite(mean) && finite(more)) {
      mean = {mean.r + share * (more.r - mean.r), mean.g + share * (more.g - mean.g),
              mean.b + share * (more.b - mean.b)};
    } else {
      input.first_share[i] = 0;
    }
  }
  input.first = std::move(further);
}

Denoised with_error_of_halves(const DenoiseInput& input, Image clean, const Image& clean_first,
                              const Image& clean_second, Pool& pool) {
  const Image second = second_part(input);
  const MapSize size{static_cast<int>(clean.width), static_cast<int>(clean.height)};
  Map errors(size.pixels());
  std::uint64_t pixels = 0;
  double sum = 0;
  double raw = 0;
  double squares = 0;
  double variance = 0;
  for (std::size_t i = 0; i < size.pixels(); ++i) {
    const double share = input.first_share[i];
    if (!(share > 0 && share < 1) || !finite(input.mean.pixels[i]) || !finite(second.pixels[i]) ||
        !finite(clean_first.pixels[i]) || !finite(clean_second.pixels[i])) {
      continue;
    }
    const auto mean = channels(input.mean.pixels[i]);
    const auto of_first = channels(input.first.pixels[i]);
    const auto of_second = channels(second.pixels[i]);
    const auto a = channels(clean_first.pixels[i]);
    const auto b = channels(clean_second.pixels[i]);
    double of_pixel = 0;
    ++pixels;
    for (std::size_t c = 0; c < 3; ++c) {
      const double apart = of_first[c] - of_second[c];
      const InParts<double> value{a[c], b[c], of_first[c], of_second[c], share};
      of_pixel += squared_error(value);
      raw += share * (1 - share) * (apart * apart);
      variance += value.variance();
      sum += mean[c];
    }
    squares += of_pixel;
    errors[i] = static_cast<float>(std::clamp(of_pixel / 3, -1e30, 1e30));
  }
  smooth(errors, size, kSmoothing, pool);
  squares = at_least_variance(squares, variance);
  const double count = 3 * std::max(1.0, static_cast<double>(pixels));
  Denoised out{std::move(clean), {input.mean.width, input.mean.height, {}}, {}};
  for (const float error : errors) {
    out.error.pixels.push_back(gray(std::sqrt(std::max(0.0f, error))));
  }
  out.total = {.mean = sum / count,
               .rmse_raw = std::sqrt(raw / count / input.rendered_share),
               .rmse_clean = std::sqrt(squares / count),
               .bias_share = squares > 0 ? std::clamp(1 - variance / squares, 0.0, 1.0) : 0};
  return out;
}

}  // namespace bandsaw
