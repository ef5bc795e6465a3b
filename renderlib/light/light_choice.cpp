// All candidates are weighted by their importance, and one is chosen with a probability in
// proportion to its importance. If there are few lights, the candidates are all lights. Otherwise
// candidate 0 is the light tree as a whole, and the distant lights follow. If the tree is chosen,
// the random number is rescaled and chooses a light in the tree.

#include "renderlib/light/light_choice.h"

#include <algorithm>
#include <array>
#include <utility>

#include "renderlib/base/check.h"

namespace bandsaw {

double importance(const DistantBound& bound, const Receiver& receiver) {
  if (receiver.within != nullptr) {
    return 0;
  }
  if (!bound.direction || !receiver.normal) {
    return bound.irradiance;
  }
  return bound.irradiance * std::max(0.0, dot(*receiver.normal, *bound.direction));
}

double importance(const DistantBound& bound, const ReceiverSegment& segment) {
  return bound.irradiance * std::min(segment.length, 1 / segment.extinction);
}

LightChoice::LightChoice(std::vector<LightBound> local, std::vector<DistantBound> distant)
    : distant_(std::move(distant)) {
  BANDSAW_CHECK(distant_.size() < kMaxIndividualLights, "a scene has few distant lights");
  if (local.size() + distant_.size() <= kMaxIndividualLights) {
    few_ = std::move(local);
    return;
  }
  in_tree_ = local.size();
  tree_ = LightTree(local);
}

std::size_t LightChoice::candidates() const {
  return few_.size() + (in_tree_ > 0 ? 1 : 0) + distant_.size();
}

template <typename From>
double LightChoice::weight(std::size_t candidate, const From& receiver) const {
  const std::size_t first_distant = candidates() - distant_.size();
  if (candidate >= first_distant) {
    return importance(distant_[candidate - first_distant], receiver);
  }
  return in_tree_ > 0 ? tree_.importance(receiver) : importance(few_[candidate], receiver);
}

bool LightChoice::any_for(const Receiver& receiver) const {
  for (std::size_t i = 0; i < candidates(); ++i) {
    if (weight(i, receiver) > 0) {
      return true;
    }
  }
  return false;
}

template <typename From>
std::optional<LightChoice::Choice> LightChoice::choose(const From& receiver, double number) const {
  std::array<double, kMaxIndividualLights> sums;
  const std::size_t count = candidates();
  double sum = 0;
  for (std::size_t i = 0; i < count; ++i) {
    sum += weight(i, receiver);
    sums[i] = sum;
  }
  if (!(sum > 0)) {
    return std::nullopt;
  }
  std::size_t chosen = 0;
  while (chosen + 1 < count && sums[chosen] <= number * sum) {
    ++chosen;
  }
  const double before = chosen == 0 ? 0 : sums[chosen - 1];
  const double probability = (sums[chosen] - before) / sum;
  if (!(probability > 0)) {
    return std::nullopt;
  }
  if (in_tree_ == 0) {
    return Choice{chosen, probability};
  }
  if (chosen > 0) {
    return Choice{in_tree_ + chosen - 1, probability};
  }
  const double rest = std::min(number * sum / sums[0], kOneMinusEpsilon);
  const auto in_tree = tree_.choose(receiver, rest);
  return in_tree ? std::optional(Choice{in_tree->light, probability * in_tree->probability})
                 : std::nullopt;
}

template std::optional<LightChoice::Choice> LightChoice::choose(const Receiver&, double) const;
template std::optional<LightChoice::Choice> LightChoice::choose(const ReceiverSegment&,
                                                                double) const;

double LightChoice::probability(const Receiver& receiver, std::size_t light) const {
  const bool is_in_tree = light < in_tree_;
  const std::size_t candidate = is_in_tree ? 0 : in_tree_ == 0 ? light : light - in_tree_ + 1;
  double sum = 0;
  double before = 0;
  double end = 0;
  for (std::size_t i = 0; i < candidates(); ++i) {
    before = i == candidate ? sum : before;
    sum += weight(i, receiver);
    end = i == candidate ? sum : end;
  }
  if (!(end > before)) {
    return 0;
  }
  const double probability = (end - before) / sum;
  return is_in_tree ? probability * tree_.probability(receiver, static_cast<std::uint32_t>(light))
                    : probability;
}

}  // namespace bandsaw
