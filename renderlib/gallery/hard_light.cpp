// Makes the meshes of the scenes in gallery/hard_light: a ring, and the waves of a pool.

#include "renderlib/gallery/hard_light.h"

#include <array>
#include <cmath>

#include "absl/strings/str_format.h"
#include "renderlib/gallery/lathe.h"
#include "renderlib/math/elementary.h"
#include "renderlib/math/vec.h"

namespace bandsaw::gallery {
namespace {

/// A wave: turns per unit along x and z, its phase in turns, and its height.
struct Wave {
  double x;
  double z;
  double phase;
  double height;
};
constexpr std::array<Wave, 5> kWaves = {{{0.55, 0.31, 0.1, 0.022},
                                         {-0.42, 0.77, 0.45, 0.016},
                                         {1.1, -0.6, 0.7, 0.008},
                                         {0.3, 1.45, 0.2, 0.007},
                                         {-1.6, -0.9, 0.9, 0.004}}};

}  // namespace

std::string ring() {
  constexpr std::array<Vec2, 5> kOutside = {
      {{0.8, 0}, {0.86, 0.07}, {0.88, 0.21}, {0.86, 0.35}, {0.8, 0.42}}};
  std::vector<Vec2> profile = smooth_profile(kOutside, 3);
  profile.push_back({0.76, 0.42});
  profile.push_back({0.76, 0});
  profile.push_back({0.8, 0});
  return lathe_obj(profile, 64);
}

std::string waves() {
  constexpr int kSide = 40;
  std::string out = "# The surface of a pool.\n";
  for (int row = 0; row <= kSide; ++row) {
    for (int column = 0; column <= kSide; ++column) {
      const double x = 4.0 * column / kSide - 2;
      const double z = 4.0 * row / kSide - 2;
      double y = 0;
      double along_x = 0;
      double along_z = 0;
      for (const Wave& wave : kWaves) {
        const SinCos at = sincos_turns(wave.x * x + wave.z * z + wave.phase);
        const double slope = 2 * 3.14159265358979 * wave.height * at.cos;
        y += wave.height * at.sin;
        along_x += slope * wave.x;
        along_z += slope * wave.z;
      }
      const Vec3 normal = normalize(Vec3{-along_x, 1, -along_z});
      absl::StrAppendFormat(&out, "v %.4f %.4f %.4f\nvn %.3f %.3f %.3f\n", x, y, z, normal.x,
                            normal.y, normal.z);
    }
  }
  for (int row = 0; row < kSide; ++row) {
    for (int column = 0; column < kSide; ++column) {
      const int a = row * (kSide + 1) + column + 1;
      const int b = a + kSide + 1;
      absl::StrAppendFormat(&out, "f %d//%d %d//%d %d//%d %d//%d\n", a, a, b, b, b + 1, b + 1,
                            a + 1, a + 1);
    }
  }
  return out;
}

}  // namespace bandsaw::gallery
