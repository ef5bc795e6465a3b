// The samples of a pixel are added in blocks of 8, and the sums of blocks as in a binary tree,
// whose nodes are aligned ranges of samples. add_group() takes the blocks of a group of pixels in
// order, keeps the sums of complete nodes on a stack, and adds two nodes of equal size as soon as
// both are there. A group is one pixel unless pixels share paths.

#include "renderlib/render/pixel_sums.h"

#include <algorithm>
#include <bit>

#include "renderlib/integrate/guide.h"
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
                     const PathOptions& uses, const std::atomic<bool>& stop)
    : scene_(scene),
      settings_(settings),
      band_(band),
      stop_(stop),
      options_{.max_depth = settings.max_depth,
               .technique = technique_of(settings.integrator),
               .local = settings.integrator == Integrator::kDirect,
               .branches = settings.integrator == Integrator::kDirect || uses.portals != nullptr ||
                                   uses.maps != nullptr
                               ? 1
                               : branches_for(scene),
               .guiding = uses.guiding,
               .maps = uses.maps,
               .portals = uses.portals},
      camera_(scene.camera(), static_cast<int>(settings.width), static_cast<int>(settings.height),
              scene.camera_at_close()),
      samples_through_lens_(!scene.lights().empty() && computes_radiance(settings.integrator)),
      reuses_paths_(scene.reuses_paths() && computes_radiance(settings.integrator) &&
                    !options_.local) {}

void PixelSums::add_run(std::uint32_t y, std::uint32_t first, std::uint32_t last,
                        const TileSamples& tiles, absl::Span<double> sums,
                        Counters& counters) const {
  Scratch scratch;
  for (std::uint32_t x = first; x < last && !stopped(); ++x) {
    const PixelPlace place{x, y};
    add_group({&place, 1}, tiles.of_pixel(x, y, band_.samples), sums, scratch, counters);
  }
}

void PixelSums::add_groups(const PixelGroups& groups, std::uint32_t first, std::uint32_t last,
                           const TileSamples& tiles, absl::Span<double> sums,
                           Counters& counters) const {
  Scratch scratch;
  scratch.pixels.reserve(kMaxReusePixels);
  for (std::uint32_t i = first; i < std::min(last, groups.count()) && !stopped(); ++i) {
    const absl::Span<const PixelPlace> group = groups.group(i);
    if (std::any_of(group.begin(), group.end(),
                    [&](const auto& place) { return in_band(place); })) {
      add_group(group, tiles.of_pixel(group[0].x, group[0].y, band_.samples), sums, scratch,
                counters);
    }
  }
}

void PixelSums::add_group(absl::Span<const PixelPlace> places, const SampleRange& samples,
                          absl::Span<double> sums, Scratch& scratch, Counters& counters) const {
  if (samples.samples() == 0) {
    return;
  }
  auto& [pixels, stack] = scratch;
  stack.resize(static_cast<std::size_t>(std::bit_width(samples.blocks())) + 1);
  pixels.clear();
  for (const PixelPlace& place : places) {
    pixels.push_back(
        {.sampler = PixelSampler(settings_.seed, place.x, place.y), .camera_ray = Ray{}});
  }
  std::size_t top = 0;
  for (std::uint64_t block = 0; block < samples.blocks() && !stopped(); ++block) {
    const std::uint64_t first = samples.first + block * kBlockSamples;
    stack[top++] = leaf(places, {first, std::min(first + kBlockSamples, samples.last)},
                        absl::MakeSpan(pixels), counters);
    // Each trailing 1 in the block's binary number means that the block completes a larger node.
    for (std::uint64_t pairs = block; (pairs & 1) != 0; pairs >>= 1) {
      --top;
      for (std::size_t i = 0; i < pixels.size(); ++i) {
        stack[top - 1][i] = stack[top - 1][i] + stack[top][i];
      }
    }
  }
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    if (!in_band(places[i])) {
      continue;
    }
    const std::size_t row = places[i].y - band_.rows.first;
    double* const to = &sums[(row * settings_.width + places[i].x) * 3];
    to[0] = stack[0][i].r;
    to[1] = stack[0][i].g;
    to[2] = stack[0][i].b;
    counters.rays += pixels[i].counts.rays;
    counters.truncated_paths += pixels[i].counts.truncated;
  }
}

PixelSums::Sums PixelSums::leaf(absl::Span<const PixelPlace> places, const SampleRange& samples,
                                absl::Span<ReusePixel> pixels, Counters& counters) const {
  Sums sums{};
  std::array<double, kMaxReusePixels> bad{};
  for (std::uint64_t number = samples.first; number < samples.last; ++number) {
    sample(places, number, pixels);
    for (std::size_t i = 0; i < pixels.size(); ++i) {
      const Rgb& value = pixels[i].radiance;
      const bool finite = is_finite(value);
      if (!finite || value.r < 0 || value.g < 0 || value.b < 0) {
        if (in_band(places[i])) {
          counters.add({.bad_samples = 1,
                        .bad_x = places[i].x,
                        .bad_y = places[i].y,
                        .bad_sample = number,
                        .negative_samples = finite ? 1u : 0u});
        }
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
  return sums;
}

void PixelSums::sample(absl::Span<const PixelPlace> places, std::uint64_t sample,
                       absl::Span<ReusePixel> pixels) const {
  if (is_guide(settings_.integrator)) {
    for (std::size_t i = 0; i < pixels.size(); ++i) {
      const auto camera = [&](std::uint64_t number, double spread) {
        return camera_ray(pixels[i].sampler, places[i], number, spread).ray;
      };
      pixels[i].radiance = guide_sample(scene_, settings_.integrator, pixels[i].sampler, sample,
                                        camera, pixels[i].counts.rays);
    }
    return;
  }
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    pixels[i].camera_ray = camera_ray(pixels[i].sampler, places[i], sample, /*spread=*/1);
  }
  if (reuses_paths_) {
    radiance_with_reuse(scene_, pixels, sample, options_);
    return;
  }
  for (ReusePixel& pixel : pixels) {
    pixel.radiance = sample_value(scene_, settings_.integrator, pixel.camera_ray, pixel.sampler,
                                  sample, options_, pixel.counts);
  }
}

CameraRay PixelSums::camera_ray(const PixelSampler& sampler, const PixelPlace& place,
                                std::uint64_t sample, double spread) const {
  const Sample4 at = sampler.group(sample, kGroupCamera);
  const Vec2 offset = bandsaw::sample(scene_.filter(), at[0], at[1]);
  const double when = scene_.features().motion ? sampler.group(sample, kGroupTime)[0] : 0;
  const Vec2 point{place.x + 0.5 + spread * offset.x, place.y + 0.5 + spread * offset.y};
  CameraRay ray(camera_.ray(point.x, point.y, at[2], at[3], when));
  if (samples_through_lens_) {
    ray.lens = camera_.lens_view(point.x, point.y, when);
  }
  return ray;
}

}  // namespace bandsaw
