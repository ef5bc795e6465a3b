#include "renderlib/render/pixel_sums.h"

#include <algorithm>
#include <bit>

#include "renderlib/integrate/sample_value.h"

namespace bandsaw {
namespace {

Technique technique_of(Integrator integrator) {
  return integrator == Integrator::kPathLights       ? Technique::kLightsOnly
         : integrator == Integrator::kPathScattering ? Technique::kScatteringOnly
                                                     : Technique::kBoth;
}

}  // namespace

PixelSums::PixelSums(const Scene& scene, const RenderSettings& settings, const Band& band,
                     const std::atomic<bool>& stop)
    : scene_(scene),
      settings_(settings),
      samples_(band.samples),
      stop_(stop),
      options_{.max_depth = settings.max_depth,
               .technique = technique_of(settings.integrator),
               .local = settings.integrator == Integrator::kDirect,
               .branches = settings.integrator == Integrator::kDirect ? 1 : branches_for(scene)},
      camera_(scene.camera(), static_cast<int>(settings.width), static_cast<int>(settings.height),
              scene.camera_at_close()),
      samples_through_lens_(!scene.lights().empty() && computes_radiance(settings.integrator)),
      reuses_paths_(scene.reuses_paths() && computes_radiance(settings.integrator) &&
                    !options_.local) {}

void PixelSums::add_run(std::uint32_t y, std::uint32_t first, std::uint32_t last,
                        const TileSamples& tiles, absl::Span<double> row,
                        Counters& counters) const {
  Scratch scratch;
  scratch.pixels.reserve(kMaxReusePixels);
  if (!reuses_paths_) {
    for (std::uint32_t x = first; x < last && !stopped(); ++x) {
      add_group(y, {x, x + 1}, tiles.of_pixel(x, y, samples_), row, scratch, counters);
    }
    return;
  }
  const TileGrid grid{settings_.width, settings_.height};
  for (std::uint32_t column = first / kTileSide; column * kTileSide < last; ++column) {
    for (const std::uint32_t half : {0u, 1u}) {
      const HalfRow group = half_row(grid, column, half, y);
      if (group.count() > 0 && !stopped()) {
        add_group(y, group, tiles.of_pixel(group.first, y, samples_), row, scratch, counters);
      }
    }
  }
}

/// Processes leaves in order and adds two siblings as soon as both are present.
void PixelSums::add_group(std::uint32_t y, const HalfRow& group, const SampleRange& samples,
                          absl::Span<double> row, Scratch& scratch, Counters& counters) const {
  if (samples.samples() == 0) {
    return;
  }
  auto& [pixels, stack] = scratch;
  stack.resize(static_cast<std::size_t>(std::bit_width(samples.blocks())) + 1);
  pixels.clear();
  for (std::uint32_t x = group.first; x < group.last; x += 2) {
    pixels.push_back({.sampler = PixelSampler(settings_.seed, x, y), .camera_ray = Ray{}});
  }
  std::size_t top = 0;
  for (std::uint64_t block = 0; block < samples.blocks() && !stopped(); ++block) {
    const std::uint64_t first = samples.first + block * kBlockSamples;
    stack[top++] = leaf(y, group, {first, std::min(first + kBlockSamples, samples.last)},
                        absl::MakeSpan(pixels), counters);
    for (std::uint64_t pairs = block; (pairs & 1) != 0; pairs >>= 1) {
      --top;
      for (std::size_t i = 0; i < pixels.size(); ++i) {
        stack[top - 1][i] = stack[top - 1][i] + stack[top][i];
      }
    }
  }
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    double* const to = &row[(group.first + 2 * i) * 3];
    to[0] = stack[0][i].r;
    to[1] = stack[0][i].g;
    to[2] = stack[0][i].b;
  }
}

PixelSums::Sums PixelSums::leaf(std::uint32_t y, const HalfRow& group, const SampleRange& samples,
                                absl::Span<ReusePixel> pixels, Counters& counters) const {
  Sums sums{};
  std::array<double, kMaxReusePixels> bad{};
  PathCounts counts;
  for (std::uint64_t number = samples.first; number < samples.last; ++number) {
    sample(y, group, number, pixels, counts);
    for (std::size_t i = 0; i < pixels.size(); ++i) {
      const Rgb& value = pixels[i].radiance;
      const bool finite = is_finite(value);
      if (!finite || value.r < 0 || value.g < 0 || value.b < 0) {
        counters.add({.bad_samples = 1,
                      .bad_x = static_cast<std::uint32_t>(group.first + 2 * i),
                      .bad_y = y,
                      .bad_sample = number,
                      .negative_samples = finite ? 1u : 0u});
        bad[i] += 1;
        continue;
      }
      sums[i] = sums[i] + Sum{value.r, value.g, value.b};
    }
  }
  // The mean of the other samples replaces bad ones; counting them as black would darken the pixel.
  const auto taken = static_cast<double>(samples.samples());
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    if (bad[i] > 0 && bad[i] < taken) {
      sums[i] = taken / (taken - bad[i]) * sums[i];
    }
  }
  counters.rays += counts.rays;
  counters.truncated_paths += counts.truncated;
  return sums;
}

void PixelSums::sample(std::uint32_t y, const HalfRow& group, std::uint64_t sample,
                       absl::Span<ReusePixel> pixels, PathCounts& counts) const {
  std::uint32_t x = group.first;
  for (ReusePixel& pixel : pixels) {
    pixel.camera_ray = camera_ray(pixel.sampler, x, y, sample);
    x += 2;
  }
  if (reuses_paths_) {
    radiance_with_reuse(scene_, pixels, sample, options_, counts);
    return;
  }
  for (ReusePixel& pixel : pixels) {
    pixel.radiance = sample_value(scene_, settings_.integrator, pixel.camera_ray, pixel.sampler,
                                  sample, options_, counts);
  }
}

CameraRay PixelSums::camera_ray(const PixelSampler& sampler, std::uint32_t x, std::uint32_t y,
                                std::uint64_t sample) const {
  const Sample4 at = sampler.group(sample, kGroupCamera);
  const Vec2 offset = bandsaw::sample(scene_.filter(), at[0], at[1]);
  const double when = scene_.features().motion ? sampler.group(sample, kGroupTime)[0] : 0;
  const Vec2 place{x + 0.5 + offset.x, y + 0.5 + offset.y};
  CameraRay ray(camera_.ray(place.x, place.y, at[2], at[3], when));
  if (samples_through_lens_) {
    ray.lens = camera_.lens_view(place.x, place.y, when);
  }
  return ray;
}

}  // namespace bandsaw
