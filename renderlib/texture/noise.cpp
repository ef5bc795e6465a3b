// Perlin's gradient noise: the gradient of a lattice point is selected by a hash of its
// coordinates.

#include "renderlib/texture/noise.h"

#include <array>
#include <cmath>

#include "renderlib/base/split_mix.h"

namespace bandsaw {
namespace {

constexpr std::size_t kGradients = 256;
using Gradients = std::array<Vec3, kGradients>;

/// Returns directions that are uniform on the sphere, by rejection sampling from the cube. Very
/// short vectors are rejected too, because their directions are imprecise.
Gradients make_gradients() {
  Gradients gradients;
  std::uint64_t state = 0;
  const auto next = [&state] {  // a random number in [-1, 1)
    state += kSplitMixIncrement;
    return static_cast<double>(split_mix(state) >> 11) * 0x1p-52 - 1;
  };
  for (Vec3& gradient : gradients) {
    double size2 = 0;
    do {
      gradient.x = next();
      gradient.y = next();
      gradient.z = next();
      size2 = length_squared(gradient);
    } while (size2 > 1 || size2 < 0x1p-20);
    gradient = gradient / std::sqrt(size2);
  }
  return gradients;
}

const Gradients& gradients() {
  static const Gradients table = make_gradients();
  return table;
}

/// A point of the lattice: its integer coordinates, modulo 2^64.
struct Lattice {
  std::uint64_t x;
  std::uint64_t y;
  std::uint64_t z;
};

std::uint64_t hash(const Lattice& p) {
  return split_mix(split_mix(split_mix(p.x * kSplitMixIncrement) + p.y * kSplitMixIncrement) +
                   p.z * kSplitMixIncrement);
}

/// Converts a coordinate of a lattice point, which is a whole number, to its value modulo 2^64.
std::uint64_t lattice(double whole) {
  return static_cast<std::uint64_t>(static_cast<std::int64_t>(whole));
}

/// Returns the Hermite weight for t in [0, 1].
double smooth(double t) { return t * t * (3 - 2 * t); }
double blend(double a, double b, double t) { return a + (b - a) * t; }

}  // namespace

double noise(const Vec3& p) {
  if (!(max_abs(p) < 0x1p51) || !is_finite(p)) {
    return 0;
  }
  const Vec3 whole{std::floor(p.x), std::floor(p.y), std::floor(p.z)};
  const Vec3 part = p - whole;
  const Lattice base{lattice(whole.x), lattice(whole.y), lattice(whole.z)};
  const Gradients& table = gradients();
  std::array<double, 8> corner;
  for (unsigned i = 0; i < corner.size(); ++i) {
    const unsigned dx = i & 1u;
    const unsigned dy = (i >> 1) & 1u;
    const unsigned dz = i >> 2;
    const Vec3& gradient = table[hash({base.x + dx, base.y + dy, base.z + dz}) % kGradients];
    corner[i] = dot(gradient, {part.x - dx, part.y - dy, part.z - dz});
  }
  const double x = smooth(part.x);
  const double y = smooth(part.y);
  const double near = blend(blend(corner[0], corner[1], x), blend(corner[2], corner[3], x), y);
  const double far = blend(blend(corner[4], corner[5], x), blend(corner[6], corner[7], x), y);
  return blend(near, far, smooth(part.z));
}

double turbulence(const Vec3& p, std::uint32_t octaves) {
  double sum = 0;
  double weight = 1;
  Vec3 at = p;
  for (std::uint32_t i = 0; i < octaves; ++i) {
    sum += weight * noise(at);
    weight /= 2;
    at = at * 2.0;
  }
  return std::abs(sum);
}

}  // namespace bandsaw
