// Tests the hard cases T1, T2, T4, T6, T8, T11, T14 (triangles and meshes) and B7 (sizes that halve
// a thousand times), which cases.txt lists.
//
// In texts, u is the unit roundoff of double, 2^-53.

#include <cmath>
#include <string>

#include "renderlib/math/float3.h"
#include "renderlib/sampling/basis.h"
#include "tests/support/hard_case.h"
#include "tests/support/scenes.h"
#include "tests/support/wide.h"
#include "tests/unit/accel/agreement.h"

namespace bandsaw::test {
namespace {

/// Aims rays from inside a closed mesh at the corners and edges of the mesh. Returns the number of
/// rays that escape. The rays start in a cube about `origin_at`; half a side of the cube is
/// `origin_size`.
int leaks(const Mesh& mesh, const Vec3& origin_at, double origin_size, int count) {
  Pool pool(2);
  const Geometry geometry = scene_of(mesh);
  const Accel accel = Accel::build(geometry, pool);
  Random random(31);
  int missed = 0;
  for (int i = 0; i < count; ++i) {
    const auto& triangle =
        mesh.triangles[random.below(static_cast<std::uint32_t>(mesh.triangles.size()))];
    const auto corner = [&](std::size_t k) {
      const auto& p = mesh.positions[triangle[k]];
      return Vec3{p[0], p[1], p[2]};
    };
    const Vec3 origin = origin_at + origin_size * random_point(random);
    const Vec3 target = i % 2 == 0 ? corner(0) : lerp(corner(0), corner(1), random.uniform());
    const Ray ray{origin, target - origin};
    missed += accel.closest(ray) && accel.occluded(ray) ? 0 : 1;
  }
  return missed;
}

void expect_no_leaks(const char* id, const std::string& mesh, int leaks, int rays) {
  at_most(id, mesh + ": rays that escape, of " + std::to_string(rays), leaks, 0);
}

TEST(Leaks, T1T2_NoneAtCornersAndEdgesOfClosedMeshes) {
  // run.sh uses the second number of tries, and the default tests use the first.
  const int most = tries(150'000, 10'000'000);
  const int some = tries(150'000, 1'000'000);
  const auto check = [](const char* id, const char* name, const Mesh& mesh, const Vec3& at,
                        double size,
                        int rays) { expect_no_leaks(id, name, leaks(mesh, at, size, rays), rays); };
  check("T1", "sphere of 82,000 triangles", icosphere(6), {}, 0.5, most);
  check("T1", "sphere of radius 1e6", scaled(icosphere(5), 1e6), {}, 5e5, some);
  check("T1", "sphere of radius 1e-10", scaled(icosphere(5), 1e-10), {}, 5e-11, some);
  const Vec3 far = {1e5, -1e5, 1e5};
  check("T1", "sphere 1e5 away along each axis", moved(icosphere(4), far), far, 0.5, some);
  check("T2", "sphere of needle triangles", rough_sphere(500, 12, 3, 1), {}, 0.2, most / 2);
  check("T2", "sphere with spikes", rough_sphere(200, 100, 6, 2), {}, 0.2, most / 2);
}

// If the corners of a triangle are collinear, rounding can give the triangle a small area, so the
// triangle test may hit the triangle. Therefore scenes remove triangles without area.
TEST(Triangle, T4_ATriangleWithoutAreaIsNeverHit) {
  Random random(1);
  const Vec3 bad = {-1113.45459, -79.049614, -56.2431908};
  const std::vector<Triangle> degenerate = {{bad, bad, bad, {}},
                                            {{0, 0, 0}, {1, 0, 0}, {0, 0, 0}, {}},
                                            {{0, 0, 0}, {1, 1, 1}, {3, 3, 3}, {}}};
  SceneMaker maker;
  const MaterialId lamp = maker.lamp(1);
  Mesh mesh;
  for (const Triangle& t : degenerate) {
    maker.triangle(t.a, t.b, t.c, lamp);
    for (const Vec3& p : {t.a, t.b, t.c}) {
      mesh.positions.push_back(float3(p));
    }
    const auto next = static_cast<std::uint32_t>(mesh.positions.size());
    mesh.triangles.push_back({next - 3, next - 2, next - 1});
  }
  maker.instance(mesh, {}, lamp);
  const auto scene = maker.build();
  // Each of the three triangles is removed twice: as a shape and as a part of the mesh.
  EXPECT_EQ(scene->dropped_primitives(), 6u);
  EXPECT_TRUE(scene->lights().empty());
  int hits = 0;
  for (const Triangle& t : degenerate) {
    for (int i = 0; i < 100'000; ++i) {
      const Vec3 origin = 10 * random_point(random);
      const Vec3 target = lerp(t.a, t.b, random.uniform());
      hits += scene->accel().closest({origin, target - origin}) ? 1 : 0;
      Crossing crossing;
      if (intersect(trace_setup(origin, target - origin, kInfinity), t, crossing)) {
        ASSERT_TRUE(std::isfinite(crossing.t) && crossing.u >= 0 && crossing.v >= 0);
        ASSERT_LE(length(origin + crossing.t * (target - origin) - target), 1e-12);
      }
    }
  }
  at_most("T4", "hits of 300,000 rays aimed at triangles without area", hits, 0);
}

/// Returns the ray's parameter at the triangle's plane, without rounding.
Wide plane_distance(const Ray& ray, const Triangle& t) {
  const WideVec n = cross(WideVec(t.b) - t.a, WideVec(t.c) - t.a);
  return dot(n, WideVec(t.a) - ray.origin) / dot(n, ray.direction);
}

/// Returns the change of plane_distance() if the last bit of each corner's height changes.
double change_by_last_bits(const Ray& ray, Triangle t) {
  const Wide distance = plane_distance(ray, t);
  for (Vec3* corner : {&t.a, &t.b, &t.c}) {
    corner->y = std::nextafter(corner->y, kInfinity);
  }
  return std::abs(static_cast<double>(plane_distance(ray, t) - distance));
}

TEST(Triangle, T6_AHugeTriangleJustBelowTheCameraIsHit) {
  Random random(2);
  const Transform turns[] = {{}, rotation({1, 2, 3}, 33)};
  for (const Transform& turn : turns) {
    Worst error;
    Worst over_last_bits;
    int missed = 0;
    const Triangle t = {
        turn.point({-5e5, 0, -3e5}), turn.point({5e5, 0, -3e5}), turn.point({0, 0, 6e5}), {}};
    for (int i = 0; i < 20'000; ++i) {
      const double x = random.uniform(-9e4, 9e4);
      const Vec3 below = {x, 0, random.uniform(-9e4, 9e4)};
      const double tilt = 5e-4 * random.uniform(-1, 1);
      const Ray ray = {turn.point(below + Vec3{0, 1e-3, 0}),
                       turn.direction(normalize(Vec3{tilt, -1, 5e-4 * random.uniform(-1, 1)}))};
      Crossing crossing;
      if (!intersect(trace_setup(ray.origin, ray.direction, kInfinity), t, crossing)) {
        ++missed;
        continue;
      }
      // The error of t is reported relative to the size of the scene, and relative to the change of
      // t that one rounding of the corners causes.
      const double off = std::abs(static_cast<double>(crossing.t - plane_distance(ray, t)));
      error.see(off);
      over_last_bits.see(off / change_by_last_bits(ray, t));
    }
    const bool level = turn.direction({0, 1, 0}).y == 1;
    const std::string name = level ? "level triangle" : "tilted triangle";
    at_most("T6", name + ": rays that miss, of 20,000", missed, 0);
    if (level) {
      at_most("T6", "level triangle: error of t divided by the camera's height",
              error.value() / 1e-3, 1e-9);
    } else {
      at_most("T6", "tilted triangle: error of t divided by u x edge length",
              error.value() / (0x1p-53 * 1e6), 8);
      at_most("T6",
              "tilted triangle: error of t divided by the change of t if the last bit of each "
              "corner's height changes",
              over_last_bits.value(), 4);
    }
  }
}

TEST(Triangle, T8_TheNearerOfTwoNearlyCoplanarTrianglesIsHit) {
  Pool pool(1);
  Random random(3);
  int decided = 0;
  int wrong = 0;
  for (int scene = 0; scene < 400; ++scene) {
    Geometry g;
    const Vec3 normal = random_direction(random);
    const Basis b = orthonormal_basis(normal);
    const double gap = std::pow(10, random.uniform(-14, -10));
    for (const double height : {random.below(2) == 0 ? gap : -gap, 0.0}) {
      const Vec3 p = height * normal;
      g.triangles.push_back({p - b.x - b.y, p + 2 * b.x, p + 2 * b.y - b.x, {}});
    }
    const Accel accel = Accel::build(g, pool);
    for (int i = 0; i < 250; ++i) {
      const Vec3 origin = 3 * normal + random_point(random);
      const Ray ray = {origin, normalize(0.3 * random_point(random) - origin)};
      const Wide t0 = plane_distance(ray, g.triangles[0]);
      const Wide t1 = plane_distance(ray, g.triangles[1]);
      const Hit hit = accel.closest(ray);
      const Wide apart = t0 < t1 ? t1 - t0 : t0 - t1;
      if (hit && apart > 64 * 0x1p-53 * t0) {
        ++decided;
        wrong += hit.id.primitive == (t0 < t1 ? 0u : 1u) ? 0 : 1;
      }
    }
  }
  at_least("T8", "rays with more than 64 u t between the two triangles", decided, 50'000);
  at_most("T8", "share of such rays that hit the farther triangle",
          static_cast<double>(wrong) / decided, 1e-5);
}

TEST(Mesh, T11_AMeshOfDenormalSizeIsTracedLikeAnyOther) {
  Pool pool(1);
  const Mesh mesh = scaled(rough_sphere(24, 12, 1.5, 4), 1e-42);
  const Geometry geometry = scene_of(mesh);
  const Accel accel = Accel::build(geometry, pool);
  const ReferenceAccel brute(geometry, true);
  const Box box = box_of(mesh);
  Random random(5);
  const Agreement agreement =
      compare(accel, brute, 3000, [&] { return aimed_ray(mesh, box, random); });
  at_most("T11",
          "results that differ from brute force, of " + std::to_string(agreement.rays) + " rays",
          agreement.different, 0);
  at_least("T11", "rays that hit a triangle", agreement.hits, 1000);
}

TEST(Triangle, T14_WeightsStayInRangeAtCornersAndEdges) {
  Random random(6);
  Worst above;
  int outside = 0;
  for (int i = 0; i < 200'000; ++i) {
    const Triangle t = {random_point(random), random_point(random), random_point(random), {}};
    const Vec3 origin = 4 * random_direction(random);
    const Vec3 target = i % 4 == 0   ? t.a
                        : i % 4 == 1 ? t.b
                        : i % 4 == 2 ? t.c
                                     : lerp(t.b, t.c, random.uniform());
    Crossing crossing;
    if (intersect(trace_setup(origin, target - origin, kInfinity), t, crossing)) {
      outside += crossing.u >= 0 && crossing.u <= 1 && crossing.v >= 0 && crossing.v <= 1 ? 0 : 1;
      above.see(crossing.u + crossing.v - 1);
    }
  }
  at_most("T14", "rays with a barycentric coordinate outside [0, 1], of 200,000", outside, 0);
  at_most("T14", "sum of both barycentric coordinates minus 1, in units of 2^-53",
          above.value() / 0x1p-53, 2);
}

TEST(Tree, B7_SizesThatHalveAThousandTimesAreTracedCorrectly) {
  Pool pool(1);
  Geometry geometry;
  for (int i = 0; i < 1000; ++i) {
    const double size = std::ldexp(1.0, 20 - i);
    geometry.triangles.push_back({{size, 0, 0}, {size, size, 0}, {size, 0, size}, {}});
  }
  const Accel accel = Accel::build(geometry, pool);
  const ReferenceAccel brute(geometry, true);
  Random random(33);
  const Agreement agreement = compare(accel, brute, 2000, [&] {
    const double size = std::ldexp(1.0, 20 - static_cast<int>(random.below(900)));
    const double y = random.uniform() * size / 2;
    return Ray{{size * random.uniform(1, 3), y, random.uniform() * size / 2}, {-1, 0, 0}};
  });
  at_most("B7",
          "results that differ from brute force, of " + std::to_string(agreement.rays) + " rays",
          agreement.different, 0);
  at_least("B7", "rays that hit a triangle", agreement.hits, 1000);
}

}  // namespace
}  // namespace bandsaw::test
