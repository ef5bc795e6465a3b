// Decides whether path guiding and photon maps pay. The variance of a few samples of some pixels is
// measured. The field of path guiding predicts how much of this variance guiding and photon maps
// would remove. The cells of the field hold the light that arrives at a place: some cells are
// fitted to paths, others to photons. The constants are the limits above which each method pays.

#include "renderlib/integrate/guiding_gain.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "renderlib/camera/camera.h"
#include "renderlib/integrate/path_steps.h"
#include "renderlib/material/albedo.h"
#include "renderlib/math/constants.h"

namespace bandsaw {
namespace {

constexpr std::uint32_t kPixels = 512;
constexpr std::uint64_t kSamples = 8;

/// A pixel darker than this part of the image's mean counts as if it were that bright, because the
/// noise of black pixels is not visible.
constexpr double kDarkest = 1.0 / 16;

/// If the cells of paths would remove less than this share (share_of) of the variance, they cost
/// more than they gain (NOTES.md, "Whether it pays").
constexpr double kMinShareOfPaths = 0.15;
/// If the variance is above this, the cells of paths pay, whatever the field predicts. In such a
/// scene, too few paths of the training have found light for the field to predict the gain.
constexpr double kRareLight = 1.5;
/// The part of the caustics in the variance above which photon maps pay, and the larger one above
/// which guiding by the cells of photons pays as well.
constexpr double kMinShareOfMaps = 0.08;
constexpr double kMinShareOfPhotons = 0.2;
/// The part of an image's light that may be missing before photon maps are used to find it.
constexpr double kMaxMissing = 1.0 / 1024;

/// Photon maps of indirect light are tried if the variance is above kHard, and used if they reduce
/// variance times rays by more than the factor kMinGainOfGathering.
constexpr double kHard = 0.3;
constexpr double kMinGainOfGathering = 1.7;

/// A cell of photons stores the directions of its light as a cone, which is wider than the lamp
/// from which the light comes. So the second moment that the cell holds is too small. The true one
/// is at least this factor times the stored one.
constexpr double kMomentOfLamp = 2;

/// Sums over the samples of a pixel.
struct PixelStatistics {
  double sum = 0;         ///< of the luminances
  double squares = 0;     ///< of the squared luminances
  double direct_sum = 0;  ///< of the luminances of direct light
  double direct_squares = 0;
  double by_paths = 0;    ///< of the variances that the cells of paths would remove
  double by_photons = 0;  ///< of the variances that photons would remove
  double caustics = 0;    ///< of the luminances of caustics that the cells predict
  double expected = 0;    ///< of the luminances that the cells predict
  std::uint64_t rays = 0;
  std::uint64_t direct_rays = 0;
};

/// Returns the variance of one sample, from the sum and the sum of squares of kSamples values.
double variance_of(double sum, double squares) {
  constexpr double kCount = kSamples;
  return std::max(0.0, (squares - sum * sum / kCount) / (kCount - 1));
}

/// Adds what the cells at a surface predict. `reflected`: the path's luminance for an irradiance of
/// 1 there. Moments are in units of the squared mean, so radiance^2 (moment - guided moment) is the
/// variance that guiding removes, and radiance^2 (moment - 1) is all variance.
void add_cells(const GuidingCells& cells, double reflected, PixelStatistics& to) {
  double expected = 0;
  if (cells.paths != nullptr && cells.paths->count > 0) {
    const double radiance = reflected * cells.paths->irradiance;
    expected = radiance;
    to.by_paths += radiance * radiance * (cells.paths->moment - cells.paths->guided_moment);
  }
  if (cells.photons != nullptr && cells.photons->count > 0) {
    const double radiance = reflected * cells.photons->irradiance;
    expected = std::max(expected, radiance);  // the light of the paths may include it
    to.caustics += radiance;
    const double moment =
        std::max(kMomentOfLamp * cells.photons->moment, double{cells.photons->moment_of_lights});
    to.by_photons += radiance * radiance * (moment - 1);
  }
  to.expected += expected;
}

/// Follows the path to the first surface that can be guided, and adds what its cells predict.
void follow(const PathContext& context, const GuidingField& field, const Ray& camera_ray,
            PixelStatistics& to) {
  PathState path(camera_ray);
  for (std::uint32_t depth = 0; depth < context.options.max_depth; ++depth) {
    const std::optional<SurfacePoint> hit = next_surface(context, depth, path);
    const std::optional<Bsdf> bsdf = hit ? make_bsdf(context, *hit, depth, path) : std::nullopt;
    if (!bsdf) {
      return;
    }
    if (can_be_guided(*bsdf)) {
      const Vec3 normal = facing_normal(*hit, -path.ray.direction);
      const Scene& scene = context.scene;
      const Rgb albedo = albedo_at(scene.material(hit->material), scene.textures(), *hit);
      add_cells(field.find(hit->position, normal), luminance(path.throughput * albedo) * kInvPi,
                to);
      return;
    }
    if (!scatter(context, *hit, *bsdf, {}, depth, path)) {
      return;
    }
  }
}

/// Chooses a pixel of the image at random, by the number `pixel`, and takes its samples.
PixelStatistics statistics_of(const Scene& scene, const RayGenerator& camera, const GuidingKey& key,
                              const GuidingField& field, const PathOptions& options,
                              std::uint32_t pixel) {
  constexpr std::uint64_t kSeed = 0x3c6ef372fe94f82b;  // an arbitrary number
  const Sample4 place = PixelSampler(kSeed, pixel, 0).group(0, kGroupCamera);
  const double x = std::floor(place[0] * key.width);
  const double y = std::floor(place[1] * key.height);
  const PixelSampler sampler(kSeed, pixel, 1);
  PathOptions direct = options;
  direct.max_depth = std::min(options.max_depth, 1u);
  PixelStatistics of;
  PathCounts counts;
  PathCounts direct_counts;
  std::uint64_t rays_to_cells = 0;
  for (std::uint64_t sample = 0; sample < kSamples; ++sample) {
    const Sample4 at = sampler.group(sample, kGroupCamera);
    const double when = scene.features().motion ? sampler.group(sample, kGroupTime)[0] : 0;
    const Ray ray = camera.ray(x + at[0], y + at[1], at[2], at[3], when);
    const double value = luminance(path_radiance(scene, ray, sampler, sample, options, counts));
    const double direct_value =
        luminance(path_radiance(scene, ray, sampler, sample, direct, direct_counts));
    if (std::isfinite(value) && std::isfinite(direct_value)) {
      of.sum += value;
      of.squares += value * value;
      of.direct_sum += direct_value;
      of.direct_squares += direct_value * direct_value;
    }
    follow({scene, sampler, sample, options, rays_to_cells}, field, ray, of);
  }
  of.rays = counts.rays;
  of.direct_rays = direct_counts.rays;
  return of;
}

}  // namespace

double GuidingGain::share_of(double part) const { return part > 0 ? part / (variance + part) : 0; }

bool GuidingGain::paths_pay() const {
  return share_of(by_paths) > kMinShareOfPaths || variance > kRareLight;
}

bool GuidingGain::maps_pay() const { return share_of(by_photons) > kMinShareOfMaps; }

bool GuidingGain::misses_light() const { return missing > kMaxMissing; }

bool GuidingGain::photons_pay() const { return share_of(by_photons) > kMinShareOfPhotons; }

bool GuidingGain::gathering_may_pay() const {
  return variance > kHard && variance * rays > kMinGainOfGathering * direct_variance * direct_rays;
}

bool gathering_pays(const GuidingGain& before, const GuidingGain& with) {
  return before.variance * before.rays > kMinGainOfGathering * with.variance * with.rays;
}

std::optional<GuidingGain> expected_gain(const Scene& scene, const GuidingKey& key,
                                         const GuidingField& field, const PathOptions& options,
                                         const Preparation& preparation) {
  const RayGenerator camera(scene.camera(), static_cast<int>(key.width),
                            static_cast<int>(key.height), scene.camera_at_close());
  std::vector<PixelStatistics> pixels(kPixels);
  if (!preparation.run(kPixels, [&](std::uint32_t pixel) {
        pixels[pixel] = statistics_of(scene, camera, key, field, options, pixel);
      })) {
    return std::nullopt;
  }
  constexpr double kAll = kSamples;
  double mean = 0;
  for (const PixelStatistics& pixel : pixels) {
    mean += pixel.sum / kAll / kPixels;
  }
  GuidingGain gain;
  for (const PixelStatistics& pixel : pixels) {
    gain.rays += static_cast<double>(pixel.rays) / kAll / kPixels;
    gain.direct_rays += static_cast<double>(pixel.direct_rays) / kAll / kPixels;
    const double of_pixel = pixel.sum / kAll;
    // The brightness to which the pixel's errors are relative.
    const double unit = std::max({of_pixel, pixel.expected / kAll, kDarkest * mean});
    if (unit > 0) {
      const double part = 1 / (unit * unit * kPixels);
      gain.variance += variance_of(pixel.sum, pixel.squares) * part;
      gain.direct_variance += variance_of(pixel.direct_sum, pixel.direct_squares) * part;
      gain.by_paths += pixel.by_paths / kAll * part;
      gain.by_photons += pixel.by_photons / kAll * part;
      gain.missing += scene.lights().any_delta() ? pixel.caustics / (kAll * unit * kPixels) : 0;
    }
  }
  return gain;
}

}  // namespace bandsaw
