// Splits the samples into two halves, limits single bright pixels, estimates variances, and scales
// the guides (albedo, normal and depth) to [0, 1].

#include "renderlib/denoise/prepare.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace bandsaw {
namespace {

/// Limit of radiance (per channel) and of depth, so that sums of squares stay within the range of
/// float. A pixel with a larger radiance is not filtered. A larger depth counts as infinite.
constexpr float kMaxValue = 1e15f;
constexpr int kAround = 2;  ///< radius, in pixels, of the neighbours that limit a bright pixel
constexpr float kMaxOverThird = 4;  ///< see limits_from()
/// Minimum standard deviation of a half, as a share of the brightness around a pixel. The filters
/// compare differences with the standard deviation, so they never treat smaller differences as
/// detail.
constexpr float kMinNoise = 3e-3f;

using Channels = std::array<float, 3>;

Channels channels(const Rgb& color) { return {color.r, color.g, color.b}; }

bool usable(float value) { return value >= 0 && value <= kMaxValue; }

/// Fills a plane from f(x, y), and mirrors it into the margin.
template <class F>
SplitPlane plane_of(const MapSize& size, Pool& pool, F f) {
  SplitPlane plane(size.width, size.height);
  const auto mirrored = [](int x, int n) {
    const int period = 2 * n;
    const int at = ((x % period) + period) % period;
    return at < n ? at : period - 1 - at;
  };
  constexpr int kMargin = SplitPlane::kMargin;
  pool.parallel_for(size.height + 2 * kMargin, [&](std::int64_t row) {
    const int y = static_cast<int>(row) - kMargin;
    for (int x = -kMargin; x < size.width + kMargin; ++x) {
      plane.at(x, y) = f(mirrored(x, size.width), mirrored(y, size.height));
    }
  });
  return plane;
}

/// The two halves. Their values are 0 where `valid` is 0.
struct Parts {
  std::array<std::vector<Channels>, 2> values;
  Map valid;
};

/// Returns the halves of some rows. `first_pixel`: the index of their first pixel in the image.
Parts parts_of(const DenoiseInput& input, std::size_t first_pixel, const MapSize& size) {
  Parts parts;
  for (auto& half : parts.values) {
    half.resize(size.pixels());
  }
  parts.valid.resize(size.pixels());
  for (std::size_t i = 0; i < size.pixels(); ++i) {
    const std::size_t at = first_pixel + i;
    const Channels mean = channels(input.mean.pixels[at]);
    const Channels first = channels(input.first.pixels[at]);
    const float share = input.first_share[at];
    Channels second{};
    bool valid = share > 0 && share < 1;
    for (std::size_t c = 0; c < 3 && valid; ++c) {
      second[c] = std::max(0.0f, second_value(mean[c], first[c], share));
      valid = usable(mean[c]) && usable(first[c]) && usable(second[c]);
    }
    parts.valid[i] = valid ? 1.0f : 0.0f;
    parts.values[0][i] = valid ? first : Channels{};
    parts.values[1][i] = valid ? second : Channels{};
  }
  return parts;
}

float brightness(const Channels& color) { return (color[0] + color[1]) + color[2]; }

/// Returns the limit of each pixel's brightness in one half, from the pixels up to kAround away in
/// the other half: the brightness of the brightest of them, but at most kMaxOverThird times that of
/// the third brightest. A pixel above the limit is a single bright one: the other half does not
/// have such pixels there, or has only one or two of them.
std::vector<float> limits_from(const std::vector<Channels>& other, const MapSize& size,
                               Pool& pool) {
  std::vector<float> limits(size.pixels());
  pool.parallel_for(size.height, [&](std::int64_t row) {
    const int y = static_cast<int>(row);
    for (int x = 0; x < size.width; ++x) {
      float top[3] = {};  // the brightest, the second and the third brightest
      for (int v = std::max(0, y - kAround); v <= std::min(size.height - 1, y + kAround); ++v) {
        for (int u = std::max(0, x - kAround); u <= std::min(size.width - 1, x + kAround); ++u) {
          float value = brightness(other[size.index(u, v)]);
          for (float& rank : top) {
            if (value > rank) {
              std::swap(value, rank);
            }
          }
        }
      }
      limits[size.index(x, y)] = std::min(top[0], kMaxOverThird * top[2]);
    }
  });
  return limits;
}

/// Scales single bright pixels of both halves down to their limits (limits_from). If a pixel is
/// above its limit in both halves, it shows a small bright detail, for example the reflection of a
/// lamp. Such a pixel becomes invalid, so that it stays as it was rendered.
void limit_bright_pixels(Parts& parts, const MapSize& size, Pool& pool) {
  const std::array limits{limits_from(parts.values[1], size, pool),
                          limits_from(parts.values[0], size, pool)};
  for (std::size_t i = 0; i < size.pixels(); ++i) {
    int above = 0;
    for (std::size_t h = 0; h < 2; ++h) {
      Channels& pixel = parts.values[h][i];
      const float value = brightness(pixel);
      if (value > limits[h][i]) {
        ++above;
        for (float& channel : pixel) {
          channel *= limits[h][i] / value;
        }
      }
    }
    if (above == 2) {
      parts.valid[i] = 0;
    }
  }
}

/// Returns the guides of a pixel, each in [0, 1]. `shape` is a pixel of DenoiseInput::shape: `r`
/// and `g` hold the normal, and `b` is the depth, 0 where there is no surface. A depth of `typical`
/// becomes 1/2.
std::array<float, kGuides> guides_of(const Rgb& albedo, const Rgb& shape, float typical) {
  const auto bounded = [](float v) { return v > 0 ? std::min(v, 1.0f) : 0.0f; };  // NaN: 0
  const float depth =
      shape.b > 0 ? (shape.b < kMaxValue ? shape.b / (shape.b + typical) : 1.0f) : 0.0f;
  return {bounded(albedo.r), bounded(albedo.g), bounded(albedo.b),
          bounded(shape.r),  bounded(shape.g),  bounded(depth)};
}

}  // namespace

ImageMeans means_of(const DenoiseInput& input) {
  double brightness_sum = 0;
  double depth_sum = 0;
  double brightness_count = 0;
  double depth_count = 0;
  for (std::size_t i = 0; i < input.mean.pixels.size(); ++i) {
    const Channels mean = channels(input.mean.pixels[i]);
    if (usable(mean[0]) && usable(mean[1]) && usable(mean[2])) {
      brightness_sum += brightness(mean);
      brightness_count += 3;
    }
    if (const float depth = input.shape.pixels[i].b; depth > 0 && depth < kMaxValue) {
      depth_sum += depth;
      depth_count += 1;
    }
  }
  return {.brightness =
              brightness_count > 0 ? static_cast<float>(brightness_sum / brightness_count) : 0.0f,
          .depth = depth_count > 0 ? static_cast<float>(depth_sum / depth_count) : 1.0f};
}

FitInput prepare_fit(const DenoiseInput& input, const ImageMeans& means, const RowSpan& rows,
                     Pool& pool) {
  const MapSize size{static_cast<int>(input.mean.width), rows.count()};
  const std::size_t first_pixel = size.index(0, rows.first);
  FitInput out;
  out.width = size.width;
  out.height = size.height;
  Map noise(size.pixels());   // squared differences of the halves, then their mean around a pixel
  Map around(size.pixels());  // mean of the channels, then its mean around a pixel
  {
    Parts parts = parts_of(input, first_pixel, size);
    limit_bright_pixels(parts, size, pool);
    const auto& halves = parts.values;
    for (std::size_t i = 0; i < size.pixels(); ++i) {
      for (std::size_t c = 0; c < 3; ++c) {
        const float difference = halves[0][i][c] - halves[1][i][c];
        noise[i] += difference * difference;
      }
      around[i] = (brightness(halves[0][i]) + brightness(halves[1][i])) / 6;
    }
    for (std::size_t h = 0; h < 2; ++h) {
      for (std::size_t c = 0; c < 3; ++c) {
        out.halves[h][c] =
            plane_of(size, pool, [&](int x, int y) { return halves[h][size.index(x, y)][c]; });
      }
    }
    out.valid = SplitPlane(size.width, size.height);
    for (int y = 0; y < size.height; ++y) {
      for (int x = 0; x < size.width; ++x) {
        out.valid.at(x, y) = parts.valid[size.index(x, y)];
      }
    }
  }
  smooth(noise, size, 1, pool);
  smooth(around, size, 3, pool);
  for (std::size_t h = 0; h < 2; ++h) {
    // The variance of a half is inversely proportional to its number of samples, and the variances
    // of both halves add up to the variance of their difference. So the variance of the first half
    // is this sum times (1 - share), and the variance of the second half is this sum times share.
    out.variance[h] = plane_of(size, pool, [&](int x, int y) {
      const std::size_t i = size.index(x, y);
      const float share = std::clamp(input.first_share[first_pixel + i], 0.0f, 1.0f);
      const float least = kMinNoise * around[i];
      return noise[i] * (h == 0 ? 1 - share : share) + least * least + 1e-20f;
    });
  }
  for (std::size_t g = 0; g < kGuides; ++g) {
    out.guides[g] = plane_of(size, pool, [&](int x, int y) {
      const std::size_t i = first_pixel + size.index(x, y);
      return guides_of(input.albedo.pixels[i], input.shape.pixels[i], means.depth)[g];
    });
  }
  return out;
}

}  // namespace bandsaw
