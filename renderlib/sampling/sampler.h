#pragma once

// The numbers a sample is made of: a pure function of (seed, pixel, sample index, dimension), so
// that any machine may render any sample. Owen-scrambled Sobol' points in groups of four
// dimensions, each group with its own shuffle and scrambles: Burley 2020, "Practical Hash-based
// Owen Scrambling", JCGT 9(4), section 4; scramble constants of Vegdahl 2021. Groups have fixed
// meaning (see kGroup... below), never "the next one": paths of different length stay stratified.

#include <array>
#include <cstdint>

namespace bandsaw {

/// Which sample of which pixel. Pixels count from the top left of the whole image, never of a band.
struct SampleKey {
  std::uint64_t seed = 0;
  std::uint32_t x = 0;
  std::uint32_t y = 0;
  std::uint64_t sample = 0;
};

/// Four numbers in [0, 1), multiples of 2^-32. Any aligned power-of-two range of samples of one
/// (seed, pixel, group) is a stratified (t, m, 4)-net under projection as Sobol's first four
/// dimensions are.
using Sample4 = std::array<double, 4>;

/// A pixel's sampler with the part of the hash that does not depend on the sample done once.
class PixelSampler {
 public:
  PixelSampler(std::uint64_t seed, std::uint32_t x, std::uint32_t y);
  Sample4 group(std::uint64_t sample, std::uint32_t group) const;

 private:
  std::uint64_t pixel_hash_;
};

/// The same in one call.
Sample4 sample4(const SampleKey& key, std::uint32_t group);

inline constexpr std::uint32_t kGroupCamera = 0;  ///< pixel x, pixel y, lens u, lens v
inline constexpr std::uint32_t kGroupTime =
    1;  ///< time; a light seen through the lens: choice, u, v
/// Of scattering `bounce` (0 at the camera ray's hit): direction u, v, lobe, Russian roulette.
constexpr std::uint32_t group_bsdf(std::uint32_t bounce) { return 2 + 2 * bounce; }
/// Of scattering `bounce`: light choice, light u, v, finer steps of the choice.
constexpr std::uint32_t group_light(std::uint32_t bounce) { return 3 + 2 * bounce; }
/// Of the surface number `passed` (below 2^20) that is met on the way to scattering `bounce` (below
/// 2^11): whether it is there,
/// -, -, -.
constexpr std::uint32_t group_alpha(std::uint32_t bounce, std::uint32_t passed) {
  return 0x80000000u | (bounce & 0x7ffu) << 20 | (passed & 0xfffffu);
}
/// Of stretch `stretch` (below 2^17) of media on the way to scattering `bounce` (below 2^11), in
/// three groups: 0: what to choose and how far light flies, the same of where a light is asked; 1:
/// points of lights (choice, u, v) that distances are sampled by; 2: the light that is asked
/// (choice, u, v, finer steps of the choice).
constexpr std::uint32_t group_medium(std::uint32_t bounce, std::uint32_t stretch,
                                     std::uint32_t which) {
  return 0x40000000u | (bounce & 0x7ffu) << 19 | (stretch & 0x1ffffu) << 2 | which;
}

}  // namespace bandsaw
