#pragma once

// Animations of models: the motion of nodes and the weights of morph targets over time, in seconds.
// gltf/gltf_animation.h and model/assimp_animation.h read them; the folder model evaluates them.

#include <compare>
#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "renderlib/import/animation/curve.h"
#include "renderlib/math/transform.h"

namespace bandsaw {

/// Movement of one node. A property without a curve keeps its value of the rest pose.
struct NodeMotion {
  Vec3 translate;                                   ///< translation in the rest pose
  Quaternion rotate;                                ///< rotation in the rest pose
  Vec3 scale{1, 1, 1};                              ///< scale in the rest pose
  std::optional<Curve> translation = std::nullopt;  ///< numbers x, y, z
  std::optional<Curve> rotation = std::nullopt;     ///< numbers x, y, z, w
  std::optional<Curve> scaling = std::nullopt;      ///< numbers x, y, z

  /// Returns the node's transform relative to its parent.
  Transform at(double time) const;
  /// Returns true if the transform is the same at all times of [from, to].
  bool rests(double from, double to) const;
  /// Returns the times of keys inside (from, to), rising, each once.
  std::vector<double> times_between(double from, double to) const;
  /// Returns true if all curves are linear, so that interpolation between their keys is exact.
  bool is_linear() const;
};

/// A request for one of a model's animations.
struct AnimationChoice {
  std::string name;  ///< empty: none, or the first one if `first` is set
  bool first = false;
  friend auto operator<=>(const AnimationChoice&, const AnimationChoice&) = default;
};

/// Returns the index of the chosen animation in `names`. Returns std::nullopt if no animation is
/// chosen; the model then is in its rest pose. If the chosen name is not in `names`, the error is
/// NOT_FOUND: "has no animation \"run\"; there are \"walk\", \"jump\"".
absl::StatusOr<std::optional<std::size_t>> choose(const AnimationChoice& choice,
                                                  const std::vector<std::string>& names);

struct Animation {
  std::string name;
  /// Moving nodes, keyed by the node's number in Assimp's tree, where parents have lower numbers
  /// than their children. Until Assimp has loaded a glTF file, the key is the node's index in that
  /// file.
  std::map<std::size_t, NodeMotion> nodes = {};
  /// Weights of morph targets, keyed by node as in `nodes`. A curve has one number for each target.
  std::map<std::size_t, Curve> weights = {};
};

/// Returns the motion of a node; nullptr if it has none, or if there is no animation.
const NodeMotion* motion_of(const Animation* animation, std::size_t node);

}  // namespace bandsaw
