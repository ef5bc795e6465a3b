#pragma once

// Samples that know nothing of each other, one image of one sample a pixel after the other; and
// what becomes of an image whose pixels decide for themselves when they have enough of them.

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

/// Sample i is the first one of a seed of its own: a point of a scramble that no other shares, so
/// uniform and independent.
class IndependentSamples {
 public:
  /// What is given MUST outlive it.
  IndependentSamples(const Scene& scene, const RenderSettings& settings, Pool& pool,
                     const std::atomic<bool>& stop)
      : scene_(scene), settings_(settings), pool_(pool), stop_(stop) {}

  /// r, g, b of the next sample of every pixel. CANCELLED.
  absl::StatusOr<std::vector<double>> next();
  /// Of all so far.
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

/// Of a pixel's mean: 1.96 of its standard errors stay within this fraction of it.
inline constexpr std::array<double, 4> kTolerances = {0.4, 0.2, 0.1, 0.05};

struct StoppedImages {
  std::array<Image, kTolerances.size()> images;
  std::array<double, kTolerances.size()> samples = {};  ///< a pixel, on average
  double rays = 0;  ///< of as many samples as no pixel goes beyond, in every pixel
};

/// Each pixel ends at the first multiple of 16 samples that fulfils the tolerance, or at `most`.
/// The rule of Berkeley's CS184 course and of many ray tracers that follow it; the value it looks
/// at is the mean of the channels.
absl::StatusOr<StoppedImages> stop_by_pixels(const Scene& scene, const RenderSettings& settings,
                                             std::uint64_t most, Pool& pool,
                                             const std::atomic<bool>& stop);

}  // namespace bandsaw::coordinator
