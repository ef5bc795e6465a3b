#pragma once

// Computes the sums of a band's pixels as defined in band.h: pixel by pixel or, if the scene shares
// paths, half a row of a tile at a time.

#include <array>
#include <atomic>
#include <cstdint>
#include <vector>

#include "absl/types/span.h"
#include "renderlib/camera/camera.h"
#include "renderlib/integrate/path_reuse.h"
#include "renderlib/render/band.h"
#include "renderlib/render/settings.h"
#include "renderlib/render/tile_samples.h"
#include "renderlib/scene/scene.h"

namespace bandsaw {

/// Immutable; shared by the threads that render the band.
class PixelSums {
 public:
  /// `scene` and `stop` MUST outlive this object. `settings` and `band` MUST be valid.
  PixelSums(const Scene& scene, const RenderSettings& settings, const Band& band,
            const std::atomic<bool>& stop);

  bool stopped() const { return stop_.load(std::memory_order_relaxed); }

  /// Returns the alignment of runs: a run begins at a multiple of it and ends at one or at the end
  /// of the row.
  std::uint32_t run_step() const { return reuses_paths_ ? kTileSide : 1; }

  /// Writes three sums for each pixel of [first, last) in row y that takes samples; `row` holds the
  /// sums of the whole row. Checks `stop` at least once per block; once it is set, the sums are
  /// unspecified.
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
  using Sums = std::array<Sum, kMaxReusePixels>;
  /// Scratch memory of add_group(), allocated once per run.
  struct Scratch {
    std::vector<ReusePixel> pixels;
    std::vector<Sums> stack;
  };

  void add_group(std::uint32_t y, const HalfRow& group, const SampleRange& samples,
                 absl::Span<double> row, Scratch& scratch, Counters& counters) const;
  /// Returns the sums of one block, which may be truncated.
  Sums leaf(std::uint32_t y, const HalfRow& group, const SampleRange& samples,
            absl::Span<ReusePixel> pixels, Counters& counters) const;
  void sample(std::uint32_t y, const HalfRow& group, std::uint64_t sample,
              absl::Span<ReusePixel> pixels, PathCounts& counts) const;
  CameraRay camera_ray(const PixelSampler& sampler, std::uint32_t x, std::uint32_t y,
                       std::uint64_t sample) const;

  const Scene& scene_;
  RenderSettings settings_;
  SampleRange samples_;
  const std::atomic<bool>& stop_;
  PathOptions options_;
  RayGenerator camera_;
  bool samples_through_lens_;
  bool reuses_paths_;
};

}  // namespace bandsaw
