#pragma once

// Light tree: selects one of many lights by descending a binary tree. At each node, a child is
// selected with a probability in proportion to its importance, an approximate upper bound of its
// contribution (light/light_bound.h).
//
// The method is that of Conty Estevez and Kulla 2018, "Importance Sampling of Many Lights with
// Adaptive Tree Splitting". The tree is built with the surface area orientation heuristic
// (sections 4.3 and 4.4). The probability of a light is the product of the probabilities of the
// children on the path from the root to it. This path is known for each light, so the probability
// can also be computed for a light that was not selected.

#include <cstdint>
#include <optional>
#include <vector>

#include "renderlib/light/light_bound.h"

namespace bandsaw {

class LightTree {
 public:
  /// Maximum depth of a node.
  static constexpr std::uint32_t kMaxDepth = 64;

  struct Choice {
    std::uint32_t light = 0;
    double probability = 0;  ///< > 0
  };

  LightTree() = default;
  /// `lights` MUST have at least one and fewer than 2^31 elements.
  explicit LightTree(const std::vector<LightBound>& lights);

  bool empty() const { return nodes_.empty(); }
  /// Returns the importance of all lights together. In all functions, `From` is `Receiver` (a point
  /// that receives light) or `ReceiverSegment` (a segment of a ray in a medium).
  template <typename From>
  double importance(const From& receiver) const;
  /// Selects a light. `number` is in [0, 1). Returns std::nullopt if no light reaches the receiver.
  template <typename From>
  std::optional<Choice> choose(const From& receiver, double number) const;
  /// Returns the probability with which `choose()` selects the light.
  double probability(const Receiver& receiver, std::uint32_t light) const;

 private:
  friend class LightTreeBuilder;
  struct Node {
    LightBound bound;
    /// Index of the first of two adjacent children; in a leaf, the index of its light.
    std::uint32_t first = 0;
    std::uint32_t parent = 0;
    bool is_leaf = false;
  };
  /// Returns the probability of the first child; std::nullopt if neither child contributes.
  template <typename From>
  std::optional<double> share_of_first(const From& receiver, const Node& node) const;

  std::vector<Node> nodes_;            ///< root first
  std::vector<std::uint32_t> leaves_;  ///< leaf node of each light
};

}  // namespace bandsaw
