#pragma once

// Selection of one of a scene's lights for light sampling (light/lights.h).

#include <cstddef>
#include <optional>
#include <vector>

#include "renderlib/light/light_bound.h"
#include "renderlib/light/light_tree.h"

namespace bandsaw {

/// Upper bound of the irradiance from an infinitely distant light. It is the same everywhere.
struct DistantBound {
  double irradiance = 0;
  /// Unit vector to the light; std::nullopt for light from all directions.
  std::optional<Vec3> direction;
};
/// Returns an upper bound of the irradiance from the light at the receiver, a point that receives
/// light (light/receiver.h). Returns 0 if Receiver::within is set. Then the receiver is the point
/// on which the camera's lens is focused, and no distant lights are sampled for this point.
double importance(const DistantBound& bound, const Receiver& receiver);
/// A ReceiverSegment is a piece of a ray in a medium. Returns the irradiance of the bound times a
/// length: the length of the segment, or 1 / ReceiverSegment::extinction if that is shorter.
double importance(const DistantBound& bound, const ReceiverSegment& segment);

/// Up to kMaxIndividualLights lights are evaluated individually at every point. If there are more,
/// the local lights (those that are not infinitely distant) are selected through a light tree; only
/// the tree as a whole and the distant lights are evaluated individually.
class LightChoice {
 public:
  static constexpr std::size_t kMaxIndividualLights = 16;

  /// Lights are numbered in the order of `local`, followed by `distant`.
  struct Choice {
    std::size_t light = 0;
    double probability = 0;  ///< > 0
  };

  LightChoice() = default;
  /// `distant` MUST have fewer than kMaxIndividualLights elements.
  LightChoice(std::vector<LightBound> local, std::vector<DistantBound> distant);

  /// Returns true if any light may reach the receiver.
  bool any_for(const Receiver& receiver) const;
  /// Selects a light. `number` is in [0, 1) and should have the resolution of a double, because
  /// selection frequencies are right only down to the spacing of the numbers. Returns std::nullopt
  /// if no light reaches the receiver. `From` is `Receiver` or `ReceiverSegment`.
  template <typename From>
  std::optional<Choice> choose(const From& receiver, double number) const;
  /// Returns the probability with which `choose()` selects the light.
  double probability(const Receiver& receiver, std::size_t light) const;

 private:
  /// Returns the number of candidates: the few lights or the tree as a whole, and the distant
  /// lights.
  std::size_t candidates() const;
  /// Returns the importance of a candidate.
  template <typename From>
  double weight(std::size_t candidate, const From& receiver) const;

  std::vector<LightBound> few_;  ///< the local lights, if they are evaluated individually
  LightTree tree_;               ///< the local lights otherwise
  std::size_t in_tree_ = 0;      ///< number of lights in the tree; 0: there is no tree
  std::vector<DistantBound> distant_;
};

}  // namespace bandsaw
