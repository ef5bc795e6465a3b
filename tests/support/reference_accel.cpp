// A second, simple BVH that computes in double, as the reference for Accel, the renderer's BVH:
// both must find the same hits.

#include "tests/support/reference_accel.h"

#include <algorithm>
#include <cmath>

namespace bandsaw::test {
namespace {

constexpr std::uint32_t kLeafSize = 4;

Vec3 corner(const Mesh& mesh, std::uint32_t index) {
  const auto& p = mesh.positions[index];
  return {p[0], p[1], p[2]};
}

/// Returns the triangle's bounding box; empty if the triangle is invalid and must be omitted.
Box bounds(const Mesh& mesh, const std::array<std::uint32_t, 3>& triangle) {
  Box box;
  const auto& [a, b, c] = triangle;
  if (std::max({a, b, c}) >= mesh.positions.size()) {
    return box;
  }
  const Vec3 p = corner(mesh, a);
  const Vec3 q = corner(mesh, b);
  const Vec3 r = corner(mesh, c);
  if (is_finite(p) && is_finite(q) && is_finite(r) && !(p == q) && !(q == r) && !(r == p)) {
    box.add(p);
    box.add(q);
    box.add(r);
  }
  return box;
}

/// Returns false if the ray surely misses the box up to the distance `bound`. The margin of 2^-30
/// is far larger than rounding errors, so a box that is hit always gives true.
bool may_meet(const Box& box, const TracedRay& ray, double bound) {
  const double lo[3] = {box.lo.x, box.lo.y, box.lo.z};
  const double hi[3] = {box.hi.x, box.hi.y, box.hi.z};
  double enter = 0;
  double leave = bound * (1 + 0x1p-30);
  for (std::size_t k = 0; k < 3; ++k) {
    const double a = (lo[k] - ray.origin[k]) * ray.inverse[k];
    const double b = (hi[k] - ray.origin[k]) * ray.inverse[k];
    const double first = ray.inverse[k] < 0 ? b : a;
    const double last = ray.inverse[k] < 0 ? a : b;
    enter = first > enter ? first : enter;
    leave = last < leave ? last : leave;
  }
  return enter <= leave * (1 + 0x1p-30);
}

/// Keeps the closer hit. If both are at the same distance, keeps the one with the lower id, as
/// Accel does.
void keep_closer(const PrimitiveId& id, const Crossing& crossing, Hit& best) {
  if (crossing.t < best.t || (crossing.t == best.t && id < best.id)) {
    best = {crossing.t, id, crossing.u, crossing.v};
  }
}

}  // namespace

ReferenceAccel::ReferenceAccel(const Geometry& geometry, bool brute_force)
    : geometry_(geometry), brute_force_(brute_force) {
  for (const Mesh& mesh : geometry.meshes) {
    std::vector<Box> boxes;
    for (const auto& triangle : mesh.triangles) {
      boxes.push_back(bounds(mesh, triangle));
    }
    meshes_.push_back(make_tree(boxes));
  }
  for (const Instance& instance : geometry.instances) {
    to_object_.push_back(inverse(instance.to_world));
  }
  std::vector<Box> boxes;  // of the loose shapes, which are in no instance
  for (const Sphere& sphere : geometry.spheres) {
    boxes.push_back(bandsaw::bounds(sphere));
  }
  for (const Quad& quad : geometry.quads) {
    boxes.push_back(bandsaw::bounds(quad));
  }
  for (const Triangle& triangle : geometry.triangles) {
    boxes.push_back(bandsaw::bounds(triangle));
  }
  loose_ = make_tree(boxes);
}

ReferenceAccel::Tree ReferenceAccel::make_tree(const std::vector<Box>& boxes) const {
  Tree tree;
  for (std::uint32_t i = 0; i < boxes.size(); ++i) {
    if (!boxes[i].empty() && is_finite(boxes[i].lo) && is_finite(boxes[i].hi)) {
      tree.items.push_back(i);
    }
  }
  if (!tree.items.empty()) {
    split(tree, boxes, 0, static_cast<std::uint32_t>(tree.items.size()));
  }
  return tree;
}

/// Appends the tree of the items [first, end), split at the median along the longest axis.
void ReferenceAccel::split(Tree& tree, const std::vector<Box>& boxes, std::uint32_t first,
                           std::uint32_t end) const {
  Node node;
  node.first = first;
  node.count = end - first;
  for (std::uint32_t i = first; i < end; ++i) {
    node.box.add(boxes[tree.items[i]].lo);
    node.box.add(boxes[tree.items[i]].hi);
  }
  const std::size_t index = tree.nodes.size();
  tree.nodes.push_back(node);
  if (brute_force_ || end - first <= kLeafSize) {
    return;
  }
  const Vec3 size = node.box.hi - node.box.lo;
  const int axis = size.x > size.y && size.x > size.z ? 0 : size.y > size.z ? 1 : 2;
  const std::uint32_t middle = first + (end - first) / 2;
  std::nth_element(tree.items.begin() + first, tree.items.begin() + middle,
                   tree.items.begin() + end, [&](std::uint32_t a, std::uint32_t b) {
                     return std::pair(boxes[a].lo[axis] + boxes[a].hi[axis], a) <
                            std::pair(boxes[b].lo[axis] + boxes[b].hi[axis], b);
                   });
  tree.nodes[index].count = 0;
  split(tree, boxes, first, middle);
  tree.nodes[index].right = static_cast<std::uint32_t>(tree.nodes.size());
  split(tree, boxes, middle, end);
}

/// Calls visit(item) for the items of all leaves whose boxes the ray may meet before `bound`.
/// `bound` is a reference, because a visit may make it smaller. With brute force, calls visit(item)
/// for all items.
template <class Visit>
void ReferenceAccel::visit(const Tree& tree, const TracedRay& ray, const double& bound,
                           Visit&& visit) const {
  std::vector<std::uint32_t> open;
  if (!tree.nodes.empty()) {
    open.push_back(0);
  }
  while (!open.empty()) {
    const std::uint32_t index = open.back();
    const Node& node = tree.nodes[index];
    open.pop_back();
    if (!brute_force_ && !may_meet(node.box, ray, bound)) {
      continue;
    }
    for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
      visit(tree.items[i]);
    }
    if (node.count == 0) {
      open.push_back(node.right);
      open.push_back(index + 1);
    }
  }
}

void ReferenceAccel::meet_loose(const Ray& ray, const TracedRay& traced, std::uint32_t index,
                                Hit& best) const {
  const std::size_t first_quad = geometry_.spheres.size();
  const std::size_t first_triangle = first_quad + geometry_.quads.size();
  const PrimitiveId id = {0, index};
  Crossing crossing;
  bool hit = false;
  if (index < first_quad) {
    hit = intersect(traced, geometry_.spheres[index], ray.from == id, crossing);
  } else if (ray.from == id) {
    return;
  } else if (index < first_triangle) {
    hit = intersect(traced, geometry_.quads[index - first_quad], crossing);
  } else {
    hit = intersect(traced, geometry_.triangles[index - first_triangle], crossing);
  }
  if (hit) {
    keep_closer(id, crossing, best);
  }
}

void ReferenceAccel::meet_instance(const Ray& ray, std::uint32_t index, Hit& best) const {
  const std::size_t mesh_index = index_of(geometry_.instances[index].mesh);
  if (!to_object_[index] || mesh_index >= meshes_.size()) {
    return;
  }
  const Vec3 origin = to_object_[index]->point(ray.origin);
  const Vec3 direction = to_object_[index]->direction(ray.direction);
  if (!is_traceable({origin, direction, ray.t_max})) {
    return;
  }
  const TracedRay local = trace_setup(origin, direction, ray.t_max);
  const Mesh& mesh = geometry_.meshes[mesh_index];
  visit(meshes_[mesh_index], local, best.t, [&](std::uint32_t triangle) {
    const auto& [a, b, c] = mesh.triangles[triangle];
    const PrimitiveId id = {index + 1, triangle};
    Crossing crossing;
    if (ray.from != id && intersect_triangle(local, mesh.positions[a], mesh.positions[b],
                                             mesh.positions[c], crossing)) {
      keep_closer(id, crossing, best);
    }
  });
}

Hit ReferenceAccel::closest(const Ray& ray) const {
  Hit best;
  if (!is_traceable(ray)) {
    return best;
  }
  best.t = ray.t_max;
  const TracedRay traced = trace_setup(ray.origin, ray.direction, ray.t_max);
  visit(loose_, traced, best.t, [&](std::uint32_t index) { meet_loose(ray, traced, index, best); });
  for (std::uint32_t i = 0; i < geometry_.instances.size(); ++i) {
    meet_instance(ray, i, best);
  }
  return best ? best : Hit{};
}

}  // namespace bandsaw::test
