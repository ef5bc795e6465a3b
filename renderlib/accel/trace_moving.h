#pragma once

// Traces a ray through the moving instances at the ray's time. Separate from trace.h, so that
// scenes without motion run the same machine code as if motion were not supported.

#include "renderlib/accel/moving_tree.h"
#include "renderlib/accel/trace.h"
#include "renderlib/geometry/placement.h"

namespace bandsaw {

template <class Query>
bool trace_moving_instance(const MovingInstance& moving, const Geometry& geometry, const Ray& ray,
                           Query& query) {
  const Instance& instance = geometry.instances[moving.instance - 1];
  const Transform to_world = to_world_at(geometry, instance, ray.time);
  if (moving.slides) {
    // The same as the result of inverse(), to the bit.
    Transform to_object = moving.to_object;
    const Vec3 back = -to_object.direction({to_world.m[0][3], to_world.m[1][3], to_world.m[2][3]});
    to_object.m[0][3] = back.x;
    to_object.m[1][3] = back.y;
    to_object.m[2][3] = back.z;
    return trace_placed(moving.prototype, to_object, ray, moving.instance, query);
  }
  const std::optional<Transform> to_object = inverse(to_world);
  return to_object && trace_placed(moving.prototype, *to_object, ray, moving.instance, query);
}

/// Traces the moving instances. Returns true if the query is finished.
template <class Query>
[[gnu::noinline]] bool trace_moving(const MovingTree& tree, const Geometry& geometry,
                                    const Ray& ray, Query& query) {
  if (!is_traceable(ray)) {
    return false;
  }
  const FloatRay floats(trace_setup(ray.origin, ray.direction, ray.t_max), tree.tree.reach);
  float bound = floats.above(query.bound());
  const float share = tree.share(ray.time);
  const auto enter = [&](std::uint32_t node, Float8& at) {
    return enter_moving_children(tree, node, share, floats, bound, at);
  };
  return traverse<!Query::kAny>(tree.tree, bound, enter, [&](ChildRef leaf) {
    const bool stop = trace_moving_instance(tree.moving[leaf.leaf_index()], geometry, ray, query);
    bound = floats.above(query.bound());
    return stop;
  });
}

}  // namespace bandsaw
