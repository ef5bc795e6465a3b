#pragma once

// The lights of a scene and how they are sampled: which light, which point on it, and with which
// pdf. Lights are emissive surfaces, delta lights and the non-uniform part of an environment map.
// Constant and gradient backgrounds are not sampled; only BSDF sampling finds them. A receiver is
// the point that receives the light (light/receiver.h).

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

/// A direction sampled towards a light.
struct LightSample {
  Vec3 direction;  ///< unit, from the receiver towards the light
  /// End of the shadow ray: a point just off the light, on the receiver's side, so that the ray
  /// does not hit the light itself. Unspecified for distant lights.
  Vec3 target;
  /// Emitted towards the receiver. For delta lights: the irradiance of a surface that faces the
  /// light.
  Rgb radiance;
  /// Pdf of the direction by solid angle, including the selection of the light; > 0, finite. For
  /// delta lights: the selection probability.
  double pdf = 0;
  bool distant = false;  ///< infinitely far away: the shadow ray has no end
  bool delta = false;    ///< no other sampling technique can find it
};

/// A point on a light, around which distances along a ray are sampled (medium/equiangular.h).
struct LightPivot {
  Vec3 position = {};    ///< unspecified for distant lights
  bool distant = false;  ///< infinitely far away
};

class Lights {
 public:
  Lights() = default;
  /// Collects every emissive primitive with area and power, every delta light that is not black,
  /// and the environment unless it is uniform. The arguments MUST be valid (scene/validate.h),
  /// outlive this object and not change. The times of receivers lie within Geometry::shutter.
  Lights(const Geometry& geometry, const std::vector<Material>& materials,
         const std::vector<Texture>& textures, const std::vector<DeltaLight>& delta_lights,
         const Background& background);

  std::size_t size() const { return ids_.size() + delta_.size() + (environment_.empty() ? 0 : 1); }
  bool empty() const { return size() == 0; }
  /// Returns true if the scene has delta lights, which only light sampling can find.
  bool any_delta() const { return !delta_.empty(); }

  /// Returns true if `sample()` may find light for the receiver and `pdf()` may be greater than 0.
  bool any_for(const Receiver& receiver) const { return choice_.any_for(receiver); }

  /// Samples a light and a point on it. `choice`, u and v are in [0, 1). If there are many lights,
  /// `choice` needs the resolution of a double. Returns std::nullopt if this sample carries no
  /// light to the receiver.
  std::optional<LightSample> sample(const Receiver& receiver, double choice, double u,
                                    double v) const;

  /// Selects a light by its contribution along a segment of a medium, and samples a point on the
  /// light. `time` determines the position of a light that moves. `choice`, u and v are as in
  /// sample(). Returns std::nullopt if no light contributes.
  std::optional<LightPivot> sample_pivot(const ReceiverSegment& segment, double time, double choice,
                                         double u, double v) const;

  /// Returns the pdf with which `sample()` samples the direction from the receiver to `hit`, a
  /// point on an emissive primitive; 0 if `sample()` never chooses the primitive.
  double pdf(const Receiver& receiver, const SurfacePoint& hit) const;

  /// Returns the pdf with which `sample()` samples the unit direction towards the environment.
  double environment_pdf(const Receiver& receiver, const Vec3& direction) const;
  /// Returns the pdf of the unit direction, by solid angle, among the directions that are sampled
  /// towards the environment. It does not include the selection of the environment; 0 without one.
  double direction_pdf_of_environment(const Vec3& direction) const {
    return environment_.empty() ? 0 : environment_.pdf(direction);
  }

  /// Returns the probability with which `sample()` selects the primitive at this receiver.
  double probability(const Receiver& receiver, PrimitiveId id) const;

 private:
  static constexpr std::uint32_t kNoLight = 0xffffffffu;

  /// Collects the emissive primitives, and returns their bounds.
  std::vector<LightBound> add_surfaces();
  /// Returns true if a shape in the group of this instance emits. `radiance` is the mean radiance
  /// of each material; `known` holds the earlier results.
  bool group_emits(std::uint32_t instance, const std::vector<double>& radiance,
                   std::map<GroupId, bool>& known) const;
  /// Numbers a primitive; if it is a light, appends its bound to `to`.
  void add_surface(PrimitiveId id, const std::vector<double>& radiance,
                   std::vector<LightBound>& to);
  /// Collects the delta lights. Appends the bounds of lights with a position to `local`, and
  /// returns the bounds of directional lights.
  std::vector<DistantBound> add_delta_lights(const std::vector<DeltaLight>& delta_lights,
                                             std::vector<LightBound>& local);
  /// Returns the number of the primitive among the lights; kNoLight if it is not a light.
  std::uint32_t index_of_light(PrimitiveId id) const;

  // The pdfs of these samples do not include the selection of the light.
  std::optional<LightSample> sample_surface(PrimitiveId id, const Receiver& receiver, double u,
                                            double v) const;
  std::optional<LightSample> sample_delta(const DeltaLight& light, const Receiver& receiver) const;
  std::optional<LightSample> sample_environment(const Receiver& receiver, double u, double v) const;

  const Geometry* geometry_ = nullptr;
  const std::vector<Material>* materials_ = nullptr;
  const std::vector<Texture>* textures_ = nullptr;
  const Background* background_ = nullptr;
  std::vector<bool> one_sided_;  ///< for each material
  bool uses_uv_ = true;  ///< true if some texture depends on the uv coordinates of light points
  /// Lights are numbered: surfaces first, then delta lights (those with a position before
  /// directional ones), then the environment.
  std::vector<PrimitiveId> ids_;  ///< the surfaces
  std::vector<DeltaLight> delta_;
  EnvironmentLight environment_;
  LightChoice choice_;
  /// The number of the light of primitive p of instance i is light_of_[first_of_instance_[i] + p],
  /// or kNoLight if the primitive is not a light. first_of_instance_[i] is kNoLight if the instance
  /// has no entries in light_of_.
  std::vector<std::uint32_t> first_of_instance_;
  std::vector<std::uint32_t> light_of_;
};

}  // namespace bandsaw
