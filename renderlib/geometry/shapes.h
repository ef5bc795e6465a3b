#pragma once

// Geometry as plain values: the description of a scene contains it, and the ray tracer (Accel)
// finds hits in it. Meshes keep float32 positions in their own space; placements stay double and
// are never applied to the vertices in advance.

#include <array>
#include <cstdint>
#include <vector>

#include "renderlib/base/ids.h"
#include "renderlib/geometry/frame.h"
#include "renderlib/geometry/interval.h"
#include "renderlib/geometry/mesh_list.h"
#include "renderlib/math/transform.h"
#include "renderlib/math/vec.h"

namespace bandsaw {

struct Sphere {
  Vec3 center;
  double radius = 1;  ///< > 0
  MaterialId material{};
};

/// The parallelogram corner + a u + b v with (a, b) in [0, 1]^2. Its normal is u x v.
struct Quad {
  Vec3 corner;
  Vec3 u;
  Vec3 v;
  MaterialId material{};
};

/// A triangle with normal (b - a) x (c - a).
struct Triangle {
  Vec3 a;
  Vec3 b;
  Vec3 c;
  MaterialId material{};
};

/// The points at most `radius` from `center` in the plane perpendicular to `normal`.
struct Disk {
  Vec3 center;
  Vec3 normal{0, 1, 0};  ///< unit
  double radius = 1;     ///< > 0
  MaterialId material{};
};

/// Loose shapes, i.e. shapes that belong to no mesh, in one space. Primitives are numbered in the
/// order of these members.
struct Shapes {
  std::vector<Sphere> spheres;
  std::vector<Quad> quads;
  std::vector<Triangle> triangles;
  std::vector<Disk> disks;
  /// Normals of the quads, then of the triangles, if prepare_surfaces() has computed them
  /// (geometry/surface.h); otherwise empty, and each hit computes its own.
  std::vector<Vec3> flat_normals = {};

  std::size_t size() const {
    return spheres.size() + quads.size() + triangles.size() + disks.size();
  }
};

enum class ShapeKind { kSphere, kQuad, kTriangle, kDisk };

/// One of the shapes; `index` counts within its kind.
struct ShapeRef {
  ShapeKind kind;
  std::size_t index;
};

/// Returns the shape of a primitive. `primitive` MUST be below shapes.size().
inline ShapeRef shape_ref(const Shapes& shapes, std::size_t primitive) {
  if (primitive < shapes.spheres.size()) {
    return {ShapeKind::kSphere, primitive};
  }
  primitive -= shapes.spheres.size();
  if (primitive < shapes.quads.size()) {
    return {ShapeKind::kQuad, primitive};
  }
  primitive -= shapes.quads.size();
  if (primitive < shapes.triangles.size()) {
    return {ShapeKind::kTriangle, primitive};
  }
  return {ShapeKind::kDisk, primitive - shapes.triangles.size()};
}

/// Returns the material of a primitive. `primitive` MUST be below shapes.size().
inline MaterialId material_of(const Shapes& shapes, std::size_t primitive) {
  const auto [kind, index] = shape_ref(shapes, primitive);
  return kind == ShapeKind::kSphere     ? shapes.spheres[index].material
         : kind == ShapeKind::kQuad     ? shapes.quads[index].material
         : kind == ShapeKind::kTriangle ? shapes.triangles[index].material
                                        : shapes.disks[index].material;
}

inline constexpr GroupId kNoGroup{0xffffffffu};
/// Instance::material of an instance of a group whose shapes keep their own materials.
inline constexpr MaterialId kOwnMaterial{0xffffffffu};

/// Placement of a mesh or of a group of shapes.
struct Instance {
  MeshId mesh{};  ///< unspecified if there is a group
  MaterialId material{};
  /// Transform from the space of the mesh or group to `frame`, or to the world if there is no
  /// frame; invertible (math/transform.h).
  Transform to_world;
  GroupId group = kNoGroup;
  FrameId frame = kNoFrame;  ///< the frame it moves with (geometry/frame.h)
};

/// All geometry that can be hit. In a hit, `instance` 0 means the geometry's own loose shapes, and
/// `instance` i + 1 means instances[i]. `primitive` is then the number of a triangle in the
/// instance's mesh or of a shape in the instance's group.
struct Geometry : Shapes {
  MeshList meshes;
  std::vector<Instance> instances;
  std::vector<Shapes> groups;  ///< loose shapes in spaces of their own; hit only through instances
  std::vector<Frame> frames;   ///< animated frames; Instance::frame and Frame::parent refer to them
  /// The times of rays: moving instances are bounded within this interval, and meshes deform from
  /// its beginning to its end. Scene::build sets it from the camera's shutter.
  Interval shutter;
};

}  // namespace bandsaw
