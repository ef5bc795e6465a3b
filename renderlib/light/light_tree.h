#pragma once

// One of many lights, chosen by what each can give at a point: down a binary tree, at each node in
// proportion to the importance of the two halves.
//
// Conty Estevez and Kulla 2018, "Importance Sampling of Many Lights with Adaptive Tree Splitting":
// the tree is built by their surface area orientation heuristic (sections 4.3 and 4.4); of a light
// the way down is known, so its probability is the same product again.

#include <cstdint>
#include <optional>
#include <vector>

#include "renderlib/light/light_bound.h"

namespace bandsaw {

class LightTree {
 public:
  /// No node lies deeper.
  static constexpr std::uint32_t kMostDepth = 64;

  struct Choice {
    std::uint32_t light = 0;
    double probability = 0;  ///< > 0
  };

  LightTree() = default;
  /// At least one light, fewer than 2^31.
  explicit LightTree(const std::vector<LightBound>& lights);

  bool empty() const { return nodes_.empty(); }
  /// Of all lights together. From, here and below: Receiver or LitStretch.
  template <typename From>
  double importance(const From& receiver) const;
  /// `number` in [0, 1). Nothing: no light reaches the receiver.
  template <typename From>
  std::optional<Choice> choose(const From& receiver, double number) const;
  /// With which choose() answers this light.
  double probability(const Receiver& receiver, std::uint32_t light) const;

 private:
  friend class LightTreeBuilder;
  struct Node {
    LightBound bound;
    std::uint32_t first = 0;  ///< of two children that lie side by side; of a leaf: its light
    std::uint32_t parent = 0;
    bool is_leaf = false;
  };
  /// The share of the first of a node's children; nothing when neither gives anything.
  template <typename From>
  std::optional<double> share_of_first(const From& receiver, const Node& node) const;

  std::vector<Node> nodes_;            ///< the root first
  std::vector<std::uint32_t> leaves_;  ///< by light
};

}  // namespace bandsaw
