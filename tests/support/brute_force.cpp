// Intersects a ray with every primitive in turn, without a BVH.

#include "tests/support/brute_force.h"

#include <bit>
#include <cstdint>
#include <optional>

#include "renderlib/geometry/deforming_mesh.h"
#include "renderlib/geometry/disk.h"
#include "renderlib/geometry/intersect.h"
#include "renderlib/geometry/placement.h"

namespace bandsaw::test {
namespace {

/// The closest hit so far of one ray. The parameter `instance` has the values of
/// PrimitiveId::instance: 0 for shapes that are in no instance, otherwise the index of the instance
/// plus 1. `ray_.from` is the primitive on which the ray begins. If this primitive is flat, it
/// cannot be hit again; a sphere can. The functions shapes(), mesh() and instance() intersect the
/// ray with all primitives of their argument and pass each hit to consider().
class Search {
 public:
  explicit Search(const Ray& ray) : ray_(ray) { best_.t = ray.t_max; }

  /// Keeps the hit if it is closer than the best one, or as close and of a lower id.
  void consider(const PrimitiveId& id, const Crossing& c) {
    if (c.t < best_.t || (c.t == best_.t && id < best_.id)) {
      best_ = {c.t, id, c.u, c.v};
    }
  }

  void shapes(const Shapes& shapes, const TracedRay& ray, std::uint32_t instance) {
    PrimitiveId id = {instance, 0};
    Crossing c;
    for (const Sphere& sphere : shapes.spheres) {
      if (intersect(ray, sphere, ray_.from == id, c)) {
        consider(id, c);
      }
      ++id.primitive;
    }
    const auto flats = [&](const auto& list) {
      for (const auto& flat : list) {
        if (ray_.from != id && intersect(ray, flat, c)) {
          consider(id, c);
        }
        ++id.primitive;
      }
    };
    flats(shapes.quads);
    flats(shapes.triangles);
    flats(shapes.disks);
  }

  void mesh(const Mesh& mesh, const Interval& shutter, const TracedRay& ray,
            std::uint32_t instance) {
    for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
      const PrimitiveId id = {instance, i};
      const auto [a, b, d] = corners_at(mesh, i, shutter, ray_.time);
      Crossing c;
      if (ray_.from != id && a != b && b != d && d != a && intersect_triangle(ray, a, b, d, c)) {
        consider(id, c);
      }
    }
  }

  void instance(const Geometry& g, std::uint32_t index) {
    const Instance& instance = g.instances[index];
    const std::optional<Transform> to_object = inverse(to_world_at(g, instance, ray_.time));
    if (!to_object) {
      return;
    }
    const TracedRay local = trace_setup(to_object->point(ray_.origin),
                                        to_object->direction(ray_.direction), ray_.t_max);
    if (const Shapes* group = group_of(g, instance)) {
      shapes(*group, local, index + 1);
    } else {
      mesh(g.meshes[index_of(instance.mesh)], g.shutter, local, index + 1);
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
  search.shapes(geometry, trace_setup(ray.origin, ray.direction, ray.t_max), 0);
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
