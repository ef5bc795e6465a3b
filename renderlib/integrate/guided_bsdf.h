#pragma once

// A BSDF together with the directions from which the field of path guiding expects light. They are
// stored as cones (guiding/guiding_cell.h). A direction is sampled from the cones with the
// probability GuidingCones::share(), otherwise from the BSDF. Its pdf is the pdf of the mixture of
// the two (Müller, Gross and Novák 2017, "Practical Path Guiding for Efficient Light-Transport
// Simulation", section 5.2). So the expected value does not depend on the field.

#include <optional>

#include "renderlib/guiding/guiding_field.h"
#include "renderlib/integrate/path_state.h"
#include "renderlib/material/bsdf.h"

namespace bandsaw {

/// Returns true if directions at this BSDF can be guided: it scatters into a wide range of
/// directions on one side.
bool can_be_guided(const Bsdf& bsdf);

/// Returns the cones that guide the BSDF at `point`, seen from direction `wo`. If there is no field
/// or the BSDF cannot be guided, returns an object without cones, whose share() is 0.
inline GuidingCones cones_at(const PathContext& context, const SurfacePoint& point,
                             const Bsdf& bsdf, const Vec3& wo) {
  const GuidingField* field = context.options.guiding;
  if (field == nullptr || !can_be_guided(bsdf)) {
    return {};
  }
  const Vec3 normal = facing_normal(point, wo);
  return GuidingCones(field->find(point.position, normal), point.position, normal);
}

/// A direction that was sampled from the mixture.
struct GuidedSample {
  BsdfSample next;
  /// The factor by which guiding changed the weight: the pdf of the BSDF over that of the mixture.
  /// Russian roulette divides it out: a direction that guiding prefers has a low weight because
  /// much light is expected there, and such paths must not end early.
  double scaling = 1;
};

/// Implements the next function, sample(), for cones whose share() is not 0.
std::optional<GuidedSample> sample_mixture(const Bsdf& bsdf, const GuidingCones& cones, double u,
                                           double v, double lobe);

/// Samples a direction from the mixture. `u`, `v` and `lobe` are random numbers in [0, 1). `lobe`
/// first chooses between BSDF and cones, and is then stretched to [0, 1) again. Returns
/// std::nullopt if the BSDF absorbs the light, or if a cone gives a direction from which the BSDF
/// scatters no light.
inline std::optional<GuidedSample> sample(const Bsdf& bsdf, const GuidingCones& cones, double u,
                                          double v, double lobe) {
  if (cones.share() > 0) {
    return sample_mixture(bsdf, cones, u, v, lobe);
  }
  const std::optional<BsdfSample> next = sample(bsdf, u, v, lobe);
  return next ? std::optional(GuidedSample{*next}) : std::nullopt;
}

/// Returns the value of the BSDF and the pdf of the mixture.
inline BsdfValue evaluate(const Bsdf& bsdf, const GuidingCones& cones, const Vec3& wi) {
  BsdfValue value = evaluate(bsdf, wi);
  if (cones.share() > 0) {
    value.pdf = (1 - cones.share()) * value.pdf + cones.share() * cones.pdf(wi);
  }
  return value;
}

}  // namespace bandsaw
