#pragma once

// The random numbers of samples: a pure function of (seed, pixel, sample index, dimension), so that
// any machine can render any sample. Owen-scrambled Sobol' points in groups of four dimensions,
// each group with its own shuffle and scrambling (padding): Burley 2020, "Practical Hash-based Owen
// Scrambling", JCGT 9(4), section 4; scramble constants of Vegdahl 2021. Each group has a fixed
// meaning (kGroup... below); there is no "next number", so that paths of different length stay
// stratified.

#include <array>
#include <cstdint>

namespace bandsaw {

/// Identifies one sample of one pixel. Pixel coordinates are relative to the whole image, not to a
/// band.
struct SampleKey {
  std::uint64_t seed = 0;
  std::uint32_t x = 0;
  std::uint32_t y = 0;
  std::uint64_t sample = 0;
};

/// Four numbers in [0, 1), multiples of 2^-32. Any aligned power-of-two range of samples of one
/// (seed, pixel, group) is a (t, m, 4)-net, stratified in projections like the first four Sobol'
/// dimensions.
using Sample4 = std::array<double, 4>;

/// The sampler of one pixel, with the sample-independent part of the hash precomputed.
class PixelSampler {
 public:
  PixelSampler(std::uint64_t seed, std::uint32_t x, std::uint32_t y);
  Sample4 group(std::uint64_t sample, std::uint32_t group) const;

 private:
  std::uint64_t pixel_hash_;
};

/// Returns the same numbers as `PixelSampler(seed, x, y).group(sample, group)`.
Sample4 sample4(const SampleKey& key, std::uint32_t group);

inline constexpr std::uint32_t kGroupCamera = 0;  ///< pixel x, pixel y, lens u, lens v
/// Time; light sampling through the lens: choice, u, v.
inline constexpr std::uint32_t kGroupTime = 1;
/// Scattering `bounce` (0 at the camera ray's hit): direction u, v, lobe, Russian roulette.
constexpr std::uint32_t group_bsdf(std::uint32_t bounce) { return 2 + 2 * bounce; }
/// Light sampling at scattering `bounce`: light choice, light u, v, low bits of the choice.
constexpr std::uint32_t group_light(std::uint32_t bounce) { return 3 + 2 * bounce; }
/// Alpha test of surface number `passed` (below 2^20) on the ray towards scattering `bounce` (below
/// 2^11): opacity, unused, unused, unused.
constexpr std::uint32_t group_alpha(std::uint32_t bounce, std::uint32_t passed) {
  return 0x80000000u | (bounce & 0x7ffu) << 20 | (passed & 0xfffffu);
}
/// Media segment number `segment` (below 2^17) on the ray towards scattering `bounce` (below 2^11).
/// `which` selects one of three groups. 0: scatter or pass and channel, free-flight distance,
/// strategy and distance of light sampling. 1: pivots of equiangular sampling (choice, u, v). 2:
/// light sampling (choice, u, v, low bits of the choice).
constexpr std::uint32_t group_medium(std::uint32_t bounce, std::uint32_t segment,
                                     std::uint32_t which) {
  return 0x40000000u | (bounce & 0x7ffu) << 19 | (segment & 0x1ffffu) << 2 | which;
}

}  // namespace bandsaw
