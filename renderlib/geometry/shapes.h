#pragma once

// What can be hit, as plain values. Meshes keep float32 positions in their own space; placements
// stay double and are never baked into the vertices.

#include <array>
#include <cstdint>
#include <vector>

#include "renderlib/base/ids.h"
#include "renderlib/geometry/frame.h"
#include "renderlib/math/transform.h"
#include "renderlib/math/vec.h"

namespace bandsaw {

struct Sphere {
  Vec3 center;
  double radius = 1;  ///< > 0
  MaterialId material{};
};

/// The parallelogram corner + a u + b v, (a, b) in [0, 1]^2. Normal u x v.
struct Quad {
  Vec3 corner;
  Vec3 u;
  Vec3 v;
  MaterialId material{};
};

/// Normal (b - a) x (c - a).
struct Triangle {
  Vec3 a;
  Vec3 b;
  Vec3 c;
  MaterialId material{};
};

/// Of the points at most `radius` from `center` in the plane across `normal`.
struct Disk {
  Vec3 center;
  Vec3 normal{0, 1, 0};  ///< unit
  double radius = 1;     ///< > 0
  MaterialId material{};
};

/// Shapes that lie loose in one space. As primitives they are counted in this order.
struct Shapes {
  std::vector<Sphere> spheres;
  std::vector<Quad> quads;
  std::vector<Triangle> triangles;
  std::vector<Disk> disks;
  /// Of quads, then triangles, where prepare_surfaces has made them (geometry/surface.h); else
  /// empty, and each hit finds its own.
  std::vector<Vec3> flat_normals = {};

  std::size_t size() const {
    return spheres.size() + quads.size() + triangles.size() + disks.size();
  }
};

enum class ShapeKind { kSphere, kQuad, kTriangle, kDisk };

/// One of the shapes: `index` counts within its kind.
struct ShapeRef {
  ShapeKind kind;
  std::size_t index;
};

/// `primitive` MUST be below shapes.size().
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

inline MaterialId material_of(const Shapes& shapes, std::size_t primitive) {
  const auto [kind, index] = shape_ref(shapes, primitive);
  return kind == ShapeKind::kSphere     ? shapes.spheres[index].material
         : kind == ShapeKind::kQuad     ? shapes.quads[index].material
         : kind == ShapeKind::kTriangle ? shapes.triangles[index].material
                                        : shapes.disks[index].material;
}

struct Mesh {
  std::vector<std::array<float, 3>> positions;
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< indices into positions
  std::vector<std::array<float, 3>> normals;            ///< empty, or one a position
  std::vector<std::array<float, 2>> uvs;                ///< empty, or one a position
  std::vector<std::array<float, 2>> uvs2 = {};    ///< the second set: empty, or one a position
  std::vector<std::array<float, 3>> colors = {};  ///< linear RGB >= 0: empty, or one a position
};

inline constexpr GroupId kNoGroup{0xffffffffu};
/// Of an instance of a group: each of its shapes keeps its own.
inline constexpr MaterialId kOwnMaterial{0xffffffffu};

/// One placement of a mesh or of a group.
struct Instance {
  MeshId mesh{};  ///< meaningless where there is a group
  MaterialId material{};
  Transform to_world;  ///< regular (math/transform.h, inverse); within `frame` where there is one
  GroupId group = kNoGroup;
  FrameId frame = kNoFrame;  ///< what it moves along with (geometry/frame.h)
};

/// Everything that can be hit. In a hit, `instance` 0 is the geometry's own loose shapes;
/// `instance` i + 1 is instances[i], whose `primitive` is the triangle of its mesh or the shape of
/// its group.
struct Geometry : Shapes {
  std::vector<Mesh> meshes;
  std::vector<Instance> instances;
  std::vector<Shapes> groups;  ///< loose shapes in spaces of their own, hit only where placed
  std::vector<Frame> frames;   ///< what moves
};

}  // namespace bandsaw
