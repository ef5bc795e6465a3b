#pragma once

// Caustics from photon maps. Photons (trace_photons.h) estimate only the light that travels from a
// light over one or more casters (casters.h) to a receiver. They carry the light of emissive
// surfaces, of delta lights and of the bright places of an environment (photons_carry()). Path
// tracing leaves out just this light. Every surface has one of three roles:
//
// - a caster scatters the photon or the path further,
// - a receiver is a surface with a wide lobe, which scatters the light of the photons towards the
//   camera,
// - any other surface ends the chain of casters.
//
// A scattering in a medium and a delta direction at a receiver also end the chain. A chain is
// counted from the receiver towards the light.
//
// The photon map already contains the light that arrives at the casters of a chain: a photon starts
// at a random point of a caster, and light sampling at this point gives its power (photon_start.h).
// If path tracing added the same light, it would count twice. So path tracing does not sample this
// light at the casters of a chain. If a path hits an emissive surface or an environment directly
// after a caster, and photons carry this light to the caster, the path ignores it. The rest of an
// environment, and backgrounds, are sampled as without photon maps.
//
// Photons also find light that path tracing never finds: the light of a delta light that mirrors or
// smooth glass send to a receiver. Without photon maps, it is missing in the image.

#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "renderlib/guiding/guiding_cache.h"
#include "renderlib/integrate/casters.h"
#include "renderlib/material/bsdf.h"

namespace bandsaw {

/// The role of a surface for caustics, as described above. There are two kinds of receivers:
/// - kReceiver: all lobes that have a pdf are wide. The light that the surface scatters can be
///   estimated from the photons around a point. Such surfaces are diffuse, or of plastic or glTF's
///   material unless they are polished. A smooth coat is a delta direction and does not matter.
/// - kPolishedReceiver: plastic or glTF's material with a lobe that is not wide beside the diffuse
///   part. If the lobe is narrow, photons light the diffuse part only, and paths find the light of
///   the lobe.
enum class CausticRole { kOther, kCaster, kReceiver, kPolishedReceiver };

/// Returns the role of a surface with this BSDF that is no caster. A surface that scatters light
/// from behind is no receiver.
CausticRole role_of_receiver(const Bsdf& bsdf);

/// Returns the role of the surface at this point, of this material with this BSDF.
inline CausticRole caustic_role(const Casters& casters, const SurfacePoint& point,
                                MaterialId material, const Bsdf& bsdf) {
  return casters.casts(material)   ? CausticRole::kCaster
         : casters.moves(point.id) ? CausticRole::kOther
                                   : role_of_receiver(bsdf);
}

/// Returns the number of the part of the shutter interval that contains this time.
std::uint16_t part_of_shutter(const Scene& scene, std::uint32_t parts, double time);

/// Returns true for both kinds of receivers.
inline bool receives_caustics(CausticRole role) {
  return role == CausticRole::kReceiver || role == CausticRole::kPolishedReceiver;
}

/// Returns the share of the light from wi, scattered at a receiver, that photons do not estimate:
/// for each channel, the value of the narrow lobes divided by the value of all lobes. It is black
/// where no lobe is narrow.
Rgb share_of_paths(CausticRole role, const Bsdf& bsdf, const Vec3& wi);

/// The photon maps of some samples of an image: of caustics, and of indirect light
/// (indirect_photons.h). Consecutive samples share them.
class PhotonMaps {
 public:
  /// Number of samples that share one of the first maps. The samples of a pixel are added in blocks
  /// of 8 (render/band.h), and all samples of a block share one map. The error is estimated from
  /// the difference between the two halves of an image's samples (render/error_estimate.h). The
  /// halves consist of whole blocks, so they share no map, and their difference includes the noise
  /// of the maps.
  static constexpr std::uint64_t kMinSamplesOfMap = 8;
  /// Returns the number of the map of a sample. The first four maps have 8 samples each. In
  /// general, samples [8 * 4^k, 32 * 4^k) have maps of 8 * 2^k samples each. So the number of maps
  /// grows only with the square root of the number of samples. It must not grow faster, because a
  /// map costs as much as 10^5 to 10^6 samples, and because a band (rows of the image that one
  /// worker renders) must not need more maps than the worker can keep, even with many samples.
  static std::uint32_t number_of(std::uint64_t sample);

  /// `casters` MUST outlive this object.
  explicit PhotonMaps(const Casters& casters) : casters_(&casters) {}
  /// Adds the maps with this number, which MUST be larger than the numbers of all maps so far. The
  /// maps MUST outlive this object.
  void add(std::uint32_t number, const TracedMaps& maps) { maps_.push_back({number, &maps}); }
  /// Uses these maps for all samples. They MUST outlive this object.
  void use_for_all(const TracedMaps& maps) { for_all_ = &maps; }

  const Casters& casters() const { return *casters_; }
  /// Returns the maps of a sample. They MUST have been added.
  const TracedMaps& of_sample(std::uint64_t sample) const;

 private:
  const Casters* casters_;
  std::vector<std::pair<std::uint32_t, const TracedMaps*>> maps_;
  const TracedMaps* for_all_ = nullptr;
};

/// Describes the photons that light a point.
struct PhotonFilter {
  std::uint32_t longest = 0;  ///< photons with a chain of more scatterings are left out
  /// Photons of other parts of the shutter interval are left out; std::nullopt: none.
  std::optional<std::uint16_t> part = std::nullopt;
};

/// Returns the radiance that a receiver scatters towards `wo`, a unit vector. It is estimated from
/// the photons of the map around the point. `role` is that of the BSDF. The sum is not scaled by
/// the number of parts of the shutter interval.
Rgb photon_radiance(const PhotonMap& map, const SurfacePoint& point, CausticRole role,
                    const Bsdf& bsdf, const Vec3& wo, const PhotonFilter& filter);

}  // namespace bandsaw
