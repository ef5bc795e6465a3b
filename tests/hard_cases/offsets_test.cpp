// Tests the hard cases O1, O5, O7 (rays that leave surfaces), Q8 (closed boxes) and Q1 (shared
// edges of quads), which cases.txt lists.

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "renderlib/accel/accel.h"
#include "renderlib/geometry/intersect.h"
#include "renderlib/geometry/surface.h"
#include "renderlib/material/bsdf.h"
#include "renderlib/math/constants.h"
#include "renderlib/sampling/basis.h"
#include "renderlib/sampling/warp.h"
#include "tests/support/hard_case.h"
#include "tests/support/meshes.h"

namespace bandsaw {
namespace {

using test::Random;
using test::tries;

/// Returns a flat square of 8 x 8 cells, rotated, with its middle at `at`. The cells have edges of
/// length `size` and are quads or pairs of triangles.
Geometry flat_patch(double size, const Vec3& at, bool triangles) {
  const Transform turn = rotation({1, 2, 3}, 33);
  const auto point = [&](int i, int j) {
    return at + turn.point({(i - 4) * size, 0, (j - 4) * size});
  };
  Geometry g;
  for (int i = 0; i < 8; ++i) {
    for (int j = 0; j < 8; ++j) {
      const Vec3 a = point(i, j);
      const Vec3 b = point(i + 1, j);
      const Vec3 c = point(i + 1, j + 1);
      const Vec3 d = point(i, j + 1);
      if (triangles) {
        g.triangles.push_back({a, c, b, {}});
        g.triangles.push_back({a, d, c, {}});
      } else {
        g.quads.push_back({a, d - a, b - a, {}});
      }
    }
  }
  return g;
}

// A plane consists of many triangles or quads. At every scale, a ray that leaves the plane hits
// none of them.
TEST(Offset, O1_NoRayHitsThePlaneItLeaves) {
  // Edge length of the cells, distance of the square from the origin.
  const std::pair<double, double> rows[] = {{1, 0},    {1, 1e3}, {1, 1e5},    {1, 1e6},
                                            {1e-3, 1}, {1e6, 0}, {1e-6, 1e-6}};
  Pool pool(1);
  Random random(1);
  // run.sh uses the second number of tries, and the default tests use the first.
  const int rays = tries(20'000, 1'000'000);
  const Vec3 up = rotation({1, 2, 3}, 33).point({0, 1, 0});
  int hits = 0;
  for (const auto& [size, offset] : rows) {
    for (const bool triangles : {true, false}) {
      const Vec3 at = offset * normalize(Vec3{1, 2, -3});
      const Geometry g = flat_patch(size, at, triangles);
      const Accel accel = Accel::build(g, pool);
      int bounces = 0;
      while (bounces < rays / 2) {
        const Vec3 origin = at + 3 * size * (up + 0.9 * test::random_point(random));
        const Ray ray = {origin, -normalize(up + 0.5 * test::random_point(random))};
        const Hit hit = accel.closest(ray);
        if (!hit) {
          continue;
        }
        const SurfacePoint p = surface_at(g, ray, hit);
        ASSERT_GT(std::abs(dot(p.geometric_normal, up)), 0.99);
        ++bounces;
        const Vec3 d = test::random_direction(random);
        const Vec3 flat = normalize(d - (1 - 1e-4 * random.uniform()) * dot(d, up) * up);
        hits += accel.closest(spawn_ray(p, d)) ? 1 : 0;
        hits += accel.closest(spawn_ray(p, flat)) ? 1 : 0;
      }
    }
  }
  test::at_most("O1",
                "rays that hit the plane that they leave, in 14 settings of " +
                    std::to_string(rays) + " rays",
                hits, 0);
}

/// Two plane quads that meet in the z axis. The first quad is at the angle 0 from the x axis, and
/// the second quad is at the angle `angle`. Paths scatter between the quads.
struct Crease {
  Geometry geometry;
  Vec3 inwards[2];

  explicit Crease(double angle) {
    const Vec3 second = {std::cos(angle), std::sin(angle), 0};
    geometry.quads.push_back({{0, 0, -1}, {0, 0, 2}, {1, 0, 0}, {}});
    geometry.quads.push_back({{0, 0, -1}, second, {0, 0, 2}, {}});
    inwards[0] = {0, 1, 0};
    inwards[1] = {second.y, -second.x, 0};
  }
  /// Returns true if the point is between the planes.
  bool holds(const Vec3& p) const {
    return p.x > 0 && dot(p, inwards[0]) > 0 && dot(p, inwards[1]) > 0;
  }
  /// `ray` MUST hit neither quad. Returns true if the ray leaves by the opening. If the ray starts
  /// more than 0.9 from the z axis, the ray leaves by the opening. Otherwise the point of the ray
  /// at the distance 0.9 from the z axis decides: the ray leaves by the opening if this point is
  /// between the planes or has |z| > 0.9.
  bool leaves_by_opening(const Ray& ray) const {
    const Vec3& o = ray.origin;
    const Vec3& d = ray.direction;
    const double a = d.x * d.x + d.y * d.y;
    const double b = o.x * d.x + o.y * d.y;
    const double c = o.x * o.x + o.y * o.y - 0.81;
    if (c > 0) {
      return true;
    }
    const Vec3 out = o + (-b + std::sqrt(b * b - a * c)) / a * d;
    return std::abs(out.z) > 0.9 || holds(out);
  }
};

// Paths that scatter repeatedly between the planes never get behind them.
TEST(Offset, O5_NoPathEscapesFromACrease) {
  Pool pool(1);
  Random random(2);
  const int bounces = tries(100'000, 10'000'000) / 3;
  for (const double degrees : {90.0, 1.0, 0.01}) {
    const double angle = degrees * kPi / 180;
    const Crease crease(angle);
    const Accel accel = Accel::build(crease.geometry, pool);
    int escapes = 0;
    int done = 0;
    while (done < bounces) {
      const double middle = angle * random.uniform(0.1, 0.9);
      const double r = random.uniform(0.01, 0.5);
      const Vec3 from = {r * std::cos(middle), r * std::sin(middle), 0};
      // The first ray is aimed at a point near the crease, close to the origin of the scene.
      const Vec3 aim = {0, 0.2 * r * angle * random.uniform(-1, 1), 0.1 * random.uniform(-1, 1)};
      Ray ray = {from, normalize(aim - from)};
      Hit hit = accel.closest(ray);
      for (int k = 0; hit && k < 30; ++k, ++done) {
        const SurfacePoint p = surface_at(crease.geometry, ray, hit);
        const Basis basis = orthonormal_basis(crease.inwards[hit.id.primitive]);
        const double u = random.uniform();
        ray = spawn_ray(p, basis.to_world(sample_cosine_hemisphere(u, random.uniform())));
        hit = accel.closest(ray);
      }
      escapes += hit || crease.leaves_by_opening(ray) ? 0 : 1;
    }
    test::at_most("O5",
                  std::to_string(degrees).substr(0, 5) + " degrees: escapes in " +
                      std::to_string(bounces) + " bounces",
                  escapes, 0);
  }
}

TEST(Offset, O7_RefractedRaysStartOnTheFarSide) {
  Random random(3);
  const std::vector<Texture> none;
  const int rays = tries(50'000, 1'000'000);
  int wrong = 0;
  for (int i = 0; i < rays; ++i) {
    SurfacePoint p;
    p.geometric_normal = test::random_direction(random);
    const Vec3 bump = test::random_direction(random);
    p.shading_normal = normalize(p.geometric_normal + 0.5 * bump);
    p.position = 10 * test::random_point(random);
    p.offset = surface_offset(p.position, 1);
    p.away = p.geometric_normal * p.offset;
    const Vec3 wo = test::random_direction(random);
    const auto drawn = sample(bsdf_at(Dielectric{1.5}, none, p, wo), 0, 0, random.uniform());
    if (drawn) {
      const Vec3 moved = spawn_ray(p, drawn->wi).origin - p.position;
      wrong += dot(moved, p.geometric_normal) * dot(drawn->wi, p.geometric_normal) > 0 ? 0 : 1;
    }
  }
  test::at_most("O7", "rays that start on the wrong side, of " + std::to_string(rays), wrong, 0);
}

TEST(Quad, Q1_SharedEdgesDoNotLeak) {
  Random random(4);
  const int rays = tries(20'000, 1'000'000);
  for (const double offset : {0.0, 1e2, 1e4, 1e6}) {
    int lost = 0;
    for (int i = 0; i < rays; ++i) {
      const Vec3 corner = offset * test::random_direction(random);
      const Vec3 shared = test::random_direction(random);
      const Vec3 side = normalize(cross(shared, test::random_direction(random)));
      const Quad left = {corner, shared, side, {}};
      const Quad right = {corner, shared, 0.3 * shared - side, {}};
      const Vec3 up = normalize(cross(shared, side));
      const Vec3 origin = corner + random.uniform(1, 4) * up + 0.5 * test::random_point(random);
      const Vec3 target = corner + random.uniform(0.001, 0.999) * shared;
      const TracedRay ray = trace_setup(origin, target - origin, kInfinity);
      Crossing crossing;
      lost += intersect(ray, left, crossing) || intersect(ray, right, crossing) ? 0 : 1;
    }
    test::at_most("Q1",
                  "offset " + std::to_string(static_cast<int>(offset)) +
                      ": rays that miss both quads, of " + std::to_string(rays),
                  lost, 0);
  }
}

TEST(Box, Q8_NothingEscapesFromSixQuads) {
  Pool pool(1);
  for (const Vec3& at : {Vec3{0, 0, 0}, Vec3{1e3, -1e4, 300}}) {
    Geometry g;
    for (const double side : {0.0, 1.0}) {
      const Vec3 low = at + side * Vec3{1, 1, 1};
      const double s = side == 0 ? 1 : -1;
      g.quads.push_back({low, {s, 0, 0}, {0, s, 0}, {}});
      g.quads.push_back({low, {0, s, 0}, {0, 0, s}, {}});
      g.quads.push_back({low, {0, 0, s}, {s, 0, 0}, {}});
    }
    const Accel accel = Accel::build(g, pool);
    const Vec3 middle = at + Vec3{0.5, 0.5, 0.5};
    Random random(5);
    Ray ray = {middle, {0, 0, 1}};
    const int bounces = tries(200'000, 50'000'000);
    int escapes = 0;
    for (int i = 0; i < bounces; ++i) {
      const Hit hit = accel.closest(ray);
      if (!hit) {
        ++escapes;
        ray = {middle, test::random_direction(random)};
        continue;
      }
      const SurfacePoint p = surface_at(g, ray, hit);
      const Vec3& n = p.geometric_normal;
      const Basis basis = orthonormal_basis(dot(n, ray.direction) > 0 ? -n : n);
      const double u = random.uniform();
      ray = spawn_ray(p, basis.to_world(sample_cosine_hemisphere(u, random.uniform())));
    }
    test::at_most("Q8", "escapes in " + std::to_string(bounces) + " bounces", escapes, 0);
  }
}

}  // namespace
}  // namespace bandsaw
