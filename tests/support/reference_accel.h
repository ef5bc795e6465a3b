#pragma once

// Finds the hits of rays as simply as possible, as a reference for tests of Accel, the renderer's
// BVH. It uses brute force, or a binary tree of boxes in double that is split at the median. It
// uses only the double-precision intersection tests of renderlib/geometry. It supports spheres,
// quads, triangles, and meshes in instances that do not move.

#include <cstdint>
#include <optional>
#include <vector>

#include "renderlib/geometry/box.h"
#include "renderlib/geometry/intersect.h"
#include "renderlib/geometry/ray.h"
#include "renderlib/geometry/shapes.h"

namespace bandsaw::test {

class ReferenceAccel {
 public:
  /// `geometry` MUST outlive this object. `brute_force`: every primitive is tested, without trees.
  explicit ReferenceAccel(const Geometry& geometry, bool brute_force = false);

  /// Returns the closest hit. Of several hits at the same distance, returns the one with the lowest
  /// id. Returns Hit{}, which converts to false, if the ray hits nothing or cannot be traced.
  Hit closest(const Ray& ray) const;
  bool occluded(const Ray& ray) const { return static_cast<bool>(closest(ray)); }

 private:
  struct Node {
    Box box;
    std::uint32_t first = 0;  ///< of a leaf: index of its first entry of Tree::items
    std::uint32_t count = 0;  ///< of a leaf: number of its items; 0: an inner node
    std::uint32_t right = 0;  ///< of an inner node: its right child; the left one is the next node
  };
  struct Tree {
    std::vector<Node> nodes;           ///< the root is the first; empty: nothing can be hit
    std::vector<std::uint32_t> items;  ///< indices of primitives, in the order of the leaves
  };

  /// Returns a tree of the primitives whose boxes are neither empty nor infinite.
  Tree make_tree(const std::vector<Box>& boxes) const;
  /// Appends the subtree of the items [first, end) to `tree`.
  void split(Tree& tree, const std::vector<Box>& boxes, std::uint32_t first,
             std::uint32_t end) const;
  /// Calls visit(item) for each item in the leaves that the ray may meet before the distance
  /// `bound`. A call may reduce `bound`.
  template <class Visit>
  void visit(const Tree& tree, const TracedRay& ray, const double& bound, Visit&& visit) const;
  /// meet_loose() intersects the ray with primitive `index` of loose_, and meet_instance() with all
  /// triangles of instance `index`. Both replace `best` by a hit that is closer, or that is at the
  /// same distance and has a lower id.
  void meet_loose(const Ray& ray, const TracedRay& traced, std::uint32_t index, Hit& best) const;
  void meet_instance(const Ray& ray, std::uint32_t index, Hit& best) const;

  const Geometry& geometry_;
  bool brute_force_;
  std::vector<Tree> meshes_;
  std::vector<std::optional<Transform>> to_object_;  ///< std::nullopt: singular, cannot be hit
  Tree loose_;  ///< of the shapes that are in no instance: spheres, quads, then triangles
};

}  // namespace bandsaw::test
