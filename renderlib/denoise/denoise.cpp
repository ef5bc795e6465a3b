// For each strip of the image, denoise() prepares planes, filters them with a narrow and a wide
// filter (fit.h), estimates the squared error of both and of the rendered value (squared_error.h),
// and blends the three by these errors (Selection).
//
// The samples of each pixel are divided into two parts. Their means are the two halves of the
// image, and `first_share` is the share of the first part in a pixel's samples. Each half is
// filtered alone. As the halves are independent, the error of the filter can be estimated: one half
// after the filter is compared with the other half before the filter.

#include "renderlib/denoise/denoise.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <utility>

#include "renderlib/denoise/error_sums.h"
#include "renderlib/denoise/maps.h"
#include "renderlib/denoise/prepare.h"
#include "renderlib/denoise/squared_error.h"

namespace bandsaw {
namespace {

/// A narrow and a wide filter, between which Selection chooses pixel by pixel.
constexpr FilterSettings kSettings = {
    FitSettings{
        .color_reach = 0.7f, .albedo_reach = 2, .normal_reach = 0.3f, .depth_reach = 0.025f},
    FitSettings{
        .color_reach = 1.5f, .albedo_reach = 2, .normal_reach = 0.3f, .depth_reach = 0.05f}};
/// Shares of the rendered value (first) and of each filter in a pixel's value; their sum is 1.
using Shares = std::array<Map, 1 + kFilters>;

/// A strip of the image: some rows that are filtered together with the rows around them.
struct Strip {
  const DenoiseInput& input;
  const ImageMeans& means;
  RowSpan rows;   ///< rows whose result is wanted
  int first = 0;  ///< row of the image that is row 0 of the planes
  FitInput planes;
  FitOutputs fits;
};

/// Chooses between the filters and the rendered value in a strip. Coordinates and maps cover only
/// the rows that were filtered: row 0 of a map is row planes_.wanted.first of the planes.
class Selection {
 public:
  Selection(const Strip& strip, Pool& pool)
      : strip_(strip),
        planes_(strip.planes),
        pool_(pool),
        size_{planes_.width, planes_.wanted.count()},
        smoothing_(planes_, pool) {
    choose();
  }

  /// Writes the strip's rows of the image and of the errors, and their sums.
  void write(Denoised& out, std::vector<RowSums>& sums) const;

 private:
  /// Calls f(x, y, index) for all pixels, on the threads of the pool.
  template <class F>
  void each(F f) const {
    pool_.parallel_for(size_.height, [&](std::int64_t row) {
      const int y = static_cast<int>(row);
      for (int x = 0; x < size_.width; ++x) {
        f(x, y, size_.index(x, y));
      }
    });
  }
  /// Returns the row of the planes that is row y of the maps.
  int plane_row(int y) const { return y + planes_.wanted.first; }
  /// Returns the index of a pixel in the whole image.
  std::size_t in_image(int x, int y) const { return size_.index(x, strip_.first + plane_row(y)); }
  /// Returns half h as it was rendered, for channel c.
  float half(std::size_t h, std::size_t c, int x, int y) const {
    return planes_.halves[h][c].at(x, plane_row(y));
  }
  bool valid(int x, int y) const { return planes_.valid.at(x, plane_row(y)) > 0; }
  /// Returns 1 / (brightness^2 + offset) for each pixel, so that relative errors are compared. The
  /// brightness is that of the filtered pixel, or that of the darker half of the rendered pixel if
  /// this is larger: a bright detail that both halves show must not count as noise. The offset is 3
  /// % of the squared mean of the image, so that dark pixels do not dominate.
  Map scales() const;
  Map error_of(std::size_t candidate, const Map& scale) const;
  /// How much larger the estimated error of a filter is than that of the rendered value.
  struct Excess {
    Map mean;       ///< over the pixels around, within the surface
    Map deviation;  ///< standard error of the mean, if the pixels are independent
  };
  Excess excess_of(const Map& filtered, const Map& rendered) const;
  /// Sets shares_: at each pixel, chooses the filter with the smaller estimated error, or the
  /// rendered value if this error is larger than that of the rendered value by more than the
  /// standard error of the difference. Then smooths the choices. Without the standard error, a
  /// single pixel could make the 25 pixels around it stay noisy.
  void choose();
  /// Returns true if the pixel stays as it was rendered.
  bool is_rendered(int x, int y) const;
  /// Returns half `h` of the result at a pixel.
  Rgb mixed(int x, int y, std::size_t h) const;
  /// Returns the pixel of the result: the rendered value, or the mean of both mixed halves,
  /// weighted by their shares of the samples.
  Rgb value_of(int x, int y) const;
  /// Returns row y. A pixel without finite parts has no value.
  RowInParts row_in_parts(int y) const;

  const Strip& strip_;
  const FitInput& planes_;
  Pool& pool_;
  MapSize size_;
  SurfaceSmoothing smoothing_;
  Shares shares_;
};

Map Selection::scales() const {
  const float mean = strip_.means.brightness;
  Map scales(size_.pixels());
  each([&](int x, int y, std::size_t i) {
    float filtered = 0;
    float darker = std::numeric_limits<float>::max();
    for (std::size_t h = 0; h < 2; ++h) {
      const auto& part = strip_.fits.back().halves[h];
      filtered += ((part[0][i] + part[1][i]) + part[2][i]) / 6;
      darker = std::min(darker, ((half(h, 0, x, y) + half(h, 1, x, y)) + half(h, 2, x, y)) / 3);
    }
    const float bright = std::max(filtered, darker);
    scales[i] = 1 / (bright * bright + 0.03f * mean * mean + 1e-30f);
  });
  return scales;
}

/// Returns the estimated squared error of a candidate, times `scale`. Candidate 0 is the rendered
/// value, and candidate k > 0 is filter k - 1.
Map Selection::error_of(std::size_t candidate, const Map& scale) const {
  Map error(size_.pixels());
  each([&](int x, int y, std::size_t i) {
    const float share = strip_.input.first_share[in_image(x, y)];
    float sum = 0;
    for (std::size_t c = 0; c < 3; ++c) {
      const float first = half(0, c, x, y);
      const float second = half(1, c, x, y);
      const float a = candidate == 0 ? first : strip_.fits[candidate - 1].halves[0][c][i];
      const float b = candidate == 0 ? second : strip_.fits[candidate - 1].halves[1][c][i];
      sum += squared_error(InParts<float>{a, b, first, second, share});
    }
    error[i] = valid(x, y) ? sum * scale[i] : 0;
  });
  return error;
}

/// Returns the filter's error minus `rendered`, both from error_of(), as a mean over the pixels
/// around. Adds its standard error.
Selection::Excess Selection::excess_of(const Map& filtered, const Map& rendered) const {
  constexpr auto kPixels = static_cast<float>(SurfaceSmoothing::kSide * SurfaceSmoothing::kSide);
  Excess excess{Map(size_.pixels()), Map(size_.pixels())};
  each([&](int, int, std::size_t i) {
    excess.mean[i] = filtered[i] - rendered[i];
    excess.deviation[i] = excess.mean[i] * excess.mean[i];
  });
  smoothing_.apply(excess.mean, pool_);
  smoothing_.apply(excess.deviation, pool_);
  each([&](int, int, std::size_t i) {
    const float variance = excess.deviation[i] - excess.mean[i] * excess.mean[i];
    excess.deviation[i] = std::sqrt(std::max(0.0f, variance) / kPixels);
  });
  return excess;
}

void Selection::choose() {
  static_assert(kFilters == 2);
  const Map scale = scales();
  const Map rendered = error_of(0, scale);
  const Excess narrow = excess_of(error_of(1, scale), rendered);
  const Excess wide = excess_of(error_of(2, scale), rendered);
  for (Map& share : shares_) {
    share.assign(size_.pixels(), 0);
  }
  each([&](int, int, std::size_t i) {
    const bool is_wide = wide.mean[i] < narrow.mean[i];
    const Excess& best = is_wide ? wide : narrow;
    const bool is_worse = best.mean[i] > best.deviation[i];
    shares_[is_worse ? 0 : is_wide ? 2 : 1][i] = 1;
  });
  // Sharp limits between regions of different filters would be visible.
  for (Map& share : shares_) {
    smoothing_.apply(share, pool_);
  }
}

Rgb Selection::mixed(int x, int y, std::size_t h) const {
  const std::size_t i = size_.index(x, y);
  const auto channel = [&](std::size_t c) {
    float value = shares_[0][i] * half(h, c, x, y);
    for (std::size_t k = 0; k < kFilters; ++k) {
      value += shares_[k + 1][i] * strip_.fits[k].halves[h][c][i];
    }
    return value;
  };
  return {channel(0), channel(1), channel(2)};
}

bool Selection::is_rendered(int x, int y) const {
  const std::size_t i = size_.index(x, y);
  return !valid(x, y) || !(shares_[1][i] + shares_[2][i] > 0);
}

Rgb Selection::value_of(int x, int y) const {
  const std::size_t at = in_image(x, y);
  if (is_rendered(x, y)) {
    return strip_.input.mean.pixels[at];
  }
  return lerp(mixed(x, y, 1), mixed(x, y, 0), strip_.input.first_share[at]);
}

RowInParts Selection::row_in_parts(int y) const {
  RowInParts row(static_cast<std::size_t>(size_.width));
  for (int x = 0; x < size_.width; ++x) {
    std::optional<PixelInParts>& pixel = row[static_cast<std::size_t>(x)];
    pixel = rendered_in_parts(strip_.input, in_image(x, y));
    if (pixel && !is_rendered(x, y)) {
      pixel->set_filtered(mixed(x, y, 0), mixed(x, y, 1));
    }
  }
  return row;
}

void Selection::write(Denoised& out, std::vector<RowSums>& sums) const {
  const int first = strip_.first + planes_.wanted.first;  // row of the image that is map row 0
  const RowSpan rows{strip_.rows.first - first, strip_.rows.last - first};
  Map errors(size_.pixels());
  Map variances(size_.pixels());
  pool_.parallel_for(size_.height, [&](std::int64_t row) {
    const int y = static_cast<int>(row);
    const bool inside = y >= rows.first && y < rows.last;
    const RowInParts here = row_in_parts(y);
    const RowInParts below = inside && y + 1 < size_.height ? row_in_parts(y + 1) : RowInParts();
    RowSums of_row;
    for (int x = 0; x < size_.width; ++x) {
      const RowSums pixel = sums_at(here, below, static_cast<std::size_t>(x));
      const std::size_t i = size_.index(x, y);
      // The values are bounded, so that their sums stay within the range of float.
      errors[i] = static_cast<float>(std::clamp(pixel.clean / 3, -1e30, 1e30));
      variances[i] = static_cast<float>(std::min(pixel.variance / 3, 1e30));
      of_row.add(pixel);
      if (inside) {
        out.image.pixels[in_image(x, y)] = value_of(x, y);
      }
    }
    if (inside) {
      sums[static_cast<std::size_t>(first + y)] = of_row;
    }
  });
  smoothing_.apply(errors, pool_);
  smoothing_.apply(variances, pool_);
  for (int y = rows.first; y < rows.last; ++y) {
    for (int x = 0; x < size_.width; ++x) {
      const std::size_t i = size_.index(x, y);
      out.error.pixels[in_image(x, y)] =
          gray(std::sqrt(at_least_variance(errors[i], variances[i])));
    }
  }
}

/// Returns the number of rows of a strip, which is even. A strip has about a quarter of a
/// megapixel, or 64 rows if these have more pixels.
int rows_of_strip(int width) {
  constexpr int kPixels = 1 << 18;
  constexpr int kMinRows = 64;
  return std::max(kMinRows, (kPixels / width) & ~1);
}

}  // namespace

Denoised denoise(const DenoiseInput& input, FitFunction fit, Pool& pool, int strip_rows) {
  // A result depends on filtered values up to kFitted rows away, because values pass through at
  // most three smoothings: of errors, of shares, and of the errors of the result.
  constexpr int kFitted = 3 * SurfaceSmoothing::kRadius;
  // The first and last 5 rows of prepare_fit() lack neighbours.
  static_assert(kFitted + kFitReach + 5 <= kDenoiseReach && kDenoiseReach % 2 == 0);
  const int height = static_cast<int>(input.mean.height);
  const ImageMeans means = means_of(input);
  Denoised out{input.mean, {input.mean.width, input.mean.height, {}}, {}};
  out.error.pixels.resize(out.image.pixels.size());
  std::vector<RowSums> sums(static_cast<std::size_t>(height));
  const int step = strip_rows > 0 ? strip_rows : rows_of_strip(static_cast<int>(input.mean.width));
  for (int y = 0; y < height; y += step) {
    const RowSpan rows{y, std::min(height, y + step)};
    const RowSpan around{std::max(0, rows.first - kDenoiseReach),
                         std::min(height, rows.last + kDenoiseReach)};
    Strip strip{input, means, rows, around.first, prepare_fit(input, means, around, pool), {}};
    strip.planes.wanted = {std::max(0, rows.first - kFitted) - around.first,
                           std::min(height, rows.last + kFitted) - around.first};
    strip.fits = fit(strip.planes, kSettings, pool);
    Selection(strip, pool).write(out, sums);
  }
  out.total = total_of(sums, input.rendered_share);
  return out;
}

}  // namespace bandsaw
