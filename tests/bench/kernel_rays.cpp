// Makes the rays of kernel_bench: camera rays in tiles of 8 x 8 pixels, and two rays from each
// point that a camera ray hits. One has a random direction, and one is a shadow ray to a light.

#include "tests/bench/kernel_rays.h"

#include <cmath>

#include "renderlib/geometry/box.h"
#include "tests/support/meshes.h"

namespace bandsaw::bench {
namespace {

constexpr int kTile = 8;     // width and height of a tile, pixels
constexpr int kSide = 1024;  // width and height of the image, pixels

/// Rounds the coordinates to floats.
Vec3 to_float(const Vec3& p) {
  return {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)};
}

/// A camera that looks at the middle of the mesh's bounding box.
struct View {
  Vec3 middle;
  double size;  ///< largest side of the bounding box
  bool from_within;

  Ray ray(int x, int y) const {
    const Vec3 eye = middle + size * (from_within ? Vec3{0.4, 0.2, 0.45} : Vec3{0.75, 0.45, 1.35});
    const Vec3 forward = normalize(middle - eye);
    const Vec3 right = normalize(cross(forward, {0, 1, 0}));
    const Vec3 up = cross(right, forward);
    // 0.73 = 2 tan 20°: a field of view of 40 degrees.
    const double u = ((x + 0.5) / kSide - 0.5) * 0.73;
    const double v = (0.5 - (y + 0.5) / kSide) * 0.73;
    return {to_float(eye), to_float(normalize(forward + u * right + v * up))};
  }
};

Vec3 normal_of(const Mesh& mesh, std::uint32_t triangle) {
  const auto corner = [&](std::size_t i) {
    const auto& p = mesh.positions[mesh.triangles[triangle][i]];
    return Vec3{p[0], p[1], p[2]};
  };
  return normalize(cross(corner(1) - corner(0), corner(2) - corner(0)));
}

}  // namespace

RaySets make_rays(const Mesh& mesh, const Accel& accel, bool from_within) {
  Box box;
  for (const auto& p : mesh.positions) {
    box.add({p[0], p[1], p[2]});
  }
  const double size = max_abs(box.hi - box.lo);
  const View view = {0.5 * (box.lo + box.hi), size, from_within};
  RaySets sets;
  test::Random random(1);
  for (int i = 0; i < kSide * kSide; ++i) {
    const int tile = i / (kTile * kTile);
    const int x = tile % (kSide / kTile) * kTile + i % kTile;
    const int y = tile / (kSide / kTile) * kTile + i / kTile % kTile;
    const Ray ray = view.ray(x, y);
    sets.primary.push_back(ray);
    const Hit hit = accel.closest(ray);
    if (!hit) {
      continue;
    }
    Vec3 normal = normal_of(mesh, hit.id.primitive);
    normal = dot(normal, ray.direction) > 0 ? -normal : normal;
    const Vec3 at = to_float(ray.origin + hit.t * ray.direction + 1e-4 * size * normal);
    // Normal plus a random unit vector is cosine-distributed. The factor 1.0001 keeps the sum from
    // being zero.
    const Vec3 out = test::random_direction(random);
    sets.bounce.push_back({at, to_float(normalize(normal * 1.0001 + out))});
    const Vec3 spot = test::random_point(random);
    // Height of the light above the middle, in sizes of the mesh: just below the top of the
    // bounding box, or above the box.
    const double lift = from_within ? 0.48 : 1.5;
    const Vec3 light = view.middle + size * Vec3{0.3 * spot.x, lift, 0.3 * spot.z};
    sets.shadow.push_back({at, to_float(light - at), 1});
  }
  return sets;
}

}  // namespace bandsaw::bench
