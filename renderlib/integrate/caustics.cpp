// Decides which surfaces receive caustics, finds the photon maps of a sample, and estimates the
// light that a receiver scatters from the photons around it.

#include "renderlib/integrate/caustics.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "renderlib/base/check.h"
#include "renderlib/base/overloaded.h"

namespace bandsaw {
namespace {

/// The smallest GGX alpha of a wide lobe: a roughness of 1/2.
constexpr double kWideAlpha = 0.25;

/// Returns true if the coat is smooth, which gives a delta direction and no lobe, or has a wide
/// lobe.
bool is_wide(const PlasticBsdf& bsdf) {
  return !bsdf.facets || std::min(bsdf.facets->alpha_u, bsdf.facets->alpha_v) >= kWideAlpha;
}

/// Returns true if the surface and, if there is one, the coat have wide lobes.
bool is_wide(const MetallicRoughnessBsdf& bsdf) {
  return bsdf.surface.alpha >= kWideAlpha && (bsdf.coat == 0 || bsdf.coating.alpha >= kWideAlpha);
}

}  // namespace

bool receives_caustics(const Bsdf& bsdf) {
  return std::visit(Overloaded{[](const DiffuseBsdf&) { return true; },
                               [](const PlasticBsdf& b) { return is_wide(b); },
                               [](const MetallicRoughnessBsdf& b) { return is_wide(b); },
                               [](const auto&) { return false; }},
                    bsdf) &&
         !has_pdf_behind(bsdf);
}

std::uint32_t PhotonMaps::number_of(std::uint64_t sample) {
  // A unit is kMinSamplesOfMap consecutive samples. Unit 0 has map 0. The units in [2^octave,
  // 2^(octave + 1)) have maps of `root` units each. `first` is the number of the first of these
  // maps: 1 plus the number of maps of all lower octaves.
  const std::uint64_t unit = sample / kMinSamplesOfMap;
  if (unit == 0) {
    return 0;
  }
  const int octave = std::bit_width(unit) - 1;
  const std::uint64_t root = std::uint64_t{1} << (octave / 2);
  const std::uint64_t first = octave % 2 == 0 ? 3 * root - 2 : 4 * root - 2;
  return static_cast<std::uint32_t>(first + (unit - (std::uint64_t{1} << octave)) / root);
}

const TracedMaps& PhotonMaps::of_sample(std::uint64_t sample) const {
  if (for_all_ != nullptr) {
    return *for_all_;
  }
  const std::uint32_t number = number_of(sample);
  const auto found =
      std::lower_bound(maps_.begin(), maps_.end(), number,
                       [](const auto& map, std::uint32_t wanted) { return map.first < wanted; });
  BANDSAW_CHECK(found != maps_.end() && found->first == number, "a sample without photon map");
  return *found->second;
}

Rgb photon_radiance(const PhotonMap& map, const SurfacePoint& point, const Bsdf& bsdf,
                    const Vec3& wo, std::uint32_t longest) {
  const Vec3 normal = facing_normal(point, wo);
  Rgb sum;
  const auto* diffuse = std::get_if<DiffuseBsdf>(&bsdf);
  if (diffuse != nullptr && diffuse->normal.shading == diffuse->normal.geometric) {
    // Without a bent normal, a diffuse BSDF reflects light from all directions alike, so it is a
    // factor of the sum.
    map.visit(point.position, normal, [&](const StoredPhoton& photon, float density) {
      sum += photon.chain <= longest ? photon.power * density : Rgb{};
    });
    return sum * diffuse->reflectance * static_cast<float>(1 / kPi);
  }
  map.visit(point.position, normal, [&](const StoredPhoton& photon, float density) {
    if (photon.chain > longest) {
      return;
    }
    const Vec3 wi = vec3(photon.from);
    const double cosine = dot(wi, vec3(photon.normal));
    if (cosine > 0) {
      // Both the value of the BSDF and the photon's irradiance contain the cosine.
      sum += evaluate(bsdf, wi).value * photon.power * static_cast<float>(density / cosine);
    }
  });
  return sum;
}

}  // namespace bandsaw
