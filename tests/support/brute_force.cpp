#include "tests/support/brute_force.h"

#include <bit>
#include <cstdint>
#include <optional>

#include "renderlib/geometry/intersect.h"

namespace bandsaw::test {
namespace {

class Search {
 public:
  explicit Search(const Ray& ray) : ray_(ray) { best_.t = ray.t_max; }

  void consider(const PrimitiveId& id, const Crossing& c) {
    if (c.t < best_.t || (c.t == best_.t && id < best_.id)) {
      best_ = {c.t, id, c.u, c.v};
    }
  }

  void loose(const Geometry& g) {
    const TracedRay traced = trace_setup(ray_.origin, ray_.direction, ray_.t_max);
    PrimitiveId id = {0, 0};
    Crossing c;
    for (const Sphere& sphere : g.spheres) {
      if (intersect(traced, sphere, ray_.from == id, c)) {
        consider(id, c);
      }
      ++id.primitive;
    }
    for (const Quad& quad : g.quads) {
      if (ray_.from != id && intersect(traced, quad, c)) {
        consider(id, c);
      }
      ++id.primitive;
    }
    for (const Triangle& triangle : g.triangles) {
      if (ray_.from != id && intersect(traced, triangle, c)) {
        consider(id, c);
      }
      ++id.primitive;
    }
  }

  void instance(const Geometry& g, std::uint32_t index) {
    const Instance& instance = g.instances[index];
    const Mesh& mesh = g.meshes[index_of(instance.mesh)];
    const std::optional<Transform> to_object = inverse(instance.to_world);
    if (!to_object) {
      return;
    }
    const TracedRay local = trace_setup(to_object->point(ray_.origin),
                                        to_object->direction(ray_.direction), ray_.t_max);
    for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
      const PrimitiveId id = {index + 1, i};
      const auto& corner = mesh.triangles[i];
      const auto& a = mesh.positions[corner[0]];
      const auto& b = mesh.positions[corner[1]];
      const auto& d = mesh.positions[corner[2]];
      Crossing c;
      if (ray_.from != id && a != b && b != d && d != a && intersect_triangle(local, a, b, d, c)) {
        consider(id, c);
      }
    }
  }

  Hit result() const { return best_ ? best_ : Hit{}; }

 private:
  Ray ray_;
  Hit best_;
};

}  // namespace

Hit closest_by_brute_force(const Geometry& geometry, const Ray& ray) {
  if (!is_traceable(ray)) {
    return {};
  }
  Search search(ray);
  search.loose(geometry);
  for (std::uint32_t i = 0; i < geometry.instances.size(); ++i) {
    search.instance(geometry, i);
  }
  return search.result();
}

bool same_hit(const Hit& a, const Hit& b) {
  const auto bits = [](double x) { return std::bit_cast<std::uint64_t>(x); };
  return a.id == b.id && bits(a.t) == bits(b.t) && bits(a.u) == bits(b.u) && bits(a.v) == bits(b.v);
}

}  // namespace bandsaw::test
