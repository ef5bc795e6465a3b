// make_caustic_map() traces the photons of a map in chunks, on all threads, and builds the map from
// them. can_have_caustic_maps() excludes scenes in which photons and paths would not find the same
// light.

#include "renderlib/integrate/caustic_maps.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "renderlib/base/split_mix.h"
#include "renderlib/integrate/trace_photons.h"
#include "renderlib/material/interiors.h"
#include "renderlib/material/opacity.h"
#include "renderlib/math/elementary.h"

namespace bandsaw {
namespace {

/// Number of parts in which photons are traced. It is fixed, so that the sums over the parts have
/// the same bits with any number of threads.
constexpr std::uint32_t kChunks = 64;

/// Largest mean solid angle of the lamps as seen from the casters, in steradians, for which photon
/// maps pay. Paths hit larger lamps often enough, so that their caustics have little noise anyway.
constexpr double kLargestLamp = 0.5;

bool has_emissive_surface(const Scene& scene) {
  return std::any_of(scene.materials().begin(), scene.materials().end(), [](const Material& m) {
    return std::holds_alternative<Emissive>(m.kind) || !is_black(m.emission.radiance.factor);
  });
}

}  // namespace

std::uint64_t photons_of_map(std::uint32_t width, std::uint32_t height) {
  return std::clamp(std::uint64_t{8} * width * height, std::uint64_t{1} << 15,
                    std::uint64_t{1} << 19);
}

std::shared_ptr<const TracedMap> make_caustic_map(const Scene& scene, const Casters& casters,
                                                  const PhotonMapKey& key,
                                                  const Preparation& preparation) {
  std::vector<TracedPhotons> chunks(kChunks);
  if (!preparation.run(kChunks, [&](std::uint64_t i) {
        chunks[i] = trace_photons(scene, casters,
                                  {.seed = key.seed,
                                   .map = key.number,
                                   .photons = key.photons,
                                   .first = key.photons * i / kChunks,
                                   .last = key.photons * (i + 1) / kChunks});
      })) {
    return nullptr;
  }
  TracedMap traced;
  std::vector<CausticPhoton> photons;
  double power_by_angle = 0;
  double power = 0;
  for (TracedPhotons& chunk : chunks) {
    photons.insert(photons.end(), chunk.photons.begin(), chunk.photons.end());
    chunk.photons = {};
    traced.rays += chunk.rays;
    power += chunk.power;
    power_by_angle += chunk.power_by_angle;
  }
  traced.lamp_angle = power > 0 ? power_by_angle / power : 0;
  // Each photon spreads its power over a disk. Knaus and Zwicker multiply the area of the disks of
  // map n = 0, 1, … by about (n + 1)^(alpha - 1), here with alpha = 2/3. So the factor of the area
  // is (n + 1)^(-1/3), and that of the radius is its root, (n + 1)^(-1/6).
  const double factor = pow(key.number + 1.0, -1.0 / 6);
  traced.map = PhotonMap(std::move(photons), factor, split_mix(key.seed ^ key.number),
                         preparation.pool, [&](const CausticPhoton& photon) {
                           return preparation.stopped() ? 1 : share_on_surface(scene, photon);
                         });
  preparation.advance();
  return preparation.stopped() ? nullptr : std::make_shared<const TracedMap>(std::move(traced));
}

bool can_have_caustic_maps(const Scene& scene, const Casters& casters) {
  // In scenes with these materials photons and paths would not find the same light:
  // - Hidden lamps: paths pass through them, but a photon ends at any emitter that it hits.
  // - Nested glass: its index of refraction depends on the other glasses around the point, which a
  //   photon that starts there does not know.
  // - Mixtures with a caster: a path that meets such a part takes it for a caster, but photons do
  //   not start there.
  const auto hinders = [&](const Material& material) {
    const auto* mix = std::get_if<Mix>(&material.kind);
    return is_hidden_lamp(material) || nested_glass(material) != nullptr ||
           (mix != nullptr && (casters.casts(mix->a) || casters.casts(mix->b)));
  };
  return !casters.empty() && casters.complete() && has_emissive_surface(scene) && !scene.moves() &&
         std::none_of(scene.materials().begin(), scene.materials().end(), hinders);
}

bool pays(const TracedMap& map) { return map.map.size() > 0 && map.lamp_angle <= kLargestLamp; }

}  // namespace bandsaw
