#pragma once

// The lights of a scene: which of them to ask for light at a point, where on it, and with which
// density. Surfaces that emit, lights without size, and an environment as far as it is uneven; a
// constant or gradient background is no light here, directions from scattering find it alone.

#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "renderlib/geometry/shapes.h"
#include "renderlib/geometry/surface.h"
#include "renderlib/light/background.h"
#include "renderlib/light/delta_light.h"
#include "renderlib/light/environment_light.h"
#include "renderlib/light/light_choice.h"
#include "renderlib/light/receiver.h"
#include "renderlib/material/material.h"
#include "renderlib/math/rgb.h"
#include "renderlib/texture/texture.h"

namespace bandsaw {

struct LightSample {
  Vec3 direction;  ///< unit, from the receiver
  /// A point in space just off the light, on the receiver's side: the way to it meets no part of a
  /// light that is in sight. Of distant lights: means nothing.
  Vec3 target;
  /// Towards the receiver. Of delta lights: the irradiance of a surface that faces it.
  Rgb radiance;
  /// Of the direction, by solid angle, the choice of the light included; > 0, finite. Of delta
  /// lights: the probability of the choice.
  double pdf = 0;
  bool distant = false;  ///< infinitely far: the way to it never ends
  bool delta = false;    ///< no other technique ever finds it
};

struct LightPlace {
  Vec3 position = {};    ///< of distant lights: means nothing
  bool distant = false;  ///< infinitely far
};

class Lights {
 public:
  Lights() = default;
  /// Every primitive that emits, but those without area or power; every delta light that gives
  /// light; the environment unless it is even. The arguments MUST be valid (scene/validate.h),
  /// outlive the result and not change. Receivers' times are within `interval`.
  Lights(const Geometry& geometry, const std::vector<Material>& materials,
         const std::vector<Texture>& textures, const std::vector<DeltaLight>& delta_lights,
         const Background& background, const Interval& interval = {});

  std::size_t size() const { return ids_.size() + delta_.size() + (environment_.empty() ? 0 : 1); }
  bool empty() const { return size() == 0; }
  /// Whether there are lights that nobody finds but who asks.
  bool any_delta() const { return !delta_.empty(); }

  /// Whether sample() may find light for the receiver, and pdf() be more than 0.
  bool any_for(const Receiver& receiver) const { return choice_.any_for(receiver); }

  /// `choice` in [0, 1), as fine as double where there are many lights; u, v in [0, 1). Nothing: no
  /// light reaches the receiver by this sample.
  std::optional<LightSample> sample(const Receiver& receiver, double choice, double u,
                                    double v) const;

  /// A place of a light, chosen by what lights give along a stretch of medium; nothing: none is of
  /// use.
  std::optional<LightPlace> place(const LitStretch& stretch, double time, double choice, double u,
                                  double v) const;

  /// The density with which sample() makes the direction from the receiver to `hit`, a point of an
  /// emissive primitive; 0 when it never does.
  double pdf(const Receiver& receiver, const SurfacePoint& hit) const;

  /// The density with which sample() makes the unit direction as one towards the environment.
  double environment_pdf(const Receiver& receiver, const Vec3& direction) const;

  /// The probability that sample() chooses the primitive at this receiver.
  double probability(const Receiver& receiver, PrimitiveId id) const;

 private:
  static constexpr std::uint32_t kNoLight = 0xffffffffu;

  std::vector<LightBound> add_surfaces(const Interval& interval);
  bool group_emits(std::uint32_t instance, const std::vector<double>& radiance,
                   std::map<GroupId, bool>& known) const;
  void add_surface(PrimitiveId id, const std::vector<double>& radiance, const Interval& interval,
                   std::vector<LightBound>& to);
  std::vector<DistantBound> add_delta_lights(const std::vector<DeltaLight>& delta_lights,
                                             std::vector<LightBound>& local);
  std::uint32_t index_of_light(PrimitiveId id) const;

  std::optional<LightSample> sample_surface(PrimitiveId id, const Receiver& receiver, double u,
                                            double v) const;
  std::optional<LightSample> sample_delta(const DeltaLight& light, const Receiver& receiver) const;
  std::optional<LightSample> sample_environment(const Receiver& receiver, double u, double v) const;

  const Geometry* geometry_ = nullptr;
  const std::vector<Material>* materials_ = nullptr;
  const std::vector<Texture>* textures_ = nullptr;
  const Background* background_ = nullptr;
  bool uses_uv_ = true;  ///< of its points: some texture does
  /// A light's number counts the surfaces, then the delta lights, those with a place first, then
  /// the environment.
  std::vector<PrimitiveId> ids_;
  std::vector<DeltaLight> delta_;
  EnvironmentLight environment_;
  LightChoice choice_;
  /// The light of primitive p of instance i is light_of_[first_of_instance_[i] + p]; kNoLight:
  /// none.
  std::vector<std::uint32_t> first_of_instance_;
  std::vector<std::uint32_t> light_of_;
};

}  // namespace bandsaw
