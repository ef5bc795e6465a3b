// Decides which surfaces receive caustics, finds the photon maps of a sample, and estimates the
// light that a receiver scatters from the photons around it.

#include "renderlib/integrate/caustics.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "renderlib/base/check.h"
#include "renderlib/base/overloaded.h"
#include "renderlib/camera/camera.h"

namespace bandsaw {
namespace {

/// The smallest GGX alpha of a wide lobe: a roughness of 1/2.
constexpr double kWideAlpha = 0.25;

/// The smallest GGX alpha of a lobe whose caustics are estimated from photons: a roughness of 0.32.
/// The photons at a point come from few directions, so even a lobe that is not wide gives them all
/// about the same weight.
constexpr double kPhotonAlpha = 0.1;

/// Returns the smallest alpha of the lobes. A smooth coat gives a delta direction and no lobe.
double smallest_alpha(const PlasticBsdf& bsdf) {
  return bsdf.facets ? std::min(bsdf.facets->alpha_u, bsdf.facets->alpha_v) : 1;
}
double smallest_alpha(const MetallicRoughnessBsdf& bsdf) {
  return std::min(bsdf.surface.alpha, bsdf.coat == 0 ? 1 : bsdf.coating.alpha);
}

/// Returns true if the BSDF has a diffuse part.
bool has_diffuse_part(const PlasticBsdf& bsdf) { return !is_black(bsdf.diffuse); }
bool has_diffuse_part(const MetallicRoughnessBsdf& bsdf) {
  return bsdf.metallic < 1 && bsdf.transmission < 1 && !is_black(bsdf.base);
}

/// Returns the role of a BSDF that may have a narrow lobe beside its diffuse part.
template <class Polished>
CausticRole role_of(const Polished& bsdf) {
  if (smallest_alpha(bsdf) >= kWideAlpha) {
    return CausticRole::kReceiver;
  }
  return has_diffuse_part(bsdf) ? CausticRole::kPolishedReceiver : CausticRole::kOther;
}

/// Returns the part of the value of a polished receiver's BSDF for which photons estimate the
/// light.
template <class Polished>
Rgb part_of_photons(const Polished& bsdf, const Vec3& wi) {
  return smallest_alpha(bsdf) >= kPhotonAlpha ? evaluate(bsdf, wi).value : diffuse_part(bsdf, wi);
}
Rgb part_of_photons(const Bsdf& bsdf, const Vec3& wi) {
  return std::visit(
      Overloaded{[&](const PlasticBsdf& b) { return part_of_photons<PlasticBsdf>(b, wi); },
                 [&](const MetallicRoughnessBsdf& b) {
                   return part_of_photons<MetallicRoughnessBsdf>(b, wi);
                 },
                 [](const auto&) { return Rgb{}; }},
      bsdf);
}

}  // namespace

CausticRole role_of_receiver(const Bsdf& bsdf) {
  const CausticRole role =
      std::visit(Overloaded{[](const DiffuseBsdf&) { return CausticRole::kReceiver; },
                            [](const PlasticBsdf& b) { return role_of(b); },
                            [](const MetallicRoughnessBsdf& b) { return role_of(b); },
                            [](const auto&) { return CausticRole::kOther; }},
                 bsdf);
  return has_pdf_behind(bsdf) ? CausticRole::kOther : role;
}

Rgb share_of_paths(CausticRole role, const Bsdf& bsdf, const Vec3& wi) {
  if (role != CausticRole::kPolishedReceiver) {
    return {};
  }
  const Rgb all = evaluate(bsdf, wi).value;
  const Rgb by_photons = part_of_photons(bsdf, wi);
  const auto share = [](float whole, float part) {
    return whole > 0 ? std::max(0.0f, (whole - part) / whole) : 0.0f;
  };
  return {share(all.r, by_photons.r), share(all.g, by_photons.g), share(all.b, by_photons.b)};
}

std::uint16_t part_of_shutter(const Scene& scene, std::uint32_t parts, double time) {
  const Shutter& shutter = shutter_of(scene.camera());
  const double length = shutter.close - shutter.open;
  const double at = length > 0 ? (time - shutter.open) / length * parts : 0;
  return static_cast<std::uint16_t>(std::clamp(at, 0.0, parts - 1.0));
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

Rgb photon_radiance(const PhotonMap& map, const SurfacePoint& point, CausticRole role,
                    const Bsdf& bsdf, const Vec3& wo, const PhotonFilter& filter) {
  const auto is_left_out = [&](const StoredPhoton& photon) {
    return photon.chain > filter.longest || (filter.part && photon.part != *filter.part);
  };
  const Vec3 normal = facing_normal(point, wo);
  Rgb sum;
  const auto* diffuse = std::get_if<DiffuseBsdf>(&bsdf);
  if (diffuse != nullptr && diffuse->normal.shading == diffuse->normal.geometric) {
    // Without a bent normal, a diffuse BSDF reflects light from all directions alike, so it is a
    // factor of the sum.
    map.visit(point.position, normal, [&](const StoredPhoton& photon, float density) {
      sum += is_left_out(photon) ? Rgb{} : photon.power * density;
    });
    return sum * diffuse->reflectance * static_cast<float>(1 / kPi);
  }
  map.visit(point.position, normal, [&](const StoredPhoton& photon, float density) {
    if (is_left_out(photon)) {
      return;
    }
    const Vec3 wi = vec3(photon.from);
    const double cosine = dot(wi, vec3(photon.normal));
    if (cosine > 0) {
      // Both the value of the BSDF and the photon's irradiance contain the cosine.
      const Rgb value = role == CausticRole::kPolishedReceiver ? part_of_photons(bsdf, wi)
                                                               : evaluate(bsdf, wi).value;
      sum += value * photon.power * static_cast<float>(density / cosine);
    }
  });
  return sum;
}

}  // namespace bandsaw
