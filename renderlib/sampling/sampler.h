#pragma once

// The random numbers of samples. Each number is a pure function of (seed, pixel, sample index,
// dimension), so that any machine can render any sample. The numbers are Owen-scrambled Sobol'
// points in groups of four dimensions. Each group has its own shuffle and scrambling (padding):
// Burley 2020, "Practical Hash-based Owen Scrambling", JCGT 9(4), section 4, with the scramble
// constants of Vegdahl 2021. Each group has a fixed meaning (kGroupCamera and the functions
// group_... below). There is no function for "the next number", so that paths of different length
// stay stratified.

#include <array>
#include <cstdint>

#include "renderlib/base/split_mix.h"

namespace bandsaw {

/// Identifies one sample of one pixel. Pixel coordinates are relative to the whole image, not to a
/// band.
struct SampleKey {
  std::uint64_t seed = 0;
  std::uint32_t x = 0;
  std::uint32_t y = 0;
  std::uint64_t sample = 0;
};

/// Pixel coordinates of at least this value are outside of the largest image, whose sides have 2^16
/// pixels. Photons and the training of path guiding use such coordinates for their random numbers.
inline constexpr std::uint32_t kBeyondImages = 1u << 24;

/// Four numbers in [0, 1), multiples of 2^-32. Any aligned power-of-two range of samples of one
/// (seed, pixel, group) is a (t, m, 4)-net, stratified in projections like the first four Sobol'
/// dimensions.
using Sample4 = std::array<double, 4>;

/// An unbounded stream of independent numbers, for loops whose length is random (tracking in media
/// that vary in space). The generator is SplitMix64. The numbers are a pure function of its seed.
class NumberStream {
 public:
  explicit constexpr NumberStream(std::uint64_t seed) : state_(seed) {}
  /// Returns the next number in [0, 1), a multiple of 2^-53.
  double next() {
    state_ += kSplitMixIncrement;
    return static_cast<double>(split_mix(state_) >> 11) * 0x1p-53;
  }

 private:
  std::uint64_t state_;
};

/// The sampler of one pixel, with the sample-independent part of the hash precomputed.
class PixelSampler {
 public:
  PixelSampler(std::uint64_t seed, std::uint32_t x, std::uint32_t y);
  /// Returns the four numbers of a group for sample number `sample` of the pixel. `group` is
  /// kGroupCamera, kGroupTime or the result of a function such as group_bsdf().
  Sample4 group(std::uint64_t sample, std::uint32_t group) const;
  /// Returns the stream of a sample and group; different from the numbers of `group()`.
  NumberStream stream(std::uint64_t sample, std::uint32_t group) const;

 private:
  std::uint64_t pixel_hash_;
};

/// Returns the same numbers as `PixelSampler(seed, x, y).group(sample, group)`.
Sample4 sample4(const SampleKey& key, std::uint32_t group);

inline constexpr std::uint32_t kGroupCamera = 0;  ///< pixel x, pixel y, lens u, lens v
/// Time of the sample; then three numbers for light sampling through the lens: choice, u, v.
inline constexpr std::uint32_t kGroupTime = 1;
/// Scattering number `bounce` (0 at the camera ray's hit): direction u, v, the choice of the BSDF's
/// lobe, Russian roulette.
constexpr std::uint32_t group_bsdf(std::uint32_t bounce) { return 2 + 2 * bounce; }
/// Light sampling at scattering `bounce`: light choice, light u, v, low bits of the choice (which
/// needs more than 32 bits if there are many lights).
constexpr std::uint32_t group_light(std::uint32_t bounce) { return 3 + 2 * bounce; }
/// Sampling of the background through portals (openings of a room, guiding/portals.h) at scattering
/// `bounce` (below 2^11). The four numbers are the choice, u, v and an unused one. The stream of
/// this group is for the transmittance of media along the shadow ray.
constexpr std::uint32_t group_portal(std::uint32_t bounce) {
  return 0x10000000u | (bounce & 0x7ffu);
}
/// Alpha test of surface number `passed` (below 2^20) on the ray towards scattering `bounce` (below
/// 2^11): opacity, part of a mixture, unused, unused.
constexpr std::uint32_t group_alpha(std::uint32_t bounce, std::uint32_t passed) {
  return 0x80000000u | (bounce & 0x7ffu) << 20 | (passed & 0xfffffu);
}
/// Media segment number `segment` (below 2^17) on the ray towards scattering `bounce` (below 2^11).
/// A media segment is the part of a ray between two boundaries of media. `which` selects a group.
/// Group 0 has four numbers. The first chooses both between scattering and passing, and the colour
/// channel. The other three are for the free-flight distance, the strategy of light sampling, and
/// the distance of light sampling. Group 1 is for the point on a light around which equiangular
/// sampling is done (choice, u, v; medium/equiangular.h). Group 2 is for light sampling (choice, u,
/// v, low bits of the choice). In media that vary in space, group 0 is for the first collision
/// (choice, distance), and group 3 is the stream of all further numbers.
constexpr std::uint32_t group_medium(std::uint32_t bounce, std::uint32_t segment,
                                     std::uint32_t which) {
  return 0x40000000u | (bounce & 0x7ffu) << 19 | (segment & 0x1ffffu) << 2 | which;
}
/// Uses of the streams with which the transmittance along a shadow ray is estimated, so that each
/// use has a stream of its own.
enum class ShadowUse : std::uint32_t {
  kLight,          ///< light sampling at a surface or, in a medium that varies, at a collision
  kLightBehind,    ///< light sampling on the far side of a surface
  kEmission,       ///< emission of the surface that the path hits
  kEnvironment,    ///< the environment, for Integrator::kDirect
  kLens,           ///< light sampling through the lens
  kMediumSegment,  ///< light sampling in media segment 0; segment n has kMediumSegment + n
};
/// Stream for the transmittance of media along a shadow ray of scattering `bounce` (below 2^11).
/// `segment` (below 2^17) is the number of the media segment for kMediumSegment, otherwise 0.
constexpr std::uint32_t group_shadow(std::uint32_t bounce, ShadowUse use,
                                     std::uint32_t segment = 0) {
  return 0x20000000u | (bounce & 0x7ffu) << 18 |
         ((static_cast<std::uint32_t>(use) + (segment & 0x1ffffu)) & 0x3ffffu);
}

}  // namespace bandsaw
