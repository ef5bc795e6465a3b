// Reads the materials of a scene file that have microfacets: conductors, plastic, and the surface
// of rough glass.

#include "renderlib/import/scene_file/read_microfacets.h"

#include "absl/strings/str_cat.h"
#include "renderlib/base/status_macros.h"
#include "renderlib/import/scene_file/material_fields.h"

namespace bandsaw {
namespace {

constexpr float kMaxMetalIndex = 100;  // limit of eta and k, far above the values of any metal

absl::StatusOr<ConductorIndex> read_index(const Field& in, const scene::Conductor& from) {
  ConductorIndex index;
  ASSIGN_OR_RETURN(index.eta, read_color(in.child("eta"), from.eta(), kMaxMetalIndex));
  ASSIGN_OR_RETURN(index.k, read_color(in.child("k"), from.k(), kMaxMetalIndex));
  if (index.eta.r == 0 || index.eta.g == 0 || index.eta.b == 0) {
    return in.error("eta", "must be above 0 in each channel");
  }
  return index;
}

}  // namespace

absl::StatusOr<Microfacets> read_microfacets(const Field& in, const scene::Microfacets& from,
                                             SceneDraft& draft) {
  if (!scene::Microfacets::Distribution_IsValid(from.distribution())) {
    return in.error("distribution", absl::StrCat("has the unknown value ", from.distribution()));
  }
  if (!scene::Microfacets::Masking_IsValid(from.masking())) {
    return in.error("masking", absl::StrCat("has the unknown value ", from.masking()));
  }
  Microfacets to;
  // The enums of Microfacets and of the scene file have their values in the same order.
  to.distribution = static_cast<Microfacets::Distribution>(from.distribution());
  to.masking = static_cast<Microfacets::Masking>(from.masking());
  ASSIGN_OR_RETURN(to.alpha_u_map, read_map(in, "alpha_texture", from.has_alpha_texture(),
                                            from.alpha_texture(), draft));
  to.alpha_u = from.has_alpha() ? from.alpha() : to.alpha_u_map ? 1 : 0;
  RETURN_IF_ERROR(check_range(in, "alpha", to.alpha_u, 0, 1));
  to.alpha_v_map = to.alpha_u_map;
  if (from.has_alpha_v_texture()) {
    ASSIGN_OR_RETURN(to.alpha_v_map, read_map(in, "alpha_v_texture", /*given=*/true,
                                              from.alpha_v_texture(), draft));
  }
  // A texture without a constant is multiplied by 1. If the file gives no values for v, the values
  // for u are used.
  const bool only_v = from.has_alpha_v_texture() && !from.has_alpha();
  to.alpha_v = from.has_alpha_v() ? from.alpha_v() : only_v ? 1 : to.alpha_u;
  RETURN_IF_ERROR(check_range(in, "alpha_v", to.alpha_v, 0, 1));
  return to;
}

absl::StatusOr<Material> read_conductor(const Field& in, const scene::Conductor& from,
                                        SceneDraft& draft) {
  Conductor metal;
  if (from.has_eta() != from.has_k()) {
    return in.error(from.has_eta() ? "eta" : "k",
                    "write eta and k, or neither for a mirror that reflects everything");
  }
  if (from.has_eta()) {
    ASSIGN_OR_RETURN(metal.index, read_index(in, from));
  }
  if (from.has_surface()) {
    ASSIGN_OR_RETURN(metal.surface, read_microfacets(in.child("surface"), from.surface(), draft));
  }
  ASSIGN_OR_RETURN(
      metal.specular,
      read_reflectance(in,
                       {"specular_texture", from.has_specular_texture(), from.specular_texture(),
                        "specular", from.has_specular(), from.specular(), 1},
                       draft));
  return metal;
}

absl::StatusOr<Material> read_plastic(const Field& in, const scene::Plastic& from,
                                      SceneDraft& draft) {
  Plastic plastic;
  ASSIGN_OR_RETURN(plastic.reflectance, read_reflectance(in, from, 0.5f, draft));
  if (from.has_index_of_refraction()) {
    plastic.index_of_refraction = from.index_of_refraction();
  }
  RETURN_IF_ERROR(check_range(in, "index_of_refraction", plastic.index_of_refraction, 1, 5));
  if (plastic.index_of_refraction == 1) {
    return in.error("index_of_refraction",
                    "must be above 1: a coat of index 1 would reflect nothing");
  }
  if (from.has_surface()) {
    ASSIGN_OR_RETURN(plastic.surface, read_microfacets(in.child("surface"), from.surface(), draft));
  }
  if (!plastic.surface.isotropic()) {
    return in.child("surface").error("the coat of plastic is isotropic: leave alpha_v out");
  }
  if (from.has_specular()) {
    ASSIGN_OR_RETURN(plastic.specular,
                     read_color(in.child("specular"), from.specular(), kMaxReflectance));
  }
  plastic.nonlinear = from.nonlinear();
  return plastic;
}

}  // namespace bandsaw
