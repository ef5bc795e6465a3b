// Reads parameters that several materials of pbrt have: roughness, which may be remapped to alpha,
// and the index of refraction.

#include "renderlib/import/pbrt/material_source.h"

#include <algorithm>
#include <cmath>

#include "absl/strings/str_cat.h"
#include "renderlib/base/status_macros.h"

namespace bandsaw::pbrt {
namespace {

/// The alpha below which pbrt treats a surface as smooth.
constexpr double kSmooth = 1e-3;

}  // namespace

bool Roughness::is_smooth() const { return !texture && std::max(alpha[0], alpha[1]) < kSmooth; }

absl::StatusOr<Roughness> read_roughness(const MaterialSource& from, const std::string& prefix,
                                         double otherwise) {
  const Parameters& in = from.parameters;
  ASSIGN_OR_RETURN(const bool remap, in.boolean("remaproughness", true));
  ASSIGN_OR_RETURN(const auto both, float_texture(in, prefix + "roughness", from.builder));
  Roughness out;
  const char* names[2] = {"uroughness", "vroughness"};
  for (int k = 0; k < 2; ++k) {
    ASSIGN_OR_RETURN(auto own, float_texture(in, prefix + names[k], from.builder));
    const std::optional<scene::Texture>& texture = own ? own : both;
    const auto value = texture ? constant_of(*texture) : std::optional(otherwise);
    if (!value) {
      ASSIGN_OR_RETURN(out.texture, limited(*texture, from.place(), from.builder));
      continue;
    }
    out.alpha[k] = std::clamp(remap ? std::sqrt(std::max(*value, 0.0)) : *value, 0.0, 1.0);
  }
  if (out.texture && remap) {
    from.builder.warn_once(
        from.place(),
        "textures of roughness are taken as alpha: \"remaproughness\" has no effect on them");
  }
  return out;
}

void set_microfacets(const Roughness& roughness, scene::Microfacets* to) {
  to->set_distribution(scene::Microfacets::DISTRIBUTION_GGX);
  to->set_masking(scene::Microfacets::MASKING_CORRELATED);
  if (roughness.texture) {
    to->set_alpha(1);
    *to->mutable_alpha_texture() = *roughness.texture;
    return;
  }
  to->set_alpha(roughness.alpha[0]);
  if (roughness.alpha[1] != roughness.alpha[0]) {
    to->set_alpha_v(roughness.alpha[1]);
  }
}

absl::StatusOr<double> read_index(const MaterialSource& from, const std::string& name,
                                  double otherwise) {
  const Parameter* found = from.parameters.find(name);
  if (found == nullptr || found->type == "float") {
    ASSIGN_OR_RETURN(const double index, from.parameters.number(name, otherwise));
    if (!(index >= 1 && index <= 5)) {
      from.builder.warn(from.place(), absl::StrCat("the index of refraction ", index,
                                                   " is taken as ", std::clamp(index, 1.0, 5.0)));
    }
    return std::clamp(index, 1.0, 5.0);
  }
  if (found->type != "spectrum") {
    ASSIGN_OR_RETURN(const Rgb3 rgb, color_of(*found, ColorUse::kUnbounded, "srgb", from.builder));
    return std::clamp(spectrum::luminance(rgb), 1.0, 5.0);
  }
  ASSIGN_OR_RETURN(const auto sampled, spectrum_of(*found, from.builder));
  from.builder.warn_once(found->place,
                         "the index of refraction at 588 nm is used: there is no dispersion");
  return std::clamp(sampled->at(spectrum::kLineD), 1.0, 5.0);
}

}  // namespace bandsaw::pbrt
