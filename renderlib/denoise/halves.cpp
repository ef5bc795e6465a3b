// Estimates the error of a denoised image from denoised images of the two parts of its samples. The
// estimate uses nothing else of the filter, so any filter can be used, for example
// OpenImageDenoise.

#include "renderlib/denoise/halves.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "renderlib/denoise/error_sums.h"
#include "renderlib/denoise/maps.h"
#include "renderlib/denoise/prepare.h"

namespace bandsaw {
namespace {

constexpr int kSmoothing = 2;  ///< radius, in pixels, of the mean that smooths the map of errors

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
    if (is_finite(mean) && is_finite(more)) {
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
  const MapSize size{static_cast<int>(clean.width), static_cast<int>(clean.height)};
  const auto row_in_parts = [&](int y) {
    RowInParts row;
    for (std::size_t i = size.index(0, y); i < size.index(0, y + 1); ++i) {
      const Rgb& a = clean_first.pixels[i];
      const Rgb& b = clean_second.pixels[i];
      std::optional<PixelInParts>& pixel = row.emplace_back();
      if (is_finite(a) && is_finite(b)) {
        pixel = rendered_in_parts(input, i);
      }
      if (pixel) {
        pixel->set_filtered(a, b);
      }
    }
    return row;
  };
  Map errors(size.pixels());
  std::vector<RowSums> sums(static_cast<std::size_t>(size.height));
  RowInParts here = row_in_parts(0);
  for (int y = 0; y < size.height; ++y) {
    RowInParts below = y + 1 < size.height ? row_in_parts(y + 1) : RowInParts();
    for (int x = 0; x < size.width; ++x) {
      const RowSums pixel = sums_at(here, below, static_cast<std::size_t>(x));
      errors[size.index(x, y)] = static_cast<float>(std::clamp(pixel.clean / 3, -1e30, 1e30));
      sums[static_cast<std::size_t>(y)].add(pixel);
    }
    here = std::move(below);
  }
  smooth(errors, size, kSmoothing, pool);
  Denoised out{std::move(clean), {input.mean.width, input.mean.height, {}}, {}};
  for (const float error : errors) {
    out.error.pixels.push_back(gray(std::sqrt(std::max(0.0f, error))));
  }
  out.total = total_of(sums, input.rendered_share);
  return out;
}

}  // namespace bandsaw
