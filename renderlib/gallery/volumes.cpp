// Makes the grids of the scene campfire: densities of smoke and temperatures of flames, by
// formulas.

#include "renderlib/gallery/volumes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <functional>

#include "renderlib/math/vec.h"
#include "renderlib/texture/noise.h"

namespace bandsaw::gallery {
namespace {

struct Box {
  Vec3 low;
  Vec3 high;
};

template <class T>
void append(std::string& bytes, const T& value) {
  std::array<char, sizeof(T)> raw;
  std::memcpy(raw.data(), &value, sizeof(T));
  bytes.append(raw.data(), raw.size());
}

/// Returns the content of a *.vol file with one number for each cell of a grid that fills `box`:
/// `value` at the centre of the cell, clamped to [0, 1]. `cells` is the number of cells along x, y
/// and z.
std::string vol_file(const std::array<std::int32_t, 3>& cells, const Box& box,
                     const std::function<double(const Vec3&)>& value) {
  std::string bytes = "VOL\3";     // version 3
  append(bytes, std::int32_t{3});  // encoding: 8 bits
  append(bytes, cells);
  append(bytes, std::int32_t{1});  // channels
  for (const Vec3& corner : {box.low, box.high}) {
    append(bytes, std::array<float, 3>{static_cast<float>(corner.x), static_cast<float>(corner.y),
                                       static_cast<float>(corner.z)});
  }
  const Vec3 size = box.high - box.low;
  for (std::int32_t z = 0; z < cells[2]; ++z) {
    for (std::int32_t y = 0; y < cells[1]; ++y) {
      for (std::int32_t x = 0; x < cells[0]; ++x) {
        const Vec3 at{box.low.x + size.x * (x + 0.5) / cells[0],
                      box.low.y + size.y * (y + 0.5) / cells[1],
                      box.low.z + size.z * (z + 0.5) / cells[2]};
        append(bytes, static_cast<std::uint8_t>(std::clamp(value(at), 0.0, 1.0) * 255 + 0.5));
      }
    }
  }
  return bytes;
}

double distance_from_axis(const Vec3& p) { return std::sqrt(p.x * p.x + p.z * p.z); }

/// Returns a smooth transition from 0 at `a` to 1 at `b`.
double ramp(double a, double b, double x) {
  const double t = std::clamp((x - a) / (b - a), 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

/// Returns the density of the smoke; vol_file() clamps it.
double smoke_at(const Vec3& p) {
  // The column bends with the wind, and whirls push it aside.
  const Vec3 whirl{noise(p * 1.1 + Vec3{0, 0, 7}), 0, noise(p * 1.1 + Vec3{5, 2, 0})};
  const Vec3 q = p - Vec3{0.07 * p.y * p.y, 0, 0} + whirl * (0.75 * ramp(0, 2.5, p.y));
  const double radius = 0.16 + 0.15 * p.y;
  const double body = 1 - distance_from_axis(q) / radius;
  const double lumps = turbulence(Vec3{q.x, 0.8 * q.y, q.z} * 2.6, 5) - 0.35;
  const double density = 1.5 * body + 1.3 * lumps * ramp(-1.2, 0.3, body);
  return density * ramp(0.5, 1.1, p.y) * ramp(4, 2.6, p.y);
}

/// Returns the temperature of the flames, relative to the hottest place.
double heat_at(const Vec3& p) {
  const Vec3 whirl{noise(Vec3{p.x, 0.6 * p.y, p.z} * 3.4), 0,
                   noise(Vec3{p.x, 0.6 * p.y, p.z} * 3.4 + Vec3{9, 4, 1})};
  const Vec3 q = p + whirl * (0.28 * ramp(0.1, 1.2, p.y));
  const double tongues = 0.55 + 0.45 * noise(Vec3{q.x * 5, q.y * 1.4, q.z * 5} + Vec3{0, 3, 0});
  const double height = 1.45 * tongues + 0.2;
  const double radius = 0.34 * std::sqrt(std::max(0.0, 1 - p.y / height)) + 0.001;
  const double body = 1 - distance_from_axis(q) / radius;
  return ramp(0, 0.5, body) * (1 - 0.35 * p.y / 1.5) * ramp(0, 0.08, p.y);
}

}  // namespace

std::string smoke_volume() {
  return vol_file({48, 64, 32}, {{-1.2, 0, -1}, {1.8, 4, 1}}, smoke_at);
}

std::string flame_volume() {
  return vol_file({32, 48, 32}, {{-0.5, 0, -0.5}, {0.5, 1.5, 0.5}}, heat_at);
}

}  // namespace bandsaw::gallery
