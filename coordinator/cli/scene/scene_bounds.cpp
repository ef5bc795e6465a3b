#include "coordinator/cli/scene/scene_bounds.h"

#include <vector>

#include "renderlib/geometry/disk.h"
#include "renderlib/geometry/placement.h"

namespace bandsaw::coordinator {
namespace {

void add_box(Box& bounds, const Box& box, const Transform& to_world) {
  if (box.empty()) {
    return;
  }
  for (int corner = 0; corner < 8; ++corner) {
    bounds.add(to_world.point({(corner & 1) != 0 ? box.hi.x : box.lo.x,
                               (corner & 2) != 0 ? box.hi.y : box.lo.y,
                               (corner & 4) != 0 ? box.hi.z : box.lo.z}));
  }
}

Box box_of(const Shapes& shapes) {
  Box box;
  for (const Sphere& s : shapes.spheres) {
    const Vec3 r{s.radius, s.radius, s.radius};
    box.add(s.center - r);
    box.add(s.center + r);
  }
  const auto add_all = [&box](const auto& list) {
    for (const auto& shape : list) {
      add_box(box, bounds(shape), {});
    }
  };
  add_all(shapes.quads);
  add_all(shapes.triangles);
  add_all(shapes.disks);
  return box;
}

Box box_of(const Mesh& mesh) {
  Box box;
  for (const auto& p : mesh.positions) {
    box.add({p[0], p[1], p[2]});
  }
  return box;
}

template <class T>
std::vector<Box> boxes_of(const std::vector<T>& list) {
  std::vector<Box> boxes;
  for (const T& entry : list) {
    boxes.push_back(box_of(entry));
  }
  return boxes;
}

}  // namespace

Box bounds_of(const SceneDescription& scene) {
  const Geometry& geometry = scene.geometry;
  const Shutter& shutter = shutter_of(scene.camera);
  const std::vector<Box> meshes = boxes_of(geometry.meshes);
  const std::vector<Box> groups = boxes_of(geometry.groups);
  Box all = box_of(static_cast<const Shapes&>(geometry));
  for (const Instance& instance : geometry.instances) {
    const Box& box = instance.group == kNoGroup ? meshes[index_of(instance.mesh)]
                                                : groups[index_of(instance.group)];
    add_box(all, box, to_world_at(geometry, instance, shutter.open));
    add_box(all, box, to_world_at(geometry, instance, shutter.close));
  }
  return all;
}

}  // namespace bandsaw::coordinator
