// Adds materials to the Bandsaw scene that is made from a pbrt scene, and names them. In pbrt,
// emission and opacity belong to the shape; in Bandsaw they belong to the material. So each
// combination of a surface, an emission and an opacity becomes one material.

#include <algorithm>

#include "absl/strings/str_cat.h"
#include "renderlib/import/pbrt/builder.h"

namespace bandsaw::pbrt {
namespace {

/// Adds the emission of a shape. A black surface without an opacity becomes an Emissive material.
void add_emission(const ShapeLook& look, const Surface& surface, const Place& place,
                  scene::Material& to, Builder& builder) {
  const Rgb3 emission = look.emission.value_or(Rgb3{0, 0, 0});
  if (surface.is_black && !look.opacity) {
    scene::Emissive& lamp = *to.mutable_emissive();
    lamp.set_one_sided(!look.emits_on_both_sides);
    if (look.emission_texture) {
      *lamp.mutable_texture() = *look.emission_texture;
    } else {
      set_rgb(emission, lamp.mutable_radiance());
    }
    return;
  }
  if (to.has_mix()) {
    builder.warn(place, "a mix of materials cannot emit; the shape emits no light");
    return;
  }
  if (to.has_gltf()) {
    set_rgb(emission, to.mutable_gltf()->mutable_emissive());
    to.mutable_gltf()->set_double_sided(look.emits_on_both_sides);
    return;
  }
  if (look.emission_texture) {
    *to.mutable_emission_texture() = *look.emission_texture;
  } else {
    set_rgb(emission, to.mutable_emission());
  }
  to.set_emission_one_sided(!look.emits_on_both_sides);
}

/// Sets the opacity of a shape. Warns if a material of this kind cannot have an opacity.
void add_opacity(const scene::Texture& opacity, const Place& place, scene::Material& to,
                 Builder& builder) {
  if (to.has_mix() || to.has_emissive()) {
    builder.warn(place, "the alpha of the shape is left out");
    return;
  }
  const auto value = constant_of(opacity);
  if (to.has_gltf()) {
    to.mutable_gltf()->set_alpha_mode(scene::Gltf::ALPHA_MODE_BLEND);
    if (value) {
      to.mutable_gltf()->set_alpha(std::clamp(*value, 0.0, 1.0));
    } else {
      *to.mutable_gltf()->mutable_alpha_texture() = opacity;
    }
  } else if (value) {
    to.set_opacity(std::clamp(*value, 0.0, 1.0));
  } else {
    *to.mutable_opacity_texture() = opacity;
  }
}

}  // namespace

std::string material_name(const Surface& surface, const ShapeLook& look, const Place& place,
                          Builder& builder) {
  scene::Material material = surface.material;
  if (look.emission || look.emission_texture) {
    add_emission(look, surface, place, material, builder);
  }
  if (look.opacity) {
    add_opacity(*look.opacity, place, material, builder);
  }
  const std::string key = absl::StrCat(surface.label, "\n", material.SerializeAsString());
  const auto known = builder.material_names.find(key);
  if (known != builder.material_names.end()) {
    return known->second;
  }
  const std::string base = surface.label.empty() ? "material" : surface.label;
  std::string name = base;
  while (!builder.taken_names.insert(name).second) {
    name = absl::StrCat(base, "_", ++builder.name_counts[base] + 1);
  }
  material.set_name(name);
  *builder.out.add_material() = std::move(material);
  builder.material_names.emplace(key, name);
  return name;
}

}  // namespace bandsaw::pbrt
