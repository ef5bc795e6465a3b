// choose() descends from the root and selects a child with a probability proportional to its
// importance; the random number is rescaled at each step. probability() multiplies the same
// probabilities from the root to a given light.

#include "renderlib/light/light_tree.h"

#include <algorithm>
#include <array>

namespace bandsaw {

template <typename From>
double LightTree::importance(const From& receiver) const {
  return bandsaw::importance(nodes_.front().bound, receiver);
}

template <typename From>
std::optional<double> LightTree::share_of_first(const From& receiver, const Node& node) const {
  const double first = bandsaw::importance(nodes_[node.first].bound, receiver);
  const double second = bandsaw::importance(nodes_[node.first + 1].bound, receiver);
  return first + second > 0 ? std::optional(first / (first + second)) : std::nullopt;
}

template <typename From>
std::optional<LightTree::Choice> LightTree::choose(const From& receiver, double number) const {
  double probability = 1;
  const Node* node = &nodes_.front();
  while (!node->is_leaf) {
    const std::optional<double> share = share_of_first(receiver, *node);
    if (!share) {
      return std::nullopt;
    }
    const bool first = number < *share;
    probability *= first ? *share : 1 - *share;
    number = std::min(first ? number / *share : (number - *share) / (1 - *share), kOneMinusEpsilon);
    node = &nodes_[first ? node->first : node->first + 1];
  }
  return probability > 0 ? std::optional(Choice{node->first, probability}) : std::nullopt;
}

template double LightTree::importance(const Receiver&) const;
template double LightTree::importance(const ReceiverSegment&) const;
template std::optional<LightTree::Choice> LightTree::choose(const Receiver&, double) const;
template std::optional<LightTree::Choice> LightTree::choose(const ReceiverSegment&, double) const;

double LightTree::probability(const Receiver& receiver, std::uint32_t light) const {
  std::array<std::uint32_t, kMaxDepth> path;
  std::size_t steps = 0;
  for (std::uint32_t at = leaves_[light]; at != 0; at = nodes_[at].parent) {
    path[steps++] = at;
  }
  // The probabilities are multiplied from the root down, in the same order as in choose().
  double probability = 1;
  while (steps > 0 && probability > 0) {
    const std::uint32_t at = path[--steps];
    const Node& parent = nodes_[nodes_[at].parent];
    const std::optional<double> share = share_of_first(receiver, parent);
    probability *= !share ? 0 : at == parent.first ? *share : 1 - *share;
  }
  return probability;
}

}  // namespace bandsaw
