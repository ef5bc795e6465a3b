#pragma once

// Which of a scene's lights to ask at a point.

#include <cstddef>
#include <optional>
#include <vector>

#include "renderlib/light/light_bound.h"
#include "renderlib/light/light_tree.h"

namespace bandsaw {

/// What an infinitely far light gives at most, everywhere alike.
struct DistantBound {
  double irradiance = 0;
  std::optional<Vec3> way;  ///< unit, to the light; none: from all around
};
double importance(const DistantBound& bound, const Receiver& receiver);
double importance(const DistantBound& bound, const LitStretch& stretch);

/// Up to kFewLights lights are judged each on its own at every point; more by a tree, beside which
/// the distant ones stand as before.
class LightChoice {
 public:
  static constexpr std::size_t kFewLights = 16;

  /// A light is counted as `local` are, then as `distant` are.
  struct Choice {
    std::size_t light = 0;
    double probability = 0;  ///< > 0
  };

  LightChoice() = default;
  /// Fewer than kFewLights distant ones.
  LightChoice(std::vector<LightBound> local, std::vector<DistantBound> distant);

  /// Whether any light may reach the receiver.
  bool any_for(const Receiver& receiver) const;
  /// `number` in [0, 1), as fine as double: a light is chosen as often as its probability says down
  /// to the spacing of the numbers. Nothing: no light reaches the receiver. From: Receiver or
  /// LitStretch.
  template <typename From>
  std::optional<Choice> choose(const From& receiver, double number) const;
  /// With which choose() answers this light.
  double probability(const Receiver& receiver, std::size_t light) const;

 private:
  /// One of few lights, or the tree, or a distant light.
  std::size_t candidates() const;
  template <typename From>
  double weight(std::size_t candidate, const From& receiver) const;

  std::vector<LightBound> few_;
  LightTree tree_;
  std::size_t in_tree_ = 0;
  std::vector<DistantBound> distant_;
};

}  // namespace bandsaw
