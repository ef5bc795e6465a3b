// stop_by_pixels() renders one sample of every pixel at a time. For each pixel and tolerance, the
// function records whether the pixel has stopped, and with which value.

#include "coordinator/cli/study/study_pixel_stops.h"

#include <algorithm>
#include <cmath>

#include "renderlib/base/status_macros.h"
#include "renderlib/render/hash64.h"
#include "renderlib/render/render_band.h"

namespace bandsaw::coordinator {
namespace {

constexpr std::uint64_t kLookEvery = 16;  // number of samples between two tests of a pixel
// A normal distribution has 95 % of its values within this many standard deviations of its mean.
constexpr double kNinetyFivePercent = 1.96;

/// State of one pixel with one tolerance.
struct Pixel {
  std::uint64_t samples = 0;  ///< number of samples when it stopped; 0: it has not stopped
  Rgb value;                  ///< mean of these samples
};

/// Sums over the samples of a pixel. A sample counts as the mean of its three channels.
struct Moments {
  double sum = 0;
  double squares = 0;  ///< sum of the squares

  /// Returns true if half of the 95 % confidence interval of the mean of the `n` samples is at most
  /// `tolerance` times the mean.
  bool within(double tolerance, double n) const {
    const double mean = sum / n;
    const double variance = std::max(0.0, (squares - n * mean * mean) / (n - 1));
    return kNinetyFivePercent * std::sqrt(variance / n) <= tolerance * mean;
  }
};

/// `sums`: r, g, b of a pixel, summed over `n` samples.
Rgb mean_of(const double* sums, double n) {
  return {static_cast<float>(sums[0] / n), static_cast<float>(sums[1] / n),
          static_cast<float>(sums[2] / n)};
}

}  // namespace

absl::StatusOr<std::vector<double>> IndependentSamples::next() {
  Hash64 hash;
  hash.add(settings_.seed);
  hash.add(count_);
  RenderSettings settings = settings_;
  settings.seed = hash.value();
  ASSIGN_OR_RETURN(
      BandPixels pixels,
      render_band(scene_, settings, {/*samples=*/{0, 1}, /*rows=*/{0, settings.height}}, pool_,
                  stop_, /*progress=*/{}));
  sums_.resize(pixels.sums.size());
  for (std::size_t k = 0; k < sums_.size(); ++k) {
    sums_[k] += pixels.sums[k];
  }
  ++count_;
  rays_ += static_cast<double>(pixels.counters.rays);
  return std::move(pixels.sums);
}

Image IndependentSamples::mean() const {
  Image image{settings_.width, settings_.height, {}};
  for (std::size_t k = 0; k < sums_.size(); k += 3) {
    image.pixels.push_back(mean_of(&sums_[k], static_cast<double>(count_)));
  }
  return image;
}

absl::StatusOr<StoppedImages> stop_by_pixels(const Scene& scene, const RenderSettings& settings,
                                             std::uint64_t most, Pool& pool,
                                             const std::atomic<bool>& stop) {
  const std::size_t count = std::size_t{settings.width} * settings.height;
  std::vector<double> sums(3 * count);
  std::vector<Moments> moments(count);
  std::array<std::vector<Pixel>, kTolerances.size()> pixels;
  pixels.fill(std::vector<Pixel>(count));
  IndependentSamples samples(scene, settings, pool, stop);
  for (std::uint64_t n = 1; n <= most; ++n) {
    ASSIGN_OR_RETURN(const std::vector<double> values, samples.next());
    for (std::size_t i = 0; i < count; ++i) {
      const double value = (values[3 * i] + values[3 * i + 1] + values[3 * i + 2]) / 3;
      moments[i].sum += value;
      moments[i].squares += value * value;
      for (std::size_t c = 3 * i; c < 3 * i + 3; ++c) {
        sums[c] += values[c];
      }
      if (n % kLookEvery != 0 && n < most) {
        continue;
      }
      const auto taken = static_cast<double>(n);
      for (std::size_t t = 0; t < kTolerances.size(); ++t) {
        Pixel& pixel = pixels[t][i];
        if (pixel.samples == 0 && (n == most || moments[i].within(kTolerances[t], taken))) {
          pixel = {n, mean_of(&sums[3 * i], taken)};
        }
      }
    }
  }
  StoppedImages out;
  out.rays = samples.rays();
  for (std::size_t t = 0; t < kTolerances.size(); ++t) {
    out.images[t] = {settings.width, settings.height, {}};
    double taken = 0;
    for (const Pixel& pixel : pixels[t]) {
      out.images[t].pixels.push_back(pixel.value);
      taken += static_cast<double>(pixel.samples);
    }
    out.samples[t] = taken / static_cast<double>(count);
  }
  return out;
}

}  // namespace bandsaw::coordinator
