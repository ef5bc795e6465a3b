// A group is four random numbers of a sample. All four are computed at once: the sample's index is
// shuffled by an Owen scramble, the Sobol' point of the shuffled index is looked up in a table, and
// each of its four coordinates is scrambled. All this is done on bit-reversed numbers, for which
// scrambling is cheap.

#include "renderlib/sampling/sampler.h"

#include <bit>
#include <cstddef>
#include <cstdint>

#include "renderlib/base/split_mix.h"

namespace bandsaw {
namespace {

// Four unsigned integers of 32 bits at a time. Integer arithmetic is exact on every machine, so the
// compiler's own vectors are used.
using UInt4 = std::uint32_t __attribute__((vector_size(16)));
using Byte16 = std::uint8_t __attribute__((vector_size(16)));

/// Reverses the bits of each lane.
UInt4 reverse_bits(UInt4 x) {
  const auto bytes = std::bit_cast<Byte16>(x);
  x = std::bit_cast<UInt4>(
      __builtin_shufflevector(bytes, bytes, 3, 2, 1, 0, 7, 6, 5, 4, 11, 10, 9, 8, 15, 14, 13, 12));
  x = ((x & 0x0f0f0f0fu) << 4) | ((x >> 4) & 0x0f0f0f0fu);
  x = ((x & 0x33333333u) << 2) | ((x >> 2) & 0x33333333u);
  return ((x & 0x55555555u) << 1) | ((x >> 1) & 0x55555555u);
}

constexpr std::uint32_t reverse_bits(std::uint32_t x) {
  x = __builtin_bswap32(x);
  x = ((x & 0x0f0f0f0fu) << 4) | ((x >> 4) & 0x0f0f0f0fu);
  x = ((x & 0x33333333u) << 2) | ((x >> 2) & 0x33333333u);
  return ((x & 0x55555555u) << 1) | ((x >> 1) & 0x55555555u);
}

/// Owen scrambling of a bit-reversed number: every step makes a bit depend only on lower bits
/// (Laine and Karras 2011; constants of Vegdahl 2021).
template <class UInt>
UInt scramble_reversed(UInt x, UInt seed) {
  x ^= x * 0x3d20adeau;
  x += seed;
  x *= (seed >> 16) | 1u;
  x ^= x * 0x05526c56u;
  x ^= x * 0x53a22864u;
  return x;
}

/// Recurrence of a Sobol' dimension (Joe and Kuo 2008). It computes each direction number from the
/// `degree` previous direction numbers. It is given by a primitive polynomial and the first
/// direction numbers.
struct Polynomial {
  int degree;
  std::uint32_t coefficients;  ///< bits of the inner coefficients
  std::array<std::uint32_t, 3> initial;
};
constexpr std::array<Polynomial, 3> kPolynomials = {{
    {1, 0, {1, 0, 0}},
    {2, 1, {1, 3, 0}},
    {3, 1, {1, 3, 1}},
}};

/// Returns the bit-reversed direction numbers of one dimension.
constexpr std::array<std::uint32_t, 32> reversed_directions(const Polynomial& p) {
  std::array<std::uint32_t, 32> direction{};
  const auto s = static_cast<std::size_t>(p.degree);
  for (std::size_t n = 0; n < 32; ++n) {
    if (n < s) {
      direction[n] = p.initial[n] << (31 - n);
      continue;
    }
    direction[n] = direction[n - s] ^ (direction[n - s] >> s);
    for (std::size_t k = 1; k < s; ++k) {
      if ((p.coefficients >> (s - 1 - k)) & 1u) {
        direction[n] ^= direction[n - k];
      }
    }
  }
  for (std::uint32_t& d : direction) {
    d = reverse_bits(d);
  }
  return direction;
}

/// The table has a row for each group of four bits of a bit-reversed index. A row has an entry for
/// each of the 16 values of these bits. The entry holds the bits that this value flips in each
/// dimension, bit-reversed. The table has 2 KB. Dimension 0 is the index itself.
using Points = std::array<std::uint32_t, 4>;
using PointTable = std::array<std::array<Points, 16>, 8>;

constexpr PointTable make_table() {
  PointTable table{};
  for (std::size_t dimension = 0; dimension < 4; ++dimension) {
    for (std::size_t bit = 0; bit < 32; ++bit) {
      const std::uint32_t adds = dimension == 0
                                     ? std::uint32_t{1} << bit
                                     : reversed_directions(kPolynomials[dimension - 1])[bit];
      const std::size_t at = 31 - bit;
      for (std::size_t value = 0; value < 16; ++value) {
        table[at / 4][value][dimension] ^= ((value >> (at % 4)) & 1u) != 0 ? adds : 0;
      }
    }
  }
  return table;
}

alignas(64) constexpr PointTable kTable = make_table();

/// Returns the Sobol' point of an index; both are bit-reversed.
UInt4 sobol_reversed(std::uint32_t index) {
  UInt4 point = {};
  for (std::size_t i = 0; i < 8; ++i) {
    point ^= std::bit_cast<UInt4>(kTable[i][(index >> (4 * i)) & 15u]);
  }
  return point;
}

}  // namespace

PixelSampler::PixelSampler(std::uint64_t seed, std::uint32_t x, std::uint32_t y)
    : pixel_hash_(
          split_mix(split_mix(seed + kSplitMixIncrement) + ((std::uint64_t{y} << 32) | x))) {}

Sample4 PixelSampler::group(std::uint64_t sample, std::uint32_t group) const {
  // A sequence has 2^32 points. Sample numbers from 2^32 on use further sequences.
  const std::uint64_t sequence = ((sample >> 32) << 32) | group;
  const std::uint64_t base = split_mix(pixel_hash_ + sequence * kSplitMixIncrement);
  const std::uint64_t seeds01 = split_mix(base + kSplitMixIncrement);
  const std::uint64_t seeds23 = split_mix(base + 2 * kSplitMixIncrement);
  const std::uint32_t index = scramble_reversed(reverse_bits(static_cast<std::uint32_t>(sample)),
                                                static_cast<std::uint32_t>(base >> 32));
  const UInt4 points = sobol_reversed(index);
  const UInt4 seeds = {
      static_cast<std::uint32_t>(seeds01), static_cast<std::uint32_t>(seeds01 >> 32),
      static_cast<std::uint32_t>(seeds23), static_cast<std::uint32_t>(seeds23 >> 32)};
  const UInt4 numbers = reverse_bits(scramble_reversed(points, seeds));
  return {numbers[0] * 0x1p-32, numbers[1] * 0x1p-32, numbers[2] * 0x1p-32, numbers[3] * 0x1p-32};
}

NumberStream PixelSampler::stream(std::uint64_t sample, std::uint32_t group) const {
  const std::uint64_t of_group = split_mix(pixel_hash_ + group * kSplitMixIncrement);
  return NumberStream(split_mix(split_mix(~of_group) ^ split_mix(sample + kSplitMixIncrement)));
}

Sample4 sample4(const SampleKey& key, std::uint32_t group) {
  return PixelSampler(key.seed, key.x, key.y).group(key.sample, group);
}

}  // namespace bandsaw
