#pragma once

// Placement of instances (of a mesh or of a group of shapes) at a time, and their primitives.
// Tracing, surfaces and light sampling all use these functions, so that they see an instance at the
// same place.

#include <optional>

#include "renderlib/geometry/deforming_mesh.h"
#include "renderlib/geometry/shapes.h"

namespace bandsaw {

/// Returns the transform from the mesh's or group's space to the world.
inline Transform to_world_at(const Geometry& geometry, const Instance& instance, double time) {
  return instance.frame == kNoFrame
             ? instance.to_world
             : frame_at(geometry.frames, instance.frame, time) * instance.to_world;
}

/// Returns the group of an instance; null if it places a mesh.
inline const Shapes* group_of(const Geometry& geometry, const Instance& instance) {
  return instance.group == kNoGroup ? nullptr : &geometry.groups[index_of(instance.group)];
}

/// Returns true if the instance's mesh deforms during Geometry::shutter.
inline bool deforms(const Geometry& geometry, const Instance& instance) {
  return instance.group == kNoGroup && deforms(geometry.meshes[index_of(instance.mesh)]);
}

/// Returns true if the instance's primitives may be elsewhere at another time of Geometry::shutter.
inline bool moves(const Geometry& geometry, const Instance& instance) {
  return instance.frame != kNoFrame || deforms(geometry, instance);
}

/// Returns the number of primitives of an instance.
inline std::size_t primitives_of(const Geometry& geometry, const Instance& instance) {
  const Shapes* group = group_of(geometry, instance);
  return group != nullptr ? group->size()
                          : geometry.meshes[index_of(instance.mesh)].triangles.size();
}

/// Returns the material of a primitive of the instance. With kOwnMaterial, an instance keeps the
/// materials of the shapes of its group; otherwise all its primitives have the instance's material.
inline MaterialId material_of(const Geometry& geometry, const Instance& instance,
                              std::size_t primitive) {
  const bool own = instance.group != kNoGroup && instance.material == kOwnMaterial;
  return own ? material_of(*group_of(geometry, instance), primitive) : instance.material;
}

}  // namespace bandsaw
