#pragma once

// Computes the sums of a band's pixels as defined in band.h: pixel by pixel or, if pixels of the
// scene share paths, a group of pixels (pixel_groups.h) at a time. render_band.cpp calls it.

#include <array>
#include <atomic>
#include <cstdint>
#include <vector>

#include "absl/types/span.h"
#include "renderlib/camera/camera.h"
#include "renderlib/integrate/path_reuse.h"
#include "renderlib/render/band.h"
#include "renderlib/render/pixel_groups.h"
#include "renderlib/render/settings.h"
#include "renderlib/render/tile_samples.h"
#include "renderlib/scene/scene.h"

namespace bandsaw {

/// Computes the sums for one band. Immutable; shared by the threads that render the band.
class PixelSums {
 public:
  /// All references and pointers MUST outlive this object. `settings` and `band` MUST be valid.
  /// The guiding field, the photon maps and the portals (openings through which the background
  /// lights a room) are those of `uses`.
  PixelSums(const Scene& scene, const RenderSettings& settings, const Band& band,
            const PathOptions& uses, const std::atomic<bool>& stop);

  bool stopped() const { return stop_.load(std::memory_order_relaxed); }

  /// Returns true if the sums are to be computed with add_groups(), and false if with add_run().
  bool in_groups() const { return reuses_paths_; }

  /// Writes three sums (r, g, b) for each pixel of row y with x in [first, last) to which `tiles`
  /// gives samples. `sums` holds the sums of the whole band. Adds to `counters`. Checks `stop` at
  /// least once per block of 8 samples; once it is set, the sums are unspecified.
  void add_run(std::uint32_t y, std::uint32_t first, std::uint32_t last, const TileSamples& tiles,
               absl::Span<double> sums, Counters& counters) const;

  /// Does the same as add_run() for the groups [first, last) of a half tile, which is half of the
  /// groups of a tile of 16 x 16 pixels (tile_samples.h). If only some pixels of a group lie in the
  /// band, the group is traced as a whole, but the pixels outside of the band are neither written
  /// nor counted.
  void add_groups(const PixelGroups& groups, std::uint32_t first, std::uint32_t last,
                  const TileSamples& tiles, absl::Span<double> sums, Counters& counters) const;

 private:
  struct Sum {
    double r;
    double g;
    double b;
    friend Sum operator+(const Sum& p, const Sum& q) { return {p.r + q.r, p.g + q.g, p.b + q.b}; }
    friend Sum operator*(double s, const Sum& p) { return {s * p.r, s * p.g, s * p.b}; }
  };
  using Sums = std::array<Sum, kMaxReusePixels>;  ///< one for each pixel of a group
  /// Scratch memory of add_group(), allocated once per unit of work.
  struct Scratch {
    std::vector<ReusePixel> pixels;
    std::vector<Sums> stack;  ///< sums of nodes of the tree of samples (pixel_sums.cpp)
  };

  bool in_band(const PixelPlace& place) const {
    return place.y >= band_.rows.first && place.y < band_.rows.last;
  }
  /// Takes the samples `samples` of each pixel in `places`, which are the pixels of a group or a
  /// single pixel. Writes the sums of the pixels that lie in the band.
  void add_group(absl::Span<const PixelPlace> places, const SampleRange& samples,
                 absl::Span<double> sums, Scratch& scratch, Counters& counters) const;
  /// Returns the sums of one block (8 samples, or fewer at the end of a job).
  Sums leaf(absl::Span<const PixelPlace> places, const SampleRange& samples,
            absl::Span<ReusePixel> pixels, Counters& counters) const;
  /// Takes one sample of each pixel, and stores the radiance of each sample in `pixels`.
  void sample(absl::Span<const PixelPlace> places, std::uint64_t sample,
              absl::Span<ReusePixel> pixels) const;
  /// Returns the camera ray of a sample. Its distance from the centre of the pixel, as sampled from
  /// the pixel filter, is multiplied by `spread`.
  CameraRay camera_ray(const PixelSampler& sampler, const PixelPlace& place, std::uint64_t sample,
                       double spread) const;

  const Scene& scene_;
  RenderSettings settings_;
  Band band_;
  const std::atomic<bool>& stop_;
  PathOptions options_;
  RayGenerator camera_;
  bool samples_through_lens_;
  bool reuses_paths_;
};

}  // namespace bandsaw
