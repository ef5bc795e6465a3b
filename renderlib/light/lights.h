#pragma once

// The surfaces of a scene that give light: which of them to ask for light at a point, where on it,
// and with which density.
//
// One of few lights (at most kFewLights) is chosen by a bound of what each can contribute at the
// point; one of many by its power. The background is no light here: directions to it are found by
// scattering alone, no shadow ray is spent on it.

#include <cstdint>
#include <optional>
#include <vector>

#include "renderlib/geometry/moving_bounds.h"
#include "renderlib/geometry/shapes.h"
#include "renderlib/geometry/surface.h"
#include "renderlib/light/shape_light.h"
#include "renderlib/material/material.h"
#include "renderlib/math/rgb.h"
#include "renderlib/texture/texture.h"

namespace bandsaw {

/// A point that receives light from one side of it.
struct Receiver {
  Vec3 position;
  Vec3 normal;  ///< unit; light comes only from directions with a positive cosine to it
  double time = 0;  ///< lights are where they are then
};

struct LightSample {
  Vec3 direction;  ///< unit, from the receiver
  /// A point in space just off the light, on the receiver's side: the way to it meets no part of a
  /// light that is in sight.
  Vec3 target;
  Rgb radiance;  ///< towards the receiver
  double pdf =
      0;  ///< of the direction, by solid angle, the choice of the light included; > 0, finite
};

class Lights {
 public:
  /// More are chosen by power alone: their bounds would cost more than they save.
  static constexpr std::size_t kFewLights = 16;

  Lights() = default;
  /// Every primitive that emits, but those without area or power. The arguments MUST be valid
  /// (scene/validate.h), outlive the result and not change. Receivers' times are within `interval`.
  Lights(const Geometry& geometry, const std::vector<Material>& materials,
         const std::vector<Texture>& textures, const Interval& interval = {});

  std::size_t size() const { return ids_.size(); }
  bool empty() const { return ids_.empty(); }

  /// Numbers in [0, 1). Nothing: no light reaches the receiver by this sample.
  std::optional<LightSample> sample(const Receiver& receiver, double choice, double u,
                                    double v) const;

  /// The density with which sample() makes the direction from the receiver to `hit`, a point of an
  /// emissive primitive; 0 when it never does.
  double pdf(const Receiver& receiver, const SurfacePoint& hit) const;

  /// The probability that sample() chooses the primitive at this receiver.
  double probability(const Receiver& receiver, PrimitiveId id) const;

 private:
  static constexpr std::uint32_t kNoLight = 0xffffffffu;

  /// What a light can contribute at most is judged by, for few lights.
  struct Bound {
    Ball ball;
    double power = 0;
    bool flat = false;
    bool one_sided = false;
    Vec3 normal;  ///< unit, of flat lights
  };
  struct Choice {
    std::size_t index = 0;
    double probability = 0;
  };

  void add(const Geometry& geometry, PrimitiveId id, const std::vector<double>& radiance_means,
           const Interval& interval, std::vector<double>& powers);
  void choose_by_power(const std::vector<double>& powers);
  std::optional<Choice> choose(const Receiver& receiver, double choice) const;
  double probability_of(const Receiver& receiver, std::size_t index) const;
  std::uint32_t index_of_light(PrimitiveId id) const;

  static double weight(const Bound& bound, const Receiver& receiver);

  const Geometry* geometry_ = nullptr;
  const std::vector<Material>* materials_ = nullptr;
  const std::vector<Texture>* textures_ = nullptr;
  std::vector<PrimitiveId> ids_;
  std::vector<Bound> bounds_;  ///< one a light when there are few, else empty
  /// Of many lights: probabilities added up, in units of 2^-32, so that numbers of 32 bits hit each
  /// exactly as often as its probability says; entry i is where light i ends.
  std::vector<std::uint64_t> ends_;
  /// The light of primitive p of instance i is light_of_[first_of_instance_[i] + p]; kNoLight:
  /// none.
  std::vector<std::uint32_t> first_of_instance_;
  std::vector<std::uint32_t> light_of_;
};

}  // namespace bandsaw
