#pragma once

// Renders independent samples as a sequence of images with one sample per pixel, and images in
// which each pixel decides itself when to stop.

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

/// Renders samples of random numbers that are independent: sample i of a pixel is the first sample
/// of another seed, so each sample has an Owen scramble of its own.
class IndependentSamples {
 public:
  /// All arguments MUST outlive the object.
  IndependentSamples(const Scene& scene, const RenderSettings& settings, Pool& pool,
                     const std::atomic<bool>& stop)
      : scene_(scene), settings_(settings), pool_(pool), stop_(stop) {}

  /// Renders the next sample of every pixel and returns its r, g, b. CANCELLED: `stop` was set.
  absl::StatusOr<std::vector<double>> next();
  /// Returns the mean of all samples rendered so far.
  Image mean() const;
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

/// Tolerances: 1.96 standard errors of a pixel's mean must be within this fraction of it.
inline constexpr std::array<double, 4> kTolerances = {0.4, 0.2, 0.1, 0.05};

struct StoppedImages {
  std::array<Image, kTolerances.size()> images;
  std::array<double, kTolerances.size()> samples = {};  ///< per pixel, on average
  /// Number of rays if every pixel took `most` samples.
  double rays = 0;
};

/// Stops each pixel at the first multiple of 8 samples that satisfies the tolerance, or at `most`.
/// This is the rule of Berkeley's CS184 course and of many ray tracers that follow it; it is
/// applied to the mean of the channels. CANCELLED: `stop` was set.
absl::StatusOr<StoppedImages> stop_by_pixels(const Scene& scene, const RenderSettings& settings,
                                             std::uint64_t most, Pool& pool,
                                             const std::atomic<bool>& stop);

}  // namespace bandsaw::coordinator
