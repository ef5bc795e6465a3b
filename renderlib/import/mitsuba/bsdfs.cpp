// Converts the materials of a Mitsuba scene. Makes one material for each combination of bsdf,
// emitter and uvs. A combination that occurs again gets the same material. Glass of Bandsaw has the
// larger index of refraction inside. If a bsdf has the larger index outside, its shapes must
// exchange their sides (SurfaceMaterial::turned).

#include "renderlib/import/mitsuba/bsdfs.h"

#include <algorithm>
#include <utility>

#include "absl/strings/str_cat.h"
#include "renderlib/base/status_macros.h"
#include "renderlib/import/mitsuba/bsdf_reader.h"
#include "renderlib/import/mitsuba/spectra.h"

namespace bandsaw::mitsuba {
namespace {

/// Returns the bsdf inside all "twosided" wrappers around `bsdf`. Returns nullptr if `bsdf` is
/// nullptr or the innermost wrapper is empty.
const Object* unwrapped(const Object* bsdf) {
  while (bsdf != nullptr && bsdf->type == "twosided") {
    const auto inside = Parameters(*bsdf).objects("bsdf");
    bsdf = inside.empty() ? nullptr : object_in(*inside.front());
  }
  return bsdf;
}

/// Sets the emission of `material` to the radiance of the area emitter `emitter`, or to white of
/// radiance 1 if the emitter gives none.
absl::Status add_emission(const Object& emitter, const TexturedSurface& surface,
                          scene::Material& material, Conversion& to) {
  const Parameters from(emitter);
  const Property* radiance = from.find("radiance");
  from.ignore({"sampling_weight"});
  material.set_emission_one_sided(true);
  if (radiance == nullptr) {
    set_color(gray(1), material.mutable_emission());
    return absl::OkStatus();
  }
  ASSIGN_OR_RETURN(const std::optional<Rgb> color, constant_color(*radiance, ColorOf::kLight));
  if (color) {
    const auto not_negative = [](float c) { return std::max(c, 0.0f); };
    set_color({not_negative(color->r), not_negative(color->g), not_negative(color->b)},
              material.mutable_emission());
  } else {
    ASSIGN_OR_RETURN(*material.mutable_emission_texture(),
                     texture_of(*radiance, ColorOf::kLight, surface, to));
  }
  to.warn_of_unused(from);
  return absl::OkStatus();
}

}  // namespace

bool needs_uv(const Object* bsdf, const Object* emitter) {
  if (emitter != nullptr && uses_uv(Value(emitter))) {
    return true;
  }
  if (bsdf == nullptr) {
    return false;
  }
  // The grooves of an anisotropic material run along u, so their directions need uv coordinates.
  const bool grooves = Parameters(*bsdf).has("anisotropic") || Parameters(*bsdf).has("alpha_u");
  if (grooves || uses_uv(Value(bsdf))) {
    return true;
  }
  return std::any_of(bsdf->properties.begin(), bsdf->properties.end(), [](const Property& p) {
    const Object* inside = object_in(p);
    return inside != nullptr && inside->tag == "bsdf" && needs_uv(inside, nullptr);
  });
}

// A normal map may be inside wrappers and blends, so the bsdfs inside `bsdf` are searched too.
bool needs_handedness(const Object* bsdf) {
  return bsdf != nullptr &&
         (bsdf->type == "normalmap" ||
          std::any_of(bsdf->properties.begin(), bsdf->properties.end(), [](const Property& p) {
            const Object* inside = object_in(p);
            return inside != nullptr && inside->tag == "bsdf" && needs_handedness(inside);
          }));
}

bool is_null(const Object* bsdf) {
  const Object* inside = unwrapped(bsdf);
  return inside != nullptr && inside->type == "null";
}

std::string Materials::unique_name(const Object* bsdf) {
  const std::string base = bsdf == nullptr ? "default" : !bsdf->id.empty() ? bsdf->id : bsdf->type;
  std::string name = base;
  while (!names_.insert(name).second) {
    name = absl::StrCat(base, " ", ++counts_[base] + 1);
  }
  return name;
}

absl::StatusOr<SurfaceMaterial> Materials::add(scene::Material material, bool turned,
                                               const Object* bsdf, const Object* emitter,
                                               const TexturedSurface& surface) {
  if (emitter != nullptr) {
    RETURN_IF_ERROR(add_emission(*emitter, surface, material, to_));
  }
  material.set_name(unique_name(bsdf));
  *scene_.add_material() = std::move(material);
  return SurfaceMaterial{scene_.material(scene_.material_size() - 1).name(), turned};
}

absl::StatusOr<SurfaceMaterial> Materials::blend(const Object& bsdf, const Object* emitter,
                                                 const TexturedSurface& surface) {
  const Parameters from(bsdf);
  const auto parts = from.objects("bsdf");
  if (parts.size() != 2) {
    return error_at(bsdf.place, absl::StrCat("bsdf \"", bsdf.type, "\" must have two bsdfs, has ",
                                             parts.size()));
  }
  Varying weight{0.5};
  if (bsdf.type == "mixturebsdf") {  // version 0.x: one text has both weights
    ASSIGN_OR_RETURN(const std::string weights, from.text("weights", "0.5, 0.5"));
    to_.warn(bsdf.place, absl::StrCat("bsdf \"mixturebsdf\" with the weights ", weights,
                                      " is shown as an equal mixture"));
  } else {
    ASSIGN_OR_RETURN(weight, varying_of(from, "weight", 0.5, surface, to_));
  }
  ASSIGN_OR_RETURN(const SurfaceMaterial a, material_of(object_in(*parts[0]), emitter, surface));
  ASSIGN_OR_RETURN(const SurfaceMaterial b, material_of(object_in(*parts[1]), emitter, surface));
  if (a.name.empty() || b.name.empty()) {
    return error_at(bsdf.place, "a blend with \"null\" cannot be read; use a mask instead");
  }
  scene::Material material;
  material.set_name(unique_name(&bsdf));
  material.mutable_mix()->set_a(a.name);
  material.mutable_mix()->set_b(b.name);
  *material.mutable_mix()->mutable_amount() =
      weight.texture
          ? *std::move(weight.texture)
          : constant_texture(gray(static_cast<float>(std::clamp(weight.value, 0.0, 1.0))));
  to_.warn_of_unused(from);
  *scene_.add_material() = material;
  return SurfaceMaterial{material.name(), a.turned || b.turned};
}

absl::StatusOr<SurfaceMaterial> Materials::make(const Object* bsdf, const Object* emitter,
                                                const TexturedSurface& surface) {
  if (is_null(bsdf) && emitter == nullptr) {
    return SurfaceMaterial{};
  }
  const Object* inside = unwrapped(bsdf);
  if (inside != nullptr && (inside->type == "blendbsdf" || inside->type == "mixturebsdf")) {
    if (inside != bsdf) {
      to_.warn(bsdf->place,
               "\"twosided\" around a blend is left out; write \"twosided\" inside the blend");
    }
    return blend(*inside, emitter, surface);
  }
  Draft draft;
  if (is_null(bsdf)) {  // emits, but does not scatter
    set_color({}, draft.material.mutable_diffuse()->mutable_color());
  } else if (bsdf == nullptr) {
    set_color(gray(0.5f), draft.material.mutable_diffuse()->mutable_color());
  } else {
    RETURN_IF_ERROR(BsdfReader(surface, to_).read(*bsdf, draft));
  }
  if (!draft.two_sided && !draft.transmits) {
    draft.material.set_one_sided(true);
  }
  return add(std::move(draft.material), draft.turned, bsdf, emitter, surface);
}

// Follows the wrappers around the bsdf to the first bsdf of glass. If it has the larger index of
// refraction outside, the sides of its geometry are exchanged (`turned`).
absl::StatusOr<SurfaceMaterial> Materials::sides_of(const Object* bsdf) const {
  SurfaceMaterial sides;
  while (bsdf != nullptr && bsdf->type != "dielectric" && bsdf->type != "roughdielectric") {
    const auto inside = Parameters(*bsdf).objects("bsdf");
    bsdf = inside.empty() ? nullptr : object_in(*inside.front());
  }
  if (bsdf != nullptr) {
    const Parameters from(*bsdf);
    ASSIGN_OR_RETURN(const double in, index_of_refraction(from, "int_ior", "bk7"));
    ASSIGN_OR_RETURN(const double out, index_of_refraction(from, "ext_ior", "air"));
    sides.turned = in < out;
  }
  return sides;
}

absl::StatusOr<SurfaceMaterial> Materials::material_of(const Object* bsdf, const Object* emitter,
                                                       const TexturedSurface& surface) {
  const Key key{bsdf, emitter, surface.frame, surface.attributes};
  const auto known = known_.find(key);
  if (known != known_.end()) {
    return known->second;
  }
  ASSIGN_OR_RETURN(const SurfaceMaterial made, make(bsdf, emitter, surface));
  known_.emplace(key, made);
  return made;
}

}  // namespace bandsaw::mitsuba
