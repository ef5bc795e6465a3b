#pragma once

// The sums of a band's pixels, as band.h defines them: each alone, or where the scene's pixels
// share their paths, those of half a row of a tile together.

#include <array>
#include <atomic>
#include <cstdint>
#include <vector>

#include "absl/types/span.h"
#include "renderlib/camera/camera.h"
#include "renderlib/integrate/shared_paths.h"
#include "renderlib/render/band.h"
#include "renderlib/render/settings.h"
#include "renderlib/render/tile_samples.h"
#include "renderlib/scene/scene.h"

namespace bandsaw {

/// Shared by the threads that render the band.
class PixelSums {
 public:
  /// `scene` and `stop` MUST outlive this. `settings` and `band` MUST be valid.
  PixelSums(const Scene& scene, const RenderSettings& settings, const Band& band,
            const std::atomic<bool>& stop);

  bool stopped() const { return stop_.load(std::memory_order_relaxed); }

  /// Where a run of pixels may begin and end: at multiples of this, and at the end of the row.
  std::uint32_t run_step() const { return shares_ ? kTileSide : 1; }

  /// Sets three sums a pixel of those of [first, last) in row y that take samples; `row`: of the
  /// whole row. Checks `stop` at least once a block of samples; sums mean nothing once it is set.
  void add_run(std::uint32_t y, std::uint32_t first, std::uint32_t last, const TileSamples& tiles,
               absl::Span<double> row, Counters& counters) const;

 private:
  struct Sum {
    double r;
    double g;
    double b;
    friend Sum operator+(const Sum& p, const Sum& q) { return {p.r + q.r, p.g + q.g, p.b + q.b}; }
    friend Sum operator*(double s, const Sum& p) { return {s * p.r, s * p.g, s * p.b}; }
  };
  using Sums = std::array<Sum, kMostShared>;
  /// What a group works in: allocated once a run.
  struct Desk {
    std::vector<SharedPixel> pixels;
    std::vector<Sums> stack;
  };

  void add_group(std::uint32_t y, const HalfRow& group, const SampleRange& samples,
                 absl::Span<double> row, Desk& desk, Counters& counters) const;
  /// Of one block, or what is there of it.
  Sums leaf(std::uint32_t y, const HalfRow& group, const SampleRange& samples,
            absl::Span<SharedPixel> pixels, Counters& counters) const;
  void sample(std::uint32_t y, const HalfRow& group, std::uint64_t sample,
              absl::Span<SharedPixel> pixels, PathCounts& counts) const;
  CameraRay camera_ray(const PixelSampler& sampler, std::uint32_t x, std::uint32_t y,
                       std::uint64_t sample) const;

  const Scene& scene_;
  RenderSettings settings_;
  SampleRange samples_;
  const std::atomic<bool>& stop_;
  PathOptions options_;
  RayGenerator camera_;
  bool asks_through_lens_;
  bool shares_;
};

}  // namespace bandsaw
