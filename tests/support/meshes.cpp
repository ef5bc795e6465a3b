// Meshes for tests: spheres and random triangles.

#include "tests/support/meshes.h"

#include <cmath>
#include <map>
#include <utility>

#include "renderlib/math/elementary.h"
#include "renderlib/math/float3.h"

namespace bandsaw::test {
namespace {

/// Makes the midpoints of edges, projected to the unit sphere. Triangles that share an edge share
/// its midpoint.
class Splitter {
 public:
  explicit Splitter(std::vector<Vec3>& points) : points_(points) {}

  /// Returns the index of the midpoint of points a and b.
  std::uint32_t middle(std::uint32_t a, std::uint32_t b) {
    const auto key = std::minmax(a, b);
    const auto [place, is_new] = middles_.try_emplace(key, points_.size());
    if (is_new) {
      points_.push_back(normalize(points_[a] + points_[b]));
    }
    return place->second;
  }

 private:
  std::vector<Vec3>& points_;
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles_;
};

}  // namespace

Mesh icosphere(int levels) {
  // The coordinates of an icosahedron's corners are 0, ±1 and ± the golden ratio g.
  const double g = (1 + std::sqrt(5.0)) / 2;
  std::vector<Vec3> points = {{-1, g, 0}, {1, g, 0}, {-1, -g, 0}, {1, -g, 0},
                              {0, -1, g}, {0, 1, g}, {0, -1, -g}, {0, 1, -g},
                              {g, 0, -1}, {g, 0, 1}, {-g, 0, -1}, {-g, 0, 1}};
  for (Vec3& p : points) {
    p = normalize(p);
  }
  std::vector<std::array<std::uint32_t, 3>> triangles = {
      {0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
      {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
      {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}};
  for (int level = 0; level < levels; ++level) {
    Splitter splitter(points);
    std::vector<std::array<std::uint32_t, 3>> finer;
    for (const auto& [a, b, c] : triangles) {
      const std::uint32_t ab = splitter.middle(a, b);
      const std::uint32_t bc = splitter.middle(b, c);
      const std::uint32_t ca = splitter.middle(c, a);
      finer.insert(finer.end(), {{a, ab, ca}, {b, bc, ab}, {c, ca, bc}, {ab, bc, ca}});
    }
    triangles = std::move(finer);
  }
  Mesh mesh;
  for (const Vec3& p : points) {
    mesh.positions.push_back(float3(p));
  }
  mesh.triangles = std::move(triangles);
  return mesh;
}

Mesh rough_sphere(int slices, int stacks, double spread, std::uint64_t seed) {
  Random random(seed);
  Mesh mesh;
  const auto add = [&](const Vec3& unit) {
    mesh.positions.push_back(float3(unit * random.uniform(1, spread)));
  };
  add({0, 1, 0});
  for (int i = 1; i < stacks; ++i) {
    const SinCos theta = sincos_turns(0.5 * i / stacks);
    for (int j = 0; j < slices; ++j) {
      const SinCos phi = sincos_turns(static_cast<double>(j) / slices);
      add({theta.sin * phi.sin, theta.cos, theta.sin * phi.cos});
    }
  }
  add({0, -1, 0});
  const auto last = static_cast<std::uint32_t>(mesh.positions.size() - 1);
  // The index of the vertex of stack i, slice j; stacks 0 and `stacks` are the poles.
  const auto at = [&](int i, int j) {
    return i == 0        ? 0
           : i == stacks ? last
                         : static_cast<std::uint32_t>(1 + (i - 1) * slices + j % slices);
  };
  for (int i = 0; i < stacks; ++i) {
    for (int j = 0; j < slices; ++j) {
      if (i > 0) {
        mesh.triangles.push_back({at(i, j), at(i + 1, j), at(i, j + 1)});
      }
      if (i + 1 < stacks) {
        mesh.triangles.push_back({at(i, j + 1), at(i + 1, j), at(i + 1, j + 1)});
      }
    }
  }
  return mesh;
}

Mesh triangle_soup(int count, double size, std::uint64_t seed) {
  Random random(seed);
  Mesh mesh;
  for (int i = 0; i < count; ++i) {
    const Vec3 center = random_point(random);
    for (int corner = 0; corner < 3; ++corner) {
      mesh.positions.push_back(float3(center + (size / 2) * random_point(random)));
    }
    const auto first = static_cast<std::uint32_t>(3 * i);
    mesh.triangles.push_back({first, first + 1, first + 2});
  }
  return mesh;
}

Mesh moved(Mesh mesh, const Vec3& by) {
  for (auto& p : mesh.positions) {
    p = float3(vec3(p) + by);
  }
  return mesh;
}

Mesh scaled(Mesh mesh, double by) {
  for (auto& p : mesh.positions) {
    p = float3(vec3(p) * by);
  }
  return mesh;
}

Vec3 random_direction(Random& random) {
  const double z = random.uniform(-1, 1);
  const SinCos phi = sincos_turns(random.uniform());
  const double r = std::sqrt(1 - z * z);
  return {r * phi.cos, r * phi.sin, z};
}

Vec3 random_point(Random& random) {
  const double x = random.uniform(-1, 1);
  const double y = random.uniform(-1, 1);
  return {x, y, random.uniform(-1, 1)};
}

}  // namespace bandsaw::test
