#include "renderlib/render/render_band.h"

#include <algorithm>
#include <array>
#include <memory>

#include "absl/strings/str_cat.h"
#include "renderlib/base/status_macros.h"
#include "renderlib/camera/camera.h"
#include "renderlib/integrate/sample_value.h"
#include "renderlib/sampling/sampler.h"

namespace bandsaw {
namespace {

struct Sum {
  double r = 0;
  double g = 0;
  double b = 0;
};

Sum operator+(const Sum& a, const Sum& b) { return {a.r + b.r, a.g + b.g, a.b + b.b}; }

/// Levels of the tree of the largest node, and one for its leaf.
constexpr std::size_t kMostLevels = 64;

/// One unit of work takes about this many samples: a few milliseconds, so that all threads end
/// together.
constexpr std::uint64_t kSamplesPerUnit = 1024;

Technique technique_of(Integrator integrator) {
  return integrator == Integrator::kPathLights       ? Technique::kLightsOnly
         : integrator == Integrator::kPathScattering ? Technique::kScatteringOnly
                                                     : Technique::kBoth;
}

/// Renders the pixels of a band; shared by the threads.
class BandRenderer {
 public:
  BandRenderer(const Scene& scene, const RenderSettings& settings, const Band& band,
               const std::atomic<bool>& stop)
      : scene_(scene),
        seed_(settings.seed),
        integrator_(settings.integrator),
        options_{.max_depth = settings.max_depth,
                 .technique = technique_of(settings.integrator),
                 .local = settings.integrator == Integrator::kDirect},
        filter_(scene.filter()),
        moves_(scene.needs().motion),
        camera_(scene.camera(), static_cast<int>(settings.width),
                static_cast<int>(settings.height)),
        samples_(band.samples),
        stop_(stop) {}

  bool stopped() const { return stop_.load(std::memory_order_relaxed); }

  /// The node's sum: leaves in order, two siblings added as soon as both are there. Of no meaning
  /// once stopped.
  Sum pixel(std::uint32_t x, std::uint32_t y, Counters& counters) const {
    const PixelSampler sampler(seed_, x, y);
    std::array<Sum, kMostLevels> stack;
    std::size_t top = 0;
    for (std::uint64_t block = 0; block < samples_.blocks() && !stopped(); ++block) {
      stack[top++] = leaf(sampler, x, y, samples_.first + block * kBlockSamples, counters);
      for (std::uint64_t pairs = block; (pairs & 1) != 0; pairs >>= 1) {
        --top;
        stack[top - 1] = stack[top - 1] + stack[top];
      }
    }
    return stack[0];
  }

 private:
  Sum leaf(const PixelSampler& sampler, std::uint32_t x, std::uint32_t y, std::uint64_t first,
           Counters& counters) const {
    Sum sum;
    PathCounts counts;
    const std::uint64_t last = std::min(first + kBlockSamples, samples_.last);
    for (std::uint64_t sample = first; sample < last; ++sample) {
      const Sample4 at = sampler.group(sample, kGroupCamera);
      const Vec2 offset = bandsaw::sample(filter_, at[0], at[1]);
      const double when = moves_ ? sampler.group(sample, kGroupTime)[0] : 0;
      const Ray ray = camera_.ray(x + 0.5 + offset.x, y + 0.5 + offset.y, at[2], at[3], when);
      const Rgb value = sample_value(scene_, integrator_, ray, sampler, sample, options_, counts);
      const bool finite = is_finite(value);
      if (!finite || value.r < 0 || value.g < 0 || value.b < 0) {
        counters.add({.bad_samples = 1,
                      .bad_x = x,
                      .bad_y = y,
                      .bad_sample = sample,
                      .negative_samples = finite ? 1u : 0u});
        continue;
      }
      sum = sum + Sum{value.r, value.g, value.b};
    }
    counters.rays += counts.rays;
    counters.truncated_paths += counts.truncated;
    return sum;
  }

  const Scene& scene_;
  std::uint64_t seed_;
  Integrator integrator_;
  PathOptions options_;
  PixelFilter filter_;
  bool moves_;
  RayGenerator camera_;
  SampleRange samples_;
  const std::atomic<bool>& stop_;
};

/// How the pixels of a band are dealt out: runs of neighbours in a row, that rays may find the same
/// things in the caches.
struct Units {
  Units(const Band& band, std::uint32_t width)
      : run(static_cast<std::uint32_t>(
            std::clamp<std::uint64_t>(kSamplesPerUnit / band.samples.samples(), 1, width))),
        per_row((width + run - 1) / run),
        count(std::int64_t{per_row} * band.rows.count()) {}

  std::uint32_t run;      ///< pixels
  std::uint32_t per_row;  ///< runs
  std::int64_t count;
};

}  // namespace

absl::StatusOr<BandPixels> render_band(const Scene& scene, const RenderSettings& settings,
                                       const Band& band, Pool& pool, const std::atomic<bool>& stop,
                                       const RowsDone& progress, const TileMask& tiles) {
  RETURN_IF_ERROR(validate(band, settings));
  const BandRenderer renderer(scene, settings, band, stop);
  const Units units(band, settings.width);
  BandPixels pixels{
      .band = band,
      .width = settings.width,
      .sums = std::vector<double>(std::size_t{band.rows.count()} * settings.width * 3),
      .counters = {.dropped_primitives = scene.dropped_primitives()}};
  std::vector<Counters> counters(static_cast<std::size_t>(units.count));
  std::vector<std::atomic<std::uint32_t>> runs_done(band.rows.count());
  std::atomic<std::uint32_t> rows_done = 0;

  pool.parallel_for(units.count, [&](std::int64_t unit) {
    const auto row = static_cast<std::uint32_t>(unit / units.per_row);
    const auto first = static_cast<std::uint32_t>(unit % units.per_row) * units.run;
    const std::uint32_t last = std::min(first + units.run, settings.width);
    Counters of_unit;
    for (std::uint32_t x = first; x < last; ++x) {
      if (renderer.stopped()) {
        return;
      }
      if (!tiles.has(x, band.rows.first + row)) {
        continue;
      }
      const Sum sum = renderer.pixel(x, band.rows.first + row, of_unit);
      double* const to = &pixels.sums[(std::size_t{row} * settings.width + x) * 3];
      to[0] = sum.r;
      to[1] = sum.g;
      to[2] = sum.b;
    }
    counters[static_cast<std::size_t>(unit)] = of_unit;
    if (++runs_done[row] == units.per_row && progress) {
      progress(++rows_done);
    }
  });

  if (renderer.stopped()) {
    return absl::CancelledError("the render was stopped");
  }
  for (const Counters& of_unit : counters) {
    pixels.counters.add(of_unit);
  }
  return pixels;
}

}  // namespace bandsaw
