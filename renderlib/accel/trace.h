#pragma once

// A ray through the trees: packs are filtered in float, what is left is tested in double.

#include <bit>
#include <cstdint>

#include "renderlib/accel/flat_filter.h"
#include "renderlib/accel/query.h"
#include "renderlib/accel/sphere_pack.h"
#include "renderlib/accel/top_tree.h"
#include "renderlib/accel/walk.h"

namespace bandsaw {

inline constexpr std::uint32_t kNoneSkipped = 0xffffffffu;

/// Tests the flats of a pack but `skipped`; test(lane, crossing) is the double test. Lowers `bound`
/// with the query's. True: the query needs no more.
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

template <class Query>
inline bool trace_mesh(const MeshTree& mesh, const TracedRay& ray, std::uint32_t instance,
                       const PrimitiveId& from, Query& query) {
  const FloatRay floats(ray, mesh.tree.reach);
  float bound = floats.above(query.bound());
  const std::uint32_t skipped = from.instance == instance ? from.primitive : kNoneSkipped;
  return walk<!Query::kAny>(mesh.tree, floats, bound, [&](ChildRef leaf) {
    const FlatPack& pack = mesh.packs[leaf.leaf_index()];
    return test_flats(pack, floats, instance, skipped, bound, query,
                      [&](std::size_t lane, Crossing& crossing) {
                        return intersect_triangle(ray, pack.vertex(lane, 0), pack.vertex(lane, 1),
                                                  pack.vertex(lane, 2), crossing);
                      });
  });
}

template <class Query>
inline bool trace_instance(const PlacedMesh& placed, const TracedRay& world, const Ray& ray,
                           Query& query) {
  if (placed.identity) {
    return trace_mesh(*placed.mesh, world, placed.instance, ray.from, query);
  }
  const Vec3 origin = placed.to_object.point(ray.origin);
  const Vec3 direction = placed.to_object.direction(ray.direction);
  if (!is_traceable({origin, direction, ray.t_max})) {
    return false;
  }
  return trace_mesh(*placed.mesh, trace_setup(origin, direction, ray.t_max), placed.instance,
                    ray.from, query);
}

template <class Query>
inline bool trace_loose_flats(const FlatPack& pack, const Geometry& geometry, const TracedRay& ray,
                              const FloatRay& floats, std::uint32_t skipped, float& bound,
                              Query& query) {
  const std::size_t first_quad = geometry.spheres.size();
  const std::size_t first_triangle = first_quad + geometry.quads.size();
  return test_flats(
      pack, floats, 0, skipped, bound, query, [&](std::size_t lane, Crossing& crossing) {
        const std::size_t index = pack.primitive[lane];
        return index < first_triangle
                   ? intersect(ray, geometry.quads[index - first_quad], crossing)
                   : intersect(ray, geometry.triangles[index - first_triangle], crossing);
      });
}

template <class Query>
inline bool trace_spheres(const SpherePack& pack, const Geometry& geometry, const TracedRay& ray,
                          const FloatRay& floats, std::uint32_t started_on, float& bound,
                          Query& query) {
  for (unsigned left = filter_spheres(pack, floats, bound); left != 0; left &= left - 1) {
    const std::uint32_t index = pack.primitive[static_cast<std::size_t>(std::countr_zero(left))];
    Crossing crossing;
    if (intersect(ray, geometry.spheres[index], index == started_on, crossing)) {
      if (query.found({0, index}, crossing)) {
        return true;
      }
      bound = floats.above(query.bound());
    }
  }
  return false;
}

/// True: the query needs no more.
template <class Query>
inline bool trace(const TopTree& top, const Geometry& geometry, const Ray& ray, Query& query) {
  if (!is_traceable(ray) || top.tree.empty) {
    return false;
  }
  const TracedRay traced = trace_setup(ray.origin, ray.direction, ray.t_max);
  if (top.tree.root.is_leaf() && top.tree.root.kind() == LeafKind::kInstance) {
    return trace_instance(top.placed[top.tree.root.leaf_index()], traced, ray, query);
  }
  const FloatRay floats(traced, top.tree.reach);
  float bound = floats.above(query.bound());
  const std::uint32_t from = ray.from.instance == 0 ? ray.from.primitive : kNoneSkipped;
  return walk<!Query::kAny>(top.tree, floats, bound, [&](ChildRef leaf) {
    const std::uint32_t index = leaf.leaf_index();
    switch (leaf.kind()) {
      case LeafKind::kFlats:
        return trace_loose_flats(top.flats[index], geometry, traced, floats, from, bound, query);
      case LeafKind::kSpheres:
        return trace_spheres(top.spheres[index], geometry, traced, floats, from, bound, query);
      case LeafKind::kInstance:
        break;
    }
    const bool stop = trace_instance(top.placed[index], traced, ray, query);
    bound = floats.above(query.bound());
    return stop;
  });
}

}  // namespace bandsaw
