#pragma once

// Two methods that the renderer itself does not use, for comparison in `bandsaw study`: samples of
// independent random numbers, and images in which each pixel stops by its own estimated error.

#include <array>
#include <atomic>
#include <cstdint>
#include <vector>

#include "absl/status/statusor.h"
#include "renderlib/base/pool.h"
#include "renderlib/image/image.h"
#include "renderlib/render/settings.h"
#include "renderlib/scene/scene.h"

namespace bandsaw::coordinator {

/// Renders samples whose random numbers are independent. The i-th sample of a pixel is rendered as
/// the first sample of an image with the i-th seed of a series. So each sample has an Owen scramble
/// of its own.
class IndependentSamples {
 public:
  /// `scene`, `pool` and `stop` MUST outlive the object.
  IndependentSamples(const Scene& scene, const RenderSettings& settings, Pool& pool,
                     const std::atomic<bool>& stop)
      : scene_(scene), settings_(settings), pool_(pool), stop_(stop) {}

  /// Renders the next sample of every pixel. Returns r, g, b of all pixels, row by row from the
  /// top. CANCELLED: `stop` was set.
  absl::StatusOr<std::vector<double>> next();
  /// Returns the mean of all samples rendered so far.
  Image mean() const;
  /// Returns the number of rays of all samples rendered so far.
  double rays() const { return rays_; }

 private:
  const Scene& scene_;
  RenderSettings settings_;
  Pool& pool_;
  const std::atomic<bool>& stop_;
  std::vector<double> sums_;
  std::uint64_t count_ = 0;
  double rays_ = 0;
};

/// The tolerances that are compared. A pixel stops when 1.96 standard errors of its mean (half of
/// the 95 % confidence interval) are at most this fraction of the mean.
inline constexpr std::array<double, 4> kTolerances = {0.4, 0.2, 0.1, 0.05};

/// The images of all tolerances, made of the same samples.
struct StoppedImages {
  std::array<Image, kTolerances.size()> images;
  std::array<double, kTolerances.size()> samples = {};  ///< mean number of samples per pixel
  /// Number of rays of all samples. A pixel that has stopped is still rendered until it has the
  /// `most` samples of stop_by_pixels(), and these rays are counted as well.
  double rays = 0;
};

/// Stops each pixel at the first multiple of 16 samples that satisfies the tolerance, or at `most`
/// samples. The error is estimated for the mean of the three channels. This is the rule of
/// Berkeley's course CS184 and of many ray tracers that follow it. CANCELLED: `stop` was set.
absl::StatusOr<StoppedImages> stop_by_pixels(const Scene& scene, const RenderSettings& settings,
                                             std::uint64_t most, Pool& pool,
                                             const std::atomic<bool>& stop);

}  // namespace bandsaw::coordinator
