// Evaluates the animation of a model's node, and chooses an animation by name. The motion of a node
// is three curves (translation, rotation, scale); a component without a curve keeps its value at
// rest.

#include "renderlib/import/animation/animation.h"

#include <algorithm>
#include <iterator>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"

namespace bandsaw {

Transform NodeMotion::at(double time) const {
  return bandsaw::translation(translation ? translation->vec3_at(time) : translate) *
         bandsaw::rotation(rotation ? rotation->rotation_at(time) : rotate) *
         bandsaw::scaling(scaling ? scaling->vec3_at(time) : scale);
}

bool NodeMotion::rests(double from, double to) const {
  const auto still = [&](const std::optional<Curve>& curve) {
    return !curve || curve->rests(from, to);
  };
  return still(translation) && still(rotation) && still(scaling);
}

std::vector<double> NodeMotion::times_between(double from, double to) const {
  std::vector<double> times;
  for (const auto* curve : {&translation, &rotation, &scaling}) {
    if (*curve) {
      std::copy_if((*curve)->times().begin(), (*curve)->times().end(), std::back_inserter(times),
                   [&](double time) { return time > from && time < to; });
    }
  }
  std::sort(times.begin(), times.end());
  times.erase(std::unique(times.begin(), times.end()), times.end());
  return times;
}

bool NodeMotion::is_linear() const {
  const auto linear = [](const std::optional<Curve>& curve) {
    return !curve || curve->interpolation() == Interpolation::kLinear;
  };
  return linear(translation) && linear(rotation) && linear(scaling);
}

const NodeMotion* motion_of(const Animation* animation, std::size_t node) {
  if (animation == nullptr) {
    return nullptr;
  }
  const auto found = animation->nodes.find(node);
  return found == animation->nodes.end() ? nullptr : &found->second;
}

absl::StatusOr<std::optional<std::size_t>> choose(const AnimationChoice& choice,
                                                  const std::vector<std::string>& names) {
  if (choice.name.empty()) {
    return choice.first && !names.empty() ? std::optional<std::size_t>(0) : std::nullopt;
  }
  const auto found = std::find(names.begin(), names.end(), choice.name);
  if (found != names.end()) {
    return static_cast<std::size_t>(found - names.begin());
  }
  const auto quoted = [](std::string* out, const std::string& name) {
    absl::StrAppend(out, "\"", name, "\"");
  };
  return absl::NotFoundError(absl::StrCat(
      "has no animation \"", choice.name, "\"; ",
      names.empty() ? "it has no animations" : "there are " + absl::StrJoin(names, ", ", quoted)));
}

}  // namespace bandsaw
