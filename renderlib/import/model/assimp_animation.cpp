// Converts an animation that Assimp has read. Each channel, which has the keys of one node or mesh,
// becomes curves over the time in seconds.

#include "renderlib/import/model/assimp_animation.h"

#include <assimp/anim.h>
#include <assimp/scene.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "renderlib/import/model/model_pose.h"

namespace bandsaw {
namespace {

/// Ticks per second of a file that states none, as Assimp's documentation proposes.
constexpr double kDefaultTicks = 25;

void add(const aiVector3D& v, std::vector<double>& to) { to.insert(to.end(), {v.x, v.y, v.z}); }
void add(const aiQuaternion& q, std::vector<double>& to) {
  to.insert(to.end(), {q.x, q.y, q.z, q.w});
}

/// Returns a curve of the keys, whose values have `width` numbers; `ticks` are ticks per second.
/// Returns std::nullopt if no key is usable.
template <class Key>
std::optional<Curve> curve_of(const Key* keys, unsigned count, std::size_t width, double ticks) {
  std::vector<double> times;
  std::vector<double> values;
  for (unsigned i = 0; i < count; ++i) {
    const double time = keys[i].mTime / ticks;
    std::vector<double> value;
    add(keys[i].mValue, value);
    bool usable = std::isfinite(time) && (times.empty() || time > times.back());
    for (const double number : value) {
      usable = usable && std::isfinite(number);
    }
    if (usable) {
      times.push_back(time);
      values.insert(values.end(), value.begin(), value.end());
    }
  }
  return times.empty() ? std::nullopt
                       : std::optional(Curve(std::move(times), std::move(values), width,
                                             Interpolation::kLinear));
}

/// Returns the motion of the node of a channel. A part of the motion without usable keys is absent.
NodeMotion motion_of_channel(const aiNodeAnim& channel, double ticks) {
  NodeMotion motion;
  motion.translation = curve_of(channel.mPositionKeys, channel.mNumPositionKeys, 3, ticks);
  motion.rotation = curve_of(channel.mRotationKeys, channel.mNumRotationKeys, 4, ticks);
  motion.scaling = curve_of(channel.mScalingKeys, channel.mNumScalingKeys, 3, ticks);
  return motion;
}

/// Returns the weights of the morph targets over time; std::nullopt if no key is usable.
std::optional<Curve> weights_of_channel(const aiMeshMorphAnim& channel, double ticks) {
  // The curve has a weight for each target number up to the largest in the file. Without a limit, a
  // damaged number could demand all the memory.
  constexpr unsigned kMaxTargets = 10'000;
  unsigned targets = 0;
  for (unsigned i = 0; i < channel.mNumKeys; ++i) {
    for (unsigned j = 0; j < channel.mKeys[i].mNumValuesAndWeights; ++j) {
      if (channel.mKeys[i].mValues[j] >= kMaxTargets) {
        return std::nullopt;
      }
      targets = std::max(targets, channel.mKeys[i].mValues[j] + 1);
    }
  }
  std::vector<double> times;
  std::vector<double> values;
  for (unsigned i = 0; i < channel.mNumKeys && targets > 0; ++i) {
    const aiMeshMorphKey& key = channel.mKeys[i];
    const double time = key.mTime / ticks;
    if (!std::isfinite(time) || (!times.empty() && time <= times.back())) {
      continue;
    }
    std::vector<double> weights(targets, 0);
    for (unsigned j = 0; j < key.mNumValuesAndWeights; ++j) {
      weights[key.mValues[j]] = std::isfinite(key.mWeights[j]) ? key.mWeights[j] : 0;
    }
    times.push_back(time);
    values.insert(values.end(), weights.begin(), weights.end());
  }
  return times.empty() ? std::nullopt
                       : std::optional(Curve(std::move(times), std::move(values), targets,
                                             Interpolation::kLinear));
}

}  // namespace

std::vector<std::string> animation_names(const aiScene& scene) {
  std::vector<std::string> names;
  for (unsigned i = 0; i < scene.mNumAnimations; ++i) {
    names.emplace_back(scene.mAnimations[i]->mName.C_Str());
  }
  return names;
}

Animation read_animation(const aiScene& scene, std::size_t index) {
  const aiAnimation& from = *scene.mAnimations[index];
  const double ticks = from.mTicksPerSecond > 0 ? from.mTicksPerSecond : kDefaultTicks;
  const NodePlaces places = node_places(scene, /*animation=*/nullptr, /*time=*/0);
  Animation to{.name = from.mName.C_Str()};
  for (unsigned i = 0; i < from.mNumChannels; ++i) {
    const auto node = places.by_name.find(from.mChannels[i]->mNodeName.C_Str());
    if (node != places.by_name.end()) {
      to.nodes.emplace(node->second, motion_of_channel(*from.mChannels[i], ticks));
    }
  }
  for (unsigned i = 0; i < from.mNumMorphMeshChannels; ++i) {
    // Assimp appends "*" and a number to the name of the node.
    const std::string name = from.mMorphMeshChannels[i]->mName.C_Str();
    const auto node = places.by_name.find(name.substr(0, name.find('*')));
    const auto weights = weights_of_channel(*from.mMorphMeshChannels[i], ticks);
    if (node != places.by_name.end() && weights) {
      to.weights.emplace(node->second, *weights);
    }
  }
  return to;
}

}  // namespace bandsaw
