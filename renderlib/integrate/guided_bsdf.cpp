// The field of path guiding gives cones of directions from which it expects light. A direction is
// sampled from the cones with the probability GuidingCones::share(), otherwise from the BSDF. In
// both cases the returned pdf is the pdf of the mixture of the two.

#include "renderlib/integrate/guided_bsdf.h"

#include "renderlib/base/overloaded.h"

namespace bandsaw {
namespace {

/// Samples a direction from the cones. Returns std::nullopt if the BSDF scatters no light from this
/// direction.
std::optional<GuidedSample> sample_cones(const Bsdf& bsdf, const GuidingCones& cones, double choice,
                                         double u, double v) {
  const Vec3 wi = cones.sample(choice, u, v);
  const BsdfValue scattered = evaluate(bsdf, wi);
  const double pdf = (1 - cones.share()) * scattered.pdf + cones.share() * cones.pdf(wi);
  if (is_black(scattered.value) || !(pdf > 0)) {
    return std::nullopt;
  }
  return GuidedSample{
      {.wi = wi, .weight = scattered.value * static_cast<float>(1 / pdf), .pdf = pdf},
      scattered.pdf / pdf};
}

}  // namespace

bool can_be_guided(const Bsdf& bsdf) {
  return std::visit(Overloaded{[](const DiffuseBsdf&) { return true; },
                               [](const PlasticBsdf&) { return true; },
                               [](const MetallicRoughnessBsdf& b) { return b.metallic < 1; },
                               [](const PrincipledBsdf&) { return true; },
                               [](const auto&) { return false; }},
                    bsdf) &&
         !has_pdf_behind(bsdf);
}

std::optional<GuidedSample> sample_mixture(const Bsdf& bsdf, const GuidingCones& cones, double u,
                                           double v, double lobe) {
  const double share = cones.share();
  if (lobe < share) {
    return sample_cones(bsdf, cones, lobe / share, u, v);
  }
  std::optional<BsdfSample> next = sample(bsdf, u, v, (lobe - share) / (1 - share));
  if (!next) {
    return std::nullopt;
  }
  const double scaling = next->delta
                             ? 1 / (1 - share)
                             : next->pdf / ((1 - share) * next->pdf + share * cones.pdf(next->wi));
  next->weight = next->weight * static_cast<float>(scaling);
  next->pdf /= scaling;
  return GuidedSample{*next, scaling};
}

}  // namespace bandsaw
