#pragma once

// Traces a ray through the BVHs. Leaves are packs of up to eight primitives: a pack is filtered in
// float, and the primitives that remain are tested in double. `Query` is a class of query.h. Every
// function that returns a bool returns true if the query is finished. Primitive and instance
// numbers are those of PrimitiveId. A float `bound` is the query's bound in the units of the
// FloatRay.

#include <bit>
#include <cstdint>

#include "renderlib/accel/flat_filter.h"
#include "renderlib/accel/query.h"
#include "renderlib/accel/sphere_pack.h"
#include "renderlib/accel/top_tree.h"
#include "renderlib/accel/traverse.h"
#include "renderlib/geometry/disk.h"

namespace bandsaw {

/// Stands for no primitive: the ray starts on none of the primitives that are tested.
inline constexpr std::uint32_t kNoneSkipped = 0xffffffffu;

/// The number of the instance whose primitives are tested (`instance`), and the primitive in it on
/// which the ray starts (`on`; kNoneSkipped if the ray starts elsewhere).
struct Started {
  Started(std::uint32_t of, const PrimitiveId& from)
      : instance(of), on(from.instance == of ? from.primitive : kNoneSkipped) {}
  std::uint32_t instance;
  std::uint32_t on;
};

/// Tests the triangles of a pack except primitive `skipped`. test(lane, crossing) is the double
/// test: it returns true and sets `crossing` if the triangle in that lane is hit. Updates `bound`
/// from the query.
template <class Query, class Test>
inline bool test_flats(const FlatPack& pack, const FloatRay& ray, std::uint32_t instance,
                       std::uint32_t skipped, float& bound, Query& query, Test&& test) {
  const float sure_bound = Query::kAny ? ray.below(query.bound()) : 0;
  const FlatLanes lanes = filter_flats(pack, ray, bound, sure_bound);
  if constexpr (Query::kAny) {
    for (unsigned left = lanes.surely; left != 0; left &= left - 1) {
      const auto lane = static_cast<std::size_t>(std::countr_zero(left));
      if (pack.primitive[lane] != skipped) {
        return true;
      }
    }
  }
  for (unsigned left = lanes.maybe; left != 0; left &= left - 1) {
    const auto lane = static_cast<std::size_t>(std::countr_zero(left));
    Crossing crossing;
    if (pack.primitive[lane] != skipped && test(lane, crossing)) {
      if (query.found({instance, pack.primitive[lane]}, crossing)) {
        return true;
      }
      bound = ray.above(query.bound());
    }
  }
  return false;
}

/// Traces a mesh that does not deform. `from` is the primitive on which the ray starts.
template <class Query>
inline bool trace_mesh(const MeshTree& mesh, const TracedRay& ray, std::uint32_t instance,
                       const PrimitiveId& from, Query& query) {
  const FloatRay floats(ray, mesh.tree.reach);
  float bound = floats.above(query.bound());
  const std::uint32_t skipped = from.instance == instance ? from.primitive : kNoneSkipped;
  return traverse<!Query::kAny>(mesh.tree, floats, bound, [&](ChildRef leaf) {
    const FlatPack& pack = mesh.packs[leaf.leaf_index()];
    return test_flats(
        pack, floats, instance, skipped, bound, query, [&](std::size_t lane, Crossing& crossing) {
          const bool hit = intersect_triangle(ray, pack.vertex(lane, 0), pack.vertex(lane, 1),
                                              pack.vertex(lane, 2), crossing);
          crossing.corners = &pack.corner[0][lane];
          return hit;
        });
  });
}

/// Tests a leaf of loose triangles and quads.
template <class Query>
inline bool trace_loose_flats(const FlatPack& pack, const Shapes& shapes, const TracedRay& ray,
                              const FloatRay& floats, const Started& started, float& bound,
                              Query& query) {
  const std::size_t first_quad = shapes.spheres.size();
  const std::size_t first_triangle = first_quad + shapes.quads.size();
  return test_flats(pack, floats, started.instance, started.on, bound, query,
                    [&](std::size_t lane, Crossing& crossing) {
                      const std::size_t index = pack.primitive[lane];
                      return index < first_triangle
                                 ? intersect(ray, shapes.quads[index - first_quad], crossing)
                                 : intersect(ray, shapes.triangles[index - first_triangle],
                                             crossing);
                    });
}

/// Tests a leaf of spheres.
template <class Query>
inline bool trace_spheres(const SpherePack& pack, const Shapes& shapes, const TracedRay& ray,
                          const FloatRay& floats, const Started& started, float& bound,
                          Query& query) {
  for (unsigned left = filter_spheres(pack, floats, bound); left != 0; left &= left - 1) {
    const std::uint32_t index = pack.primitive[static_cast<std::size_t>(std::countr_zero(left))];
    const PrimitiveId id = {started.instance, index};
    Crossing crossing;
    if (intersect(ray, shapes.spheres[index], index == started.on, crossing)) {
      if (query.found(id, crossing)) {
        return true;
      }
      if constexpr (Query::kBothSides) {
        if (intersect(ray, shapes.spheres[index], /*starts_on_it=*/true, crossing)) {
          query.found(id, crossing);
        }
      }
      bound = floats.above(query.bound());
    }
  }
  return false;
}

/// Tests a leaf of disks. The number of a disk is `first` + its index among the disks.
template <class Query>
[[gnu::noinline]] bool trace_disks(const SpherePack& pack, const Shapes& shapes,
                                   const TracedRay& ray, const FloatRay& floats,
                                   const Started& started, float& bound, Query& query) {
  const auto first = static_cast<std::uint32_t>(shapes.size() - shapes.disks.size());
  for (unsigned left = filter_spheres(pack, floats, bound); left != 0; left &= left - 1) {
    const std::uint32_t index = pack.primitive[static_cast<std::size_t>(std::countr_zero(left))];
    Crossing crossing;
    if (first + index != started.on && intersect(ray, shapes.disks[index], crossing)) {
      if (query.found({started.instance, first + index}, crossing)) {
        return true;
      }
      bound = floats.above(query.bound());
    }
  }
  return false;
}

/// Tests a leaf of loose shapes.
template <class Query>
inline bool trace_leaf(ChildRef leaf, const ShapesTree& tree, const Shapes& shapes,
                       const TracedRay& ray, const FloatRay& floats, const Started& started,
                       float& bound, Query& query) {
  const std::uint32_t index = leaf.leaf_index();
  if (leaf.kind() == LeafKind::kFlats) {
    return trace_loose_flats(tree.flats[index], shapes, ray, floats, started, bound, query);
  }
  if (leaf.kind() == LeafKind::kSpheres) {
    return trace_spheres(tree.spheres[index], shapes, ray, floats, started, bound, query);
  }
  return trace_disks(tree.disks[index], shapes, ray, floats, started, bound, query);
}

/// Traces a group of shapes. `from` is the primitive on which the ray starts.
template <class Query>
[[gnu::noinline]] bool trace_group(const ShapesTree& group, const TracedRay& ray,
                                   std::uint32_t instance, const PrimitiveId& from, Query& query) {
  const FloatRay floats(ray, group.tree.reach);
  float bound = floats.above(query.bound());
  const Started started(instance, from);
  return traverse<!Query::kAny>(group.tree, floats, bound, [&](ChildRef leaf) {
    return trace_leaf(leaf, group, *group.shapes, ray, floats, started, bound, query);
  });
}

/// Traces a mesh that deforms. `world` is the ray in world space; its time selects the shape of the
/// mesh. `ray` is the same ray in the space of the mesh. The function is not inlined, so that
/// tracing a mesh that does not deform is faster.
template <class Query>
[[gnu::noinline]] bool trace_deforming(const MeshTree& mesh, const Interval& shutter,
                                       const TracedRay& ray, std::uint32_t instance,
                                       const Ray& world, Query& query) {
  const ShutterTime now(shutter, world.time);
  const FloatRay floats(ray, mesh.tree.reach);
  float bound = floats.above(query.bound());
  const Started started(instance, world.from);
  const auto enter = [&](std::uint32_t node, Float8& at) {
    return enter_moving_children(mesh.tree, mesh.changes, node, now.share, floats, bound, at);
  };
  return traverse<!Query::kAny>(mesh.tree, bound, enter, [&](ChildRef leaf) {
    const FlatPack pack = pack_at(mesh, leaf.leaf_index(), now);
    return test_flats(pack, floats, instance, started.on, bound, query,
                      [&](std::size_t lane, Crossing& crossing) {
                        return intersect_triangle(ray, pack.vertex(lane, 0), pack.vertex(lane, 1),
                                                  pack.vertex(lane, 2), crossing);
                      });
  });
}

/// Traces a mesh or group. `ray` is the ray `world` transformed to the space of the mesh or group.
template <class Query>
inline bool trace_prototype(const Prototype& prototype, const Interval& shutter,
                            const TracedRay& ray, std::uint32_t instance, const Ray& world,
                            Query& query) {
  if (prototype.mesh != nullptr) {
    return trace_mesh(*prototype.mesh, ray, instance, world.from, query);
  }
  return prototype.group != nullptr
             ? trace_group(*prototype.group, ray, instance, world.from, query)
             : trace_deforming(*prototype.deforming, shutter, ray, instance, world, query);
}

/// Transforms the ray by `to_object` from the world to the space of the prototype (a mesh or a
/// group), and traces it through the prototype.
template <class Query>
inline bool trace_placed(const Prototype& prototype, const Transform& to_object,
                         const Interval& shutter, const Ray& ray, std::uint32_t instance,
                         Query& query) {
  const Vec3 origin = to_object.point(ray.origin);
  const Vec3 direction = to_object.direction(ray.direction);
  if (!is_traceable({origin, direction, ray.t_max})) {
    return false;
  }
  return trace_prototype(prototype, shutter, trace_setup(origin, direction, ray.t_max), instance,
                         ray, query);
}

/// Traces an instance of the top-level tree. `world` is `ray`, prepared for the primitive tests.
template <class Query>
inline bool trace_instance(const Placed& placed, const Interval& shutter, const TracedRay& world,
                           const Ray& ray, Query& query) {
  return placed.identity
             ? trace_prototype(placed.prototype, shutter, world, placed.instance, ray, query)
             : trace_placed(placed.prototype, placed.to_object, shutter, ray, placed.instance,
                            query);
}

/// Traces all geometry except moving instances (accel.cpp traces these).
template <class Query>
inline bool trace(const TopTree& top, const Geometry& geometry, const Ray& ray, Query& query) {
  if (!is_traceable(ray) || top.tree.empty) {
    return false;
  }
  const TracedRay traced = trace_setup(ray.origin, ray.direction, ray.t_max);
  if (top.tree.root.is_leaf() && top.tree.root.kind() == LeafKind::kInstance) {
    return trace_instance(top.placed[top.tree.root.leaf_index()], geometry.shutter, traced, ray,
                          query);
  }
  const FloatRay floats(traced, top.tree.reach);
  float bound = floats.above(query.bound());
  const Started started(0, ray.from);
  return traverse<!Query::kAny>(top.tree, floats, bound, [&](ChildRef leaf) {
    if (leaf.kind() != LeafKind::kInstance) {
      return trace_leaf(leaf, top, geometry, traced, floats, started, bound, query);
    }
    const bool stop =
        trace_instance(top.placed[leaf.leaf_index()], geometry.shutter, traced, ray, query);
    bound = floats.above(query.bound());
    return stop;
  });
}

}  // namespace bandsaw
