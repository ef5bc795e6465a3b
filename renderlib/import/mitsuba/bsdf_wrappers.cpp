// Converts wrappers: bsdfs that contain another bsdf (twosided, mask, normalmap, bumpmap, coating).
// The function of each wrapper reads the inner bsdf into `draft`, the unfinished material, and adds
// what the wrapper changes. The coat of a coating is left out with a warning.

#include <algorithm>
#include <utility>

#include "absl/strings/str_cat.h"
#include "renderlib/base/status_macros.h"
#include "renderlib/import/mitsuba/bsdf_reader.h"

namespace bandsaw::mitsuba {

absl::StatusOr<const Object*> BsdfReader::inner(const Parameters& from) {
  const auto inside = from.objects("bsdf");
  if (inside.empty()) {
    return error_at(from.place(),
                    absl::StrCat("bsdf \"", from.object().type, "\" needs a bsdf inside"));
  }
  return object_in(*inside.front());
}

absl::Status BsdfReader::two_sided(const Parameters& from, Draft& draft) {
  ASSIGN_OR_RETURN(const Object* inside, inner(from));
  const auto both = from.objects("bsdf");
  if (both.size() > 1 && object_in(*both[1]) != inside) {
    to_.warn(both[1]->place,
             "the second bsdf of \"twosided\" is left out; both sides show the first one");
  }
  draft.two_sided = true;
  return read(*inside, draft);
}

absl::Status BsdfReader::mask(const Parameters& from, Draft& draft) {
  ASSIGN_OR_RETURN(const Object* inside, inner(from));
  RETURN_IF_ERROR(read(*inside, draft));
  ASSIGN_OR_RETURN(Varying opacity, varying_of(from, "opacity", 0.5, surface_, to_));
  if (draft.material.has_opacity() || draft.material.has_opacity_texture()) {
    to_.warn(from.place(), "a mask around another mask is left out");
    return absl::OkStatus();
  }
  if (opacity.texture) {
    *draft.material.mutable_opacity_texture() = *std::move(opacity.texture);
  } else {
    draft.material.set_opacity(std::clamp(opacity.value, 0.0, 1.0));
  }
  return absl::OkStatus();
}

absl::Status BsdfReader::normal_map(const Parameters& from, Draft& draft) {
  ASSIGN_OR_RETURN(const Object* inside, inner(from));
  RETURN_IF_ERROR(read(*inside, draft));
  const Property* map = from.find("normalmap");
  if (map == nullptr && !from.objects("texture").empty()) {
    map = from.objects("texture").front();
  }
  if (map == nullptr) {
    return error_at(from.place(), "bsdf \"normalmap\" needs a texture");
  }
  ASSIGN_OR_RETURN(scene::Texture texture, texture_of(*map, ColorOf::kSurface, surface_, to_));
  if (draft.material.has_normal_texture() || draft.material.has_bump_texture()) {
    to_.warn(from.place(), "of several normal and bump maps the innermost is shown");
    return absl::OkStatus();
  }
  *draft.material.mutable_normal_texture() = std::move(texture);
  return absl::OkStatus();
}

absl::Status BsdfReader::bump_map(const Parameters& from, Draft& draft) {
  ASSIGN_OR_RETURN(const Object* inside, inner(from));
  RETURN_IF_ERROR(read(*inside, draft));
  ASSIGN_OR_RETURN(const double scale, from.number("scale", 1));
  const auto textures = from.objects("texture");
  if (textures.empty()) {
    return error_at(from.place(), "bsdf \"bumpmap\" needs a texture");
  }
  ASSIGN_OR_RETURN(scene::Texture texture,
                   texture_of(*textures.front(), ColorOf::kSurface, surface_, to_));
  if (draft.material.has_normal_texture() || draft.material.has_bump_texture()) {
    to_.warn(from.place(), "of several normal and bump maps the innermost is shown");
    return absl::OkStatus();
  }
  *draft.material.mutable_bump_texture() = std::move(texture);
  draft.material.set_bump_scale(scale);
  return absl::OkStatus();
}

absl::Status BsdfReader::coating(const Parameters& from, Draft& draft) {
  ASSIGN_OR_RETURN(const Object* inside, inner(from));
  to_.warn(from.place(), absl::StrCat("the coat of bsdf \"", from.object().type, "\" is left out"));
  from.ignore({"int_ior", "ext_ior", "thickness", "sigma_a", "specular_reflectance", "alpha",
               "distribution"});
  return read(*inside, draft);
}

}  // namespace bandsaw::mitsuba
