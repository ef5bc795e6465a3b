// Implements Kernel::render_band: trains path guiding and makes photon maps where they are
// worthwhile, then renders the pixels. Units divides the band among threads. Each thread of the
// pool renders one unit after the other; a row is reported when its last unit is done.

#include <algorithm>
#include <atomic>
#include <vector>

#include "renderlib/base/status_macros.h"
#include "renderlib/guiding/guiding_cache.h"
#include "renderlib/integrate/caustics.h"
#include "renderlib/integrate/guiding_training.h"
#include "renderlib/integrate/make_photon_maps.h"
#include "renderlib/integrate/photon_sources.h"
#include "renderlib/integrate/preparation.h"
#include "renderlib/render/band_parts.h"
#include "renderlib/render/kernel_code.h"
#include "renderlib/render/pixel_sums.h"

namespace bandsaw {
namespace {

/// One unit of work takes about this many samples: a few milliseconds, so that all threads end
/// together.
constexpr std::uint64_t kSamplesPerUnit = 1024;

/// Partition of a band's pixels among threads. A strip is a row, and a unit is a run of pixels of
/// this row. The pixels of a unit are neighbours, because rays of neighbours use the same cached
/// data. If pixels share paths, a strip is instead the part of a row of tiles that lies in the
/// band, and a unit is some groups of pixels from one half tile (half of a tile's pixels).
class Units {
 public:
  Units(const PixelSums& sums, const Band& band, const TileGrid& grid)
      : sums_(sums),
        rows_(band.rows),
        grid_(grid),
        strip_rows_(sums.in_groups() ? kTileSide : 1),
        first_strip_(rows_.first / strip_rows_) {
    const std::uint64_t pixels =
        std::max<std::uint64_t>(1, kSamplesPerUnit / band.samples.samples());
    if (sums.in_groups()) {
      size_ = static_cast<std::uint32_t>(
          std::clamp<std::uint64_t>(pixels / kMaxReusePixels, 1, kGroups));
      per_half_tile_ = (kGroups + size_ - 1) / size_;
      per_strip_ = 2 * grid.columns() * per_half_tile_;
    } else {
      size_ = static_cast<std::uint32_t>(std::min<std::uint64_t>(pixels, grid.width));
      per_strip_ = (grid.width + size_ - 1) / size_;
    }
  }

  std::uint32_t strips() const { return (rows_.last - 1) / strip_rows_ - first_strip_ + 1; }
  std::uint32_t per_strip() const { return per_strip_; }
  std::int64_t count() const { return std::int64_t{strips()} * per_strip_; }
  /// Returns the number of the band's rows in a strip.
  std::uint32_t rows(std::uint32_t strip) const {
    const std::uint32_t first = (first_strip_ + strip) * strip_rows_;
    return std::min(first + strip_rows_, rows_.last) - std::max(first, rows_.first);
  }

  /// Renders unit `number` of a strip into the sums of the band.
  void render(std::uint32_t strip, std::uint32_t number, const TileSamples& tiles,
              absl::Span<double> sums, Counters& counters) const {
    if (!sums_.in_groups()) {
      const std::uint32_t first = number * size_;
      sums_.add_run(first_strip_ + strip, first, std::min(first + size_, grid_.width), tiles, sums,
                    counters);
      return;
    }
    const std::size_t half_tile =
        std::size_t{first_strip_ + strip} * 2 * grid_.columns() + number / per_half_tile_;
    const std::uint32_t first = number % per_half_tile_ * size_;
    sums_.add_groups(PixelGroups(grid_, half_tile), first, first + size_, tiles, sums, counters);
  }

 private:
  /// Number of groups in a whole half tile.
  static constexpr std::uint32_t kGroups = kTileSide * kTileSide / 2 / kMaxReusePixels;

  const PixelSums& sums_;
  RowRange rows_;
  TileGrid grid_;
  std::uint32_t strip_rows_;         ///< rows of a whole strip
  std::uint32_t first_strip_;        ///< strips are counted from the top of the image
  std::uint32_t size_ = 1;           ///< pixels, or groups, of a unit
  std::uint32_t per_half_tile_ = 1;  ///< units of a half tile, if pixels share paths
  std::uint32_t per_strip_ = 1;      ///< units of a strip
};

/// The parameters that all parts of a band share. If a band needs too many photon maps at once, its
/// samples are divided into parts (render_with_maps). Any other band is a single part.
struct Render {
  const Scene& scene;
  const RenderSettings& settings;
  Pool& pool;
  const std::atomic<bool>& stop;
  const TrainedGuiding* guiding;  ///< null: without guiding
};

/// Returns the flags (Counters::techniques) of the photon maps that are used.
std::uint32_t maps_used(const TrainedGuiding& guiding) {
  return (guiding.sources->casters.empty() ? 0 : Counters::kPhotonMaps) |
         (guiding.sources->surfaces ? Counters::kIndirectMaps : 0);
}

absl::Status stopped() { return absl::CancelledError("the render was stopped"); }

/// Renders a part of a band. `maps` are the photon maps of the part; null: without photon maps.
absl::StatusOr<BandPixels> render_part(const Render& render, const BandPart& part,
                                       const PhotonMaps* maps, const RowsDone& progress) {
  const RenderSettings& settings = render.settings;
  const Band& band = part.band;
  PathOptions uses{.maps = maps};
  if (render.guiding != nullptr) {
    uses.guiding = render.guiding->field.cells() > 0 ? &render.guiding->field : nullptr;
    uses.portals = render.guiding->portals.empty() ? nullptr : &render.guiding->portals;
  }
  const PixelSums pixel_sums(render.scene, settings, band, uses, render.stop);
  const Units units(pixel_sums, band, {settings.width, settings.height});
  BandPixels pixels{
      .band = band,
      .width = settings.width,
      .sums = std::vector<double>(std::size_t{band.rows.count()} * settings.width * 3),
      .counters = {.dropped_primitives = render.scene.dropped_primitives(),
                   .techniques = (uses.guiding != nullptr ? Counters::kPathGuiding : 0) |
                                 (uses.maps != nullptr ? maps_used(*render.guiding) : 0) |
                                 (uses.portals != nullptr ? Counters::kPortals : 0),
                   .training_rays = render.guiding != nullptr ? render.guiding->rays : 0}};
  std::vector<Counters> counters(static_cast<std::size_t>(units.count()));
  std::vector<std::atomic<std::uint32_t>> units_done(units.strips());
  std::atomic<std::uint32_t> rows_done = 0;

  render.pool.parallel_for(units.count(), [&](std::int64_t unit) {
    const auto strip = static_cast<std::uint32_t>(unit / units.per_strip());
    Counters of_unit;
    units.render(strip, static_cast<std::uint32_t>(unit % units.per_strip()), part.tiles,
                 absl::MakeSpan(pixels.sums), of_unit);
    if (pixel_sums.stopped()) {
      return;
    }
    counters[static_cast<std::size_t>(unit)] = of_unit;
    if (++units_done[strip] == units.per_strip() && progress) {
      for (std::uint32_t row = 0; row < units.rows(strip); ++row) {
        progress(++rows_done);
      }
    }
  });

  if (pixel_sums.stopped()) {
    return stopped();
  }
  for (const Counters& of_unit : counters) {
    pixels.counters.add(of_unit);
  }
  return pixels;
}

/// Returns a preparation that reports each of its steps as a progress of 0 rows.
Preparation preparation_of(Pool& pool, const std::atomic<bool>& stop, const RowsDone& progress) {
  return {pool, stop, progress ? [&progress] { progress(0); } : std::function<void()>()};
}

/// Returns the key of the training for these settings in the scene's guiding cache.
GuidingKey field_key(const RenderSettings& settings) {
  return {settings.width, settings.height, settings.max_depth,
          settings.integrator == Integrator::kPath};
}

/// Maximum number of photon maps that are in use at the same time for a band.
constexpr std::size_t kMaxMaps = 8;
static_assert(PhotonMaps::kMinSamplesOfMap == kBlockSamples, "a block has one photon map");

/// Renders a part with its photon maps: at once, or in halves if there are too many maps.
absl::StatusOr<BandPixels> render_with_maps(const Render& render, const BandPart& part,
                                            const RowsDone& progress) {
  const std::vector<std::uint32_t> numbers = maps_of(part);
  if (numbers.size() > kMaxMaps) {
    const auto [first, second] = halves_of(part, render.settings.width);
    // A row is complete only when the last part is rendered. So the first part reports 0 rows.
    const RowsDone no_rows = progress ? [&progress](std::uint32_t) { progress(0); } : RowsDone();
    ASSIGN_OR_RETURN(BandPixels pixels, render_with_maps(render, first, no_rows));
    ASSIGN_OR_RETURN(const BandPixels more, render_with_maps(render, second, progress));
    for (std::size_t i = 0; i < pixels.sums.size(); ++i) {
      pixels.sums[i] += more.sums[i];
    }
    pixels.band = part.band;
    pixels.counters.add(more.counters);
    return pixels;
  }
  const PhotonSources& sources = *render.guiding->sources;
  const RenderSettings& settings = render.settings;
  PhotonMaps maps(sources.casters);
  std::vector<GuidingCache::Maps> kept;
  for (const std::uint32_t number : numbers) {
    const PhotonMapKey key{settings.seed, number, photons_of_map(settings.width, settings.height),
                           field_key(settings)};
    kept.push_back(render.scene.guiding().get_maps(key, [&] {
      return make_photon_maps(render.scene, sources, key,
                              preparation_of(render.pool, render.stop, progress));
    }));
    if (kept.back() == nullptr) {
      return stopped();
    }
    maps.add(number, *kept.back());
  }
  return render_part(render, part, &maps, progress);
}

}  // namespace

absl::StatusOr<BandPixels> render_band_with_kernel(const Scene& scene,
                                                   const RenderSettings& settings, const Band& band,
                                                   Pool& pool, const std::atomic<bool>& stop,
                                                   const RowsDone& progress,
                                                   const TileSamples& tiles) {
  RETURN_IF_ERROR(validate(band, settings));
  std::shared_ptr<const TrainedGuiding> guiding;
  if (settings.integrator == Integrator::kPathGuided || settings.integrator == Integrator::kPath) {
    const GuidingKey key = field_key(settings);
    guiding = scene.guiding().get(key, [&] {
      return train_guiding(scene, key, preparation_of(pool, stop, progress), /*photon_maps=*/true);
    });
    if (guiding == nullptr) {
      return stopped();
    }
  }
  const Render render{scene, settings, pool, stop, guiding.get()};
  const BandPart whole{band, tiles.of(band.rows)};
  return guiding != nullptr && guiding->sources != nullptr
             ? render_with_maps(render, whole, progress)
             : render_part(render, whole, nullptr, progress);
}

}  // namespace bandsaw
