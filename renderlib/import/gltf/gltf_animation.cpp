// Reads an animation of a glTF file: each channel's sampler becomes a Curve, which moves a node or
// sets the weights of its morph targets.

#include "renderlib/import/gltf/gltf_animation.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "absl/strings/str_cat.h"
#include "renderlib/base/status_macros.h"
#include "renderlib/import/gltf/gltf_accessor.h"

namespace bandsaw::gltf {
namespace {

/// Maximum time of a key, in seconds: the bound of all times in a scene (kMaxTime).
constexpr double kMaxSeconds = 1e9;

/// Reads the times of a sampler's keys. Returns INVALID_ARGUMENT if a time is not finite, is above
/// kMaxSeconds in magnitude, or is not above the time before it. `place` names the channel in
/// messages.
absl::StatusOr<std::vector<double>> read_times(const Json& root, std::size_t accessor,
                                               const std::string& place, Buffers& buffers) {
  ASSIGN_OR_RETURN(const AccessorShape shape, accessor_shape(root, accessor, place));
  if (shape.components != 1 || shape.component != Component::kFloat || shape.count == 0) {
    return damaged(shape.place, absl::StrCat("must hold the times of ", place, " as floats"));
  }
  ASSIGN_OR_RETURN(const std::vector<float> times, read_floats(root, accessor, shape, buffers));
  for (std::size_t i = 0; i < times.size(); ++i) {
    if (!std::isfinite(times[i]) || std::abs(times[i]) > kMaxSeconds) {
      return damaged(shape.place, absl::StrCat("its times must be finite and within +-1e9 s; time ",
                                               i, " is ", times[i], " s"));
    }
    if (i > 0 && !(times[i] > times[i - 1])) {
      return damaged(shape.place,
                     absl::StrCat("its times must increase; time ", i, " is ", times[i],
                                  " s, and time ", i - 1, " is ", times[i - 1], " s"));
    }
  }
  return std::vector<double>(times.begin(), times.end());
}

absl::StatusOr<Interpolation> interpolation_of(const Json& sampler, const std::string& place) {
  const std::string name = text(sampler, "interpolation");
  if (name.empty() || name == "LINEAR") {
    return Interpolation::kLinear;
  }
  if (name == "STEP") {
    return Interpolation::kStep;
  }
  if (name == "CUBICSPLINE") {
    return Interpolation::kCubic;
  }
  return damaged(
      place, absl::StrCat("its interpolation \"", name, "\" is not LINEAR, STEP or CUBICSPLINE"));
}

/// Reads a sampler. `components` is how many numbers an element of its output accessor must have: 3
/// for vectors, 4 for rotations, 1 for weights. A key of a vector or rotation has one element as
/// its value; a key of weights has one element for each morph target.
absl::StatusOr<Curve> read_sampler(const Json& root, const Json& sampler, const std::string& place,
                                   std::size_t components, Buffers& buffers) {
  ASSIGN_OR_RETURN(const Interpolation interpolation, interpolation_of(sampler, place));
  ASSIGN_OR_RETURN(const std::size_t input, whole_of(sampler, "input", place));
  ASSIGN_OR_RETURN(std::vector<double> times, read_times(root, input, place, buffers));
  ASSIGN_OR_RETURN(const std::size_t output, whole_of(sampler, "output", place));
  ASSIGN_OR_RETURN(const AccessorShape shape, accessor_shape(root, output, place));
  const std::size_t per_time = interpolation == Interpolation::kCubic ? 3 : 1;
  const std::size_t keys = times.size() * per_time;
  const bool fits =
      components == 1 ? shape.count > 0 && shape.count % keys == 0 : shape.count == keys;
  if (shape.components != components || !fits) {
    return damaged(shape.place, absl::StrCat("does not match the ", times.size(), " times of ",
                                             place, ": its count is ", shape.count, ", with ",
                                             shape.components, " numbers each"));
  }
  ASSIGN_OR_RETURN(const std::vector<float> values, read_floats(root, output, shape, buffers));
  if (!std::all_of(values.begin(), values.end(), [](float v) { return std::isfinite(v); })) {
    return damaged(shape.place, "holds numbers that are not finite");
  }
  const std::size_t width = components == 1 ? shape.count / keys : components;
  return Curve(std::move(times), std::vector<double>(values.begin(), values.end()), width,
               interpolation);
}

/// Returns the list's numbers as doubles if it has `count` of them; otherwise an empty list.
std::vector<double> numbers_of(const Json& node, const char* name, std::size_t count) {
  std::vector<double> out;
  for (const Json& value : items(node, name)) {
    out.push_back(value.is_number() ? value.get<double>() : 0);
  }
  return out.size() == count ? out : std::vector<double>();
}

/// Returns the rest pose of a node: a motion without curves.
NodeMotion rest_of(const Json& node) {
  NodeMotion motion;
  if (const auto t = numbers_of(node, "translation", 3); !t.empty()) {
    motion.translate = {t[0], t[1], t[2]};
  }
  if (const auto r = numbers_of(node, "rotation", 4); !r.empty()) {
    motion.rotate = Curve({0}, r, 4, Interpolation::kLinear).rotation_at(0);
  }
  if (const auto s = numbers_of(node, "scale", 3); !s.empty()) {
    motion.scale = {s[0], s[1], s[2]};
  }
  return motion;
}

/// Adds the curve of a channel to the animation `to`. A channel without a node or with an unknown
/// path is skipped. `place` names the channel in messages.
absl::Status add_channel(const Json& root, const Json& animation, const Json& channel,
                         const std::string& place, Buffers& buffers, Animation& to) {
  const Json* target = object(channel, "target");
  const Json* node = target == nullptr ? nullptr : item_of(root, "nodes", *target, "node");
  if (node == nullptr) {
    return absl::OkStatus();
  }
  const std::string path = text(*target, "path");
  const bool known =
      path == "translation" || path == "rotation" || path == "scale" || path == "weights";
  if (!known) {
    return absl::OkStatus();
  }
  ASSIGN_OR_RETURN(const std::size_t number, whole_of(channel, "sampler", place));
  const Json& samplers = items(animation, "samplers");
  if (number >= samplers.size()) {
    return damaged(place, absl::StrCat("samplers[", number, "] does not exist"));
  }
  const std::size_t components = path == "weights" ? 1 : path == "rotation" ? 4 : 3;
  ASSIGN_OR_RETURN(Curve curve, read_sampler(root, samplers[number], place, components, buffers));
  const auto index = static_cast<std::size_t>(*gltf::number(*target, "node"));
  if (path == "weights") {
    to.weights.insert_or_assign(index, std::move(curve));
    return absl::OkStatus();
  }
  NodeMotion& motion = to.nodes.try_emplace(index, rest_of(*node)).first->second;
  (path == "translation" ? motion.translation
   : path == "rotation"  ? motion.rotation
                         : motion.scaling) = std::move(curve);
  return absl::OkStatus();
}

}  // namespace

std::vector<std::string> animation_names(const Json& root) {
  std::vector<std::string> names;
  for (const Json& animation : items(root, "animations")) {
    names.push_back(name_in(animation));
  }
  return names;
}

absl::StatusOr<Animation> read_animation(const Json& root, std::size_t index, Buffers& buffers) {
  const Json& from = items(root, "animations")[index];
  Animation to{.name = name_in(from)};
  const Json& channels = items(from, "channels");
  for (std::size_t i = 0; i < channels.size(); ++i) {
    const std::string place = absl::StrCat("animations[", index, "].channels[", i, "]");
    RETURN_IF_ERROR(add_channel(root, from, channels[i], place, buffers, to));
  }
  return to;
}

}  // namespace bandsaw::gltf
