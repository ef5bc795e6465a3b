// Reads the materials of a scene file: read_kind() calls one function for each kind. Then the
// relief (a normal map or a bump map), the opacity and the emission are read. All kinds except
// emissive, gltf and mix can have these properties. Glass may have a priority: where several such
// glasses overlap, only the glass of the highest priority is present.

#include "renderlib/import/scene_file/read_materials.h"

#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "absl/status/statusor.h"
#include "absl/strings/str_cat.h"
#include "proto/scene.pb.h"
#include "renderlib/base/status_macros.h"
#include "renderlib/import/draft/color_limits.h"
#include "renderlib/import/draft/scene_draft.h"
#include "renderlib/import/scene_file/field.h"
#include "renderlib/import/scene_file/material_fields.h"
#include "renderlib/import/scene_file/numbers.h"
#include "renderlib/import/scene_file/read_gltf.h"
#include "renderlib/import/scene_file/read_microfacets.h"
#include "renderlib/import/scene_file/read_principled.h"
#include "renderlib/import/scene_file/read_textures.h"
#include "renderlib/import/scene_file/suggest.h"
#include "renderlib/material/interiors.h"
#include "renderlib/material/transmits.h"

namespace bandsaw {
namespace {

absl::StatusOr<Material> read_metal(const Field& in, const scene::Metal& from, SceneDraft& draft) {
  Metal metal;
  ASSIGN_OR_RETURN(metal.reflectance, read_reflectance(in, from, 1, draft));
  ASSIGN_OR_RETURN(metal.fuzz_map, read_map(in, "fuzz_texture", from.has_fuzz_texture(),
                                            from.fuzz_texture(), draft));
  metal.fuzz = from.has_fuzz() ? from.fuzz() : metal.fuzz_map ? 1 : 0;
  RETURN_IF_ERROR(check_range(in, "fuzz", metal.fuzz, 0, 1));
  return metal;
}

absl::StatusOr<Material> read_dielectric(const Field& in, const scene::Dielectric& from,
                                         SceneDraft& draft) {
  Dielectric glass;
  if (from.has_index_of_refraction()) {
    glass.index_of_refraction = from.index_of_refraction();
  }
  RETURN_IF_ERROR(check_range(in, "index_of_refraction", glass.index_of_refraction, 1, 5));
  ASSIGN_OR_RETURN(glass.roughness_map,
                   read_map(in, "roughness_texture", from.has_roughness_texture(),
                            from.roughness_texture(), draft));
  if (from.has_surface()) {
    if (from.has_roughness() || from.has_roughness_texture()) {
      return in.error("surface", "write surface or roughness, not both");
    }
    ASSIGN_OR_RETURN(glass.surface, read_microfacets(in.child("surface"), from.surface(), draft));
  }
  glass.roughness = from.has_roughness() ? from.roughness() : glass.roughness_map ? 1 : 0;
  RETURN_IF_ERROR(check_range(in, "roughness", glass.roughness, 0, 1));
  glass.priority = from.priority();
  ASSIGN_OR_RETURN(glass.index_map, read_map(in, "index_of_refraction_texture",
                                             from.has_index_of_refraction_texture(),
                                             from.index_of_refraction_texture(), draft));
  if (glass.index_map && glass.priority > 0) {
    return in.error("index_of_refraction_texture",
                    "a glass with a priority has one index of refraction; leave out the texture or "
                    "the priority");
  }
  return glass;
}

absl::StatusOr<Material> read_emissive(const Field& in, const scene::Emissive& from,
                                       SceneDraft& draft) {
  if (from.has_texture() && from.has_radiance()) {
    return in.error("texture", "write radiance or texture, not both");
  }
  if (from.has_texture()) {
    ASSIGN_OR_RETURN(const TextureId id,
                     read_texture(in.child("texture"), from.texture(), kMaxRadiance, draft));
    return Emissive{id, from.one_sided(), from.hidden()};
  }
  if (!from.has_radiance()) {
    return in.error("radiance", "is required, for example radiance { rgb: [15, 15, 15] }");
  }
  ASSIGN_OR_RETURN(const Rgb radiance,
                   read_color(in.child("radiance"), from.radiance(), kMaxRadiance));
  return Emissive{draft.textures.constant(radiance), from.one_sided(), from.hidden()};
}

absl::StatusOr<Material> read_thin_dielectric(const Field& in, const scene::ThinDielectric& from) {
  ThinDielectric pane;
  if (from.has_index_of_refraction()) {
    pane.index_of_refraction = from.index_of_refraction();
  }
  RETURN_IF_ERROR(check_range(in, "index_of_refraction", pane.index_of_refraction, 1, 5));
  if (from.has_specular()) {
    ASSIGN_OR_RETURN(pane.specular,
                     read_color(in.child("specular"), from.specular(), kMaxReflectance));
  }
  if (from.has_transmission()) {
    ASSIGN_OR_RETURN(pane.transmission,
                     read_color(in.child("transmission"), from.transmission(), kMaxReflectance));
  }
  pane.free_passage = from.free_passage();
  return pane;
}

/// Reads a thin sheet, such as paper or a leaf, that reflects and transmits light diffusely.
absl::StatusOr<Material> read_sheet(const Field& in, const scene::DiffuseTransmission& from,
                                    SceneDraft& draft) {
  DiffuseTransmission sheet;
  ASSIGN_OR_RETURN(sheet.reflectance,
                   read_reflectance(in,
                                    {"reflectance_texture", from.has_reflectance_texture(),
                                     from.reflectance_texture(), "reflectance",
                                     from.has_reflectance(), from.reflectance(), 0.25f},
                                    draft));
  ASSIGN_OR_RETURN(sheet.transmittance,
                   read_reflectance(in,
                                    {"transmittance_texture", from.has_transmittance_texture(),
                                     from.transmittance_texture(), "transmittance",
                                     from.has_transmittance(), from.transmittance(), 0.25f},
                                    draft));
  if (from.has_reflectance_texture() || from.has_transmittance_texture()) {
    return sheet;  // if the two add up to more than 1, diffuse_transmission() scales both
  }
  const auto color_of = [&](TextureId id) {
    return evaluate(draft.out.scene.textures, id, TextureCoordinates{});
  };
  // Decimal fractions that sum to 1 may be a little above it as floats.
  return max_component(color_of(sheet.reflectance) + color_of(sheet.transmittance)) <= 1.00001f
             ? absl::StatusOr<Material>(sheet)
             : in.error("transmittance", "reflectance and transmittance must not exceed 1 in sum");
}

// Returns one of the two materials of a mixture: the one that the field `field` of the mixture
// names. This material must be written before the mixture.
absl::StatusOr<MaterialId> find_part(const Field& in, const char* field, const std::string& name,
                                     const SceneDraft& draft) {
  if (name.empty()) {
    return in.error(field, "is required: the name of a material that is written before this one");
  }
  const auto found = draft.materials.find(name);
  if (found == draft.materials.end()) {
    return in.error(field, absl::StrCat("no material before this one is called \"", name, "\""));
  }
  if (nested_glass(draft.out.scene.materials[index_of(found->second)]) != nullptr) {
    return in.error(field, "a glass with a priority is not part of a mixture");
  }
  return found->second;
}

absl::StatusOr<Material> read_mix(const Field& in, const scene::MixMaterial& from,
                                  SceneDraft& draft) {
  Mix mix;
  ASSIGN_OR_RETURN(mix.a, find_part(in, "a", from.a(), draft));
  ASSIGN_OR_RETURN(mix.b, find_part(in, "b", from.b(), draft));
  mix.amount = draft.textures.constant(gray(0.5f));
  if (from.has_amount()) {
    ASSIGN_OR_RETURN(mix.amount,
                     read_texture(in.child("amount"), from.amount(), kMaxReflectance, draft));
  }
  return mix;
}

absl::StatusOr<Material> read_kind(const Field& in, const scene::Material& from,
                                   SceneDraft& draft) {
  switch (from.kind_case()) {
    case scene::Material::kDiffuse: {
      ASSIGN_OR_RETURN(const TextureId id,
                       read_reflectance(in.child("diffuse"), from.diffuse(), 0.5f, draft));
      return Diffuse{id};
    }
    case scene::Material::kMetal:
      return read_metal(in.child("metal"), from.metal(), draft);
    case scene::Material::kDielectric:
      return read_dielectric(in.child("dielectric"), from.dielectric(), draft);
    case scene::Material::kGltf:
      return read_gltf(in.child("gltf"), from.gltf(), draft);
    case scene::Material::kEmissive:
      return read_emissive(in.child("emissive"), from.emissive(), draft);
    case scene::Material::kPlastic:
      return read_plastic(in.child("plastic"), from.plastic(), draft);
    case scene::Material::kConductor:
      return read_conductor(in.child("conductor"), from.conductor(), draft);
    case scene::Material::kThinDielectric:
      return read_thin_dielectric(in.child("thin_dielectric"), from.thin_dielectric());
    case scene::Material::kDiffuseTransmission:
      return read_sheet(in.child("diffuse_transmission"), from.diffuse_transmission(), draft);
    case scene::Material::kPrincipled:
      return read_principled(in.child("principled"), from.principled(), draft);
    case scene::Material::kThinPrincipled:
      return read_thin_principled(in.child("thin_principled"), from.thin_principled(), draft);
    case scene::Material::kMix:
      return read_mix(in.child("mix"), from.mix(), draft);
    case scene::Material::KIND_NOT_SET:
      break;
  }
  return in.error(
      "has no kind: write diffuse, metal, plastic, dielectric, emissive, gltf or another kind");
}

absl::Status read_relief(const Field& in, const scene::Material& from, SceneDraft& draft,
                         Relief& to) {
  if (from.has_normal_texture() && from.has_bump_texture()) {
    return in.error("bump_texture", "write normal_texture or bump_texture, not both");
  }
  ASSIGN_OR_RETURN(to.normal, read_map(in, "normal_texture", from.has_normal_texture(),
                                       from.normal_texture(), draft));
  if (from.has_bump_texture()) {
    ASSIGN_OR_RETURN(
        to.height, read_texture(in.child("bump_texture"), from.bump_texture(), kMaxHeight, draft));
    if (uses_object_space(draft.out.scene.textures, *to.height)) {
      return in.error("bump_texture",
                      "a height map cannot lie in object space: leave the field \"space\" out, or "
                      "write space: SPACE_WORLD");
    }
  }
  to.normal_scale = from.has_normal_scale() ? from.normal_scale() : 1;
  to.height_scale = from.has_bump_scale() ? from.bump_scale() : 1;
  RETURN_IF_ERROR(check_range(in, "bump_scale", to.height_scale, -1e30, 1e30));
  return check_range(in, "normal_scale", to.normal_scale, -1e30, 1e30);
}

absl::Status read_opacity(const Field& in, const scene::Material& from, SceneDraft& draft,
                          Alpha& to) {
  if (!from.has_opacity() && !from.has_opacity_texture()) {
    return absl::OkStatus();
  }
  to.mode = AlphaMode::kBlend;
  to.luminance = true;
  to.value.factor = from.has_opacity() ? from.opacity() : 1;
  RETURN_IF_ERROR(check_range(in, "opacity", to.value.factor, 0, 1));
  ASSIGN_OR_RETURN(to.value.texture,
                   texture_or_white(in, "opacity_texture", from.has_opacity_texture(),
                                    from.opacity_texture(), kMaxReflectance, draft));
  return absl::OkStatus();
}

absl::Status read_emission(const Field& in, const scene::Material& from, SceneDraft& draft,
                           Emission& to) {
  if (!from.has_emission() && !from.has_emission_texture()) {
    return absl::OkStatus();
  }
  to.radiance.factor = {1, 1, 1};
  if (from.has_emission()) {
    ASSIGN_OR_RETURN(to.radiance.factor,
                     read_color(in.child("emission"), from.emission(), kMaxRadiance));
  }
  ASSIGN_OR_RETURN(to.radiance.texture,
                   texture_or_white(in, "emission_texture", from.has_emission_texture(),
                                    from.emission_texture(), kMaxRadiance, draft));
  to.one_sided = from.emission_one_sided();
  return absl::OkStatus();
}

// Returns INVALID_ARGUMENT if the material has a property of the surface, such as a normal map,
// that its kind cannot have.
absl::Status check_properties(const Field& in, const scene::Material& from) {
  constexpr const char* kOfSurface[] = {"normal_texture",   "normal_scale",    "bump_texture",
                                        "bump_scale",       "opacity_texture", "opacity",
                                        "emission_texture", "emission"};
  const auto refuse = [&](const char* why) -> absl::Status {
    for (const char* const name : kOfSurface) {
      if (in.has(name)) {
        return in.error(name, why);
      }
    }
    if (from.emission_one_sided()) {
      return in.error("emission_one_sided", why);
    }
    return from.one_sided() ? in.error("one_sided", why) : absl::OkStatus();
  };
  if (from.has_emissive()) {
    return refuse("is not possible for an emissive material, which only emits");
  }
  if (from.has_mix()) {
    return refuse("is not possible for a mix: write it for its parts");
  }
  return from.has_gltf() ? refuse("write the field of gltf instead") : absl::OkStatus();
}

absl::StatusOr<Material> read_material(const Field& in, const scene::Material& from,
                                       SceneDraft& draft) {
  RETURN_IF_ERROR(check_properties(in, from));
  ASSIGN_OR_RETURN(Material to, read_kind(in, from, draft));
  if (from.has_emissive() || from.has_gltf() || from.has_mix()) {
    return to;
  }
  RETURN_IF_ERROR(read_relief(in, from, draft, to.relief));
  RETURN_IF_ERROR(read_opacity(in, from, draft, to.alpha));
  RETURN_IF_ERROR(read_emission(in, from, draft, to.emission));
  if (nested_glass(to) != nullptr && to.alpha.mode != AlphaMode::kOpaque) {
    return in.error("opacity",
                    "a glass with a priority is opaque; leave out the priority or the opacity");
  }
  to.one_sided = from.one_sided();
  if (to.one_sided && transmits(to)) {
    return in.error("one_sided", "a material that transmits light has two sides");
  }
  return to;
}

}  // namespace

absl::Status read_materials(const Field& root, const scene::Scene& from, SceneDraft& draft) {
  for (int i = 0; i < from.material_size(); ++i) {
    const Field in = root.child("material", i);
    const std::string& name = from.material(i).name();
    if (name.empty()) {
      return in.error("name", "is required, so that a shape can say what it is made of");
    }
    ASSIGN_OR_RETURN(const Material material, read_material(in, from.material(i), draft));
    if (!draft.materials.emplace(name, draft.add_material(material)).second) {
      return in.error("name", absl::StrCat("\"", name, "\" is the name of another material"));
    }
  }
  return absl::OkStatus();
}

absl::StatusOr<MaterialId> find_material(const Field& in, const std::string& name,
                                         const SceneDraft& draft) {
  if (name.empty()) {
    return in.error("material", "is required: the name of a material");
  }
  const auto found = draft.materials.find(name);
  if (found != draft.materials.end()) {
    return found->second;
  }
  std::vector<std::string> known;
  for (const auto& [other, id] : draft.materials) {
    known.push_back(other);
  }
  const std::string hint = did_you_mean(name, known);
  return in.error("material", absl::StrCat("no material is called \"", name, "\"",
                                           known.empty() ? "; the scene has none" : hint));
}

}  // namespace bandsaw
