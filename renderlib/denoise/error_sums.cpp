// Estimates the errors of an image as rendered ("raw") and without noise ("clean"). The samples of
// each pixel are in two parts. For each channel of a pixel, InParts (squared_error.h) holds the
// means of both parts as rendered (`first`, `second`) and filtered (`a`, `b`). Each pixel adds its
// estimates to the sums of its row, and total_of() computes the errors of the whole image from the
// sums of all rows.
//
// The squared error of the clean image is estimated in two ways. The first estimate compares the
// filtered value of one part with the rendered value of the other (`clean`). The second is the
// noise that is left (`variance`) plus the squared bias (`bias`). The bias is found from pairs of
// neighbours: their noise is independent, so on average the product of their errors is the product
// of their biases.

#include "renderlib/denoise/error_sums.h"

#include <algorithm>
#include <cmath>

#include "renderlib/denoise/prepare.h"

namespace bandsaw {
namespace {

float channel(const Rgb& color, std::size_t c) {
  return c == 0 ? color.r : c == 1 ? color.g : color.b;
}

}  // namespace

void PixelInParts::set_filtered(const Rgb& a, const Rgb& b) {
  rendered = false;
  for (std::size_t c = 0; c < 3; ++c) {
    channels[c].a = channel(a, c);
    channels[c].b = channel(b, c);
  }
}

std::optional<PixelInParts> rendered_in_parts(const DenoiseInput& input, std::size_t at) {
  const float share = input.first_share[at];
  if (!(share > 0 && share < 1)) {
    return std::nullopt;
  }
  PixelInParts pixel{.rendered = true, .channels = {}};
  for (std::size_t c = 0; c < 3; ++c) {
    const float of_first = channel(input.first.pixels[at], c);
    const double first = of_first;
    const double second = second_value(channel(input.mean.pixels[at], c), of_first, share);
    // The second mean is computed from the first and from the mean of all samples, and is not
    // finite if one of these is not.
    if (!std::isfinite(second)) {
      return std::nullopt;
    }
    pixel.channels[c] = {.a = first, .b = second, .first = first, .second = second, .share = share};
  }
  return pixel;
}

void RowSums::add(const RowSums& other) {
  pixels += other.pixels;
  value += other.value;
  raw += other.raw;
  clean += other.clean;
  variance += other.variance;
  bias += other.bias;
  pairs += other.pairs;
}

void RowSums::add(const PixelInParts& pixel) {
  ++pixels;
  for (const InParts<double>& in : pixel.channels) {
    const double apart = in.first - in.second;
    clean += squared_error(in);
    variance += in.variance();
    raw += in.share * (1 - in.share) * (apart * apart);
    value += in.share * in.first + (1 - in.share) * in.second;
  }
}

void RowSums::add_bias(const PixelInParts& pixel, const std::optional<PixelInParts>& neighbour) {
  if (!neighbour) {
    return;
  }
  pairs += 3;  // one for each channel
  if (!pixel.rendered && !neighbour->rendered) {
    for (std::size_t c = 0; c < 3; ++c) {
      bias += common_bias(pixel.channels[c], neighbour->channels[c]);
    }
  }
}

RowSums sums_at(const RowInParts& here, const RowInParts& below, std::size_t x) {
  RowSums sums;
  if (here[x]) {
    sums.add(*here[x]);
    if (x + 1 < here.size()) {
      sums.add_bias(*here[x], here[x + 1]);
    }
    if (!below.empty()) {
      sums.add_bias(*here[x], below[x]);
    }
  }
  return sums;
}

CleanError total_of(absl::Span<const RowSums> rows, double rendered_share) {
  RowSums all;
  for (const RowSums& row : rows) {
    all.add(row);
  }
  const double count = 3 * std::max(1.0, static_cast<double>(all.pixels));
  // The mean product of the biases over all pairs of neighbours, times the number of values.
  const double bias = all.pairs > 0 ? all.bias * (count / static_cast<double>(all.pairs)) : 0;
  // The larger one of the two estimates is taken (README.md, "The estimated error").
  all.clean = std::max(all.clean, all.variance + std::max(0.0, bias));
  // Noise is inversely proportional to the number of samples, and the image as rendered has only
  // `rendered_share` of them.
  return {.mean = all.value / count,
          .rmse_raw = std::sqrt(all.raw / count / rendered_share),
          .rmse_clean = std::sqrt(all.clean / count),
          .bias_share = all.clean > 0 ? std::clamp(1 - all.variance / all.clean, 0.0, 1.0) : 0};
}

}  // namespace bandsaw
