#pragma once

// What Accel must answer, found by the plainest means: every primitive, or a two-wide tree of
// double boxes cut at the middle, and the double tests of renderlib/geometry alone.

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
  /// `geometry` MUST outlive this. `brute_force`: no trees.
  explicit ReferenceAccel(const Geometry& geometry, bool brute_force = false);

  Hit closest(const Ray& ray) const;
  bool occluded(const Ray& ray) const { return static_cast<bool>(closest(ray)); }

 private:
  struct Node {
    Box box;
    std::uint32_t first = 0;
    std::uint32_t count = 0;  // 0: an inner node, its left child the next one
    std::uint32_t right = 0;
  };
  struct Tree {
    std::vector<Node> nodes;
    std::vector<std::uint32_t> items;
  };

  Tree make_tree(const std::vector<Box>& boxes) const;
  void split(Tree& tree, const std::vector<Box>& boxes, std::uint32_t first,
             std::uint32_t end) const;
  template <class Visit>
  void visit(const Tree& tree, const TracedRay& ray, const double& bound, Visit&& visit) const;
  void meet_loose(const Ray& ray, const TracedRay& traced, std::uint32_t index, Hit& best) const;
  void meet_instance(const Ray& ray, std::uint32_t index, Hit& best) const;

  const Geometry& geometry_;
  bool brute_force_;
  std::vector<Tree> meshes_;
  std::vector<std::optional<Transform>> to_object_;
  Tree loose_;
};

}  // namespace bandsaw::test
