#include "renderlib/scene/validate.h"

#include <cmath>
#include <cstring>
#include <string>

#include "absl/strings/str_cat.h"
#include "renderlib/base/status_macros.h"
#include "renderlib/texture/check_texture.h"

namespace bandsaw {
namespace {

absl::Status invalid(absl::string_view field, absl::string_view why) {
  return absl::InvalidArgumentError(absl::StrCat(field, ": ", why));
}

std::string item(absl::string_view list, std::size_t index) {
  return absl::StrCat(list, "[", index, "]");
}

template <class Id>
absl::Status check_index(const std::string& field, Id id, std::size_t count) {
  if (index_of(id) >= count) {
    return invalid(field, absl::StrCat("must be below ", count, ", is ", index_of(id)));
  }
  return absl::OkStatus();
}

absl::Status check_point(const std::string& field, const Vec3& p) {
  if (!is_finite(p) || max_abs(p) > kMaxCoordinate) {
    return invalid(field, absl::StrCat("must be within +-", kMaxCoordinate, ", is [", p.x, ", ",
                                       p.y, ", ", p.z, "]"));
  }
  return absl::OkStatus();
}

absl::Status check_color(const std::string& field, const Rgb& color, float most) {
  for (const float value : {color.r, color.g, color.b}) {
    if (!(value >= 0 && value <= most) || !std::isfinite(value)) {
      const std::string range = std::isfinite(most) ? absl::StrCat("in [0, ", most, "]")
                                                    : std::string("finite and not negative");
      return invalid(field, absl::StrCat("must be ", range, ", is ", value));
    }
  }
  return absl::OkStatus();
}

absl::Status check_camera(const Camera& camera) {
  RETURN_IF_ERROR(validate(camera));
  RETURN_IF_ERROR(check_point("camera.position", view_of(camera).position));
  return check_point("camera.look_at", view_of(camera).look_at);
}

absl::Status check_local_shading(const LocalShading& local) {
  RETURN_IF_ERROR(
      check_color("local_shading.ambient", local.ambient, static_cast<float>(kInfinity)));
  if (!(local.occlusion_distance > 0)) {
    return invalid("local_shading.occlusion_distance",
                   absl::StrCat("must be > 0, is ", local.occlusion_distance));
  }
  return absl::OkStatus();
}

absl::Status check_image(const std::string& field, const ImageTexture& image) {
  if (image.width < 1 || image.height < 1) {
    return invalid(
        field, absl::StrCat("must have at least one texel, is ", image.width, " x ", image.height));
  }
  const std::uint64_t size = texel_bytes(image);
  if (image.texels.size() != size) {
    return invalid(absl::StrCat(field, ".texels"),
                   absl::StrCat("must have ", size, " bytes, has ", image.texels.size()));
  }
  return absl::OkStatus();
}

absl::Status check_textures(const std::vector<Texture>& textures) {
  std::vector<std::uint64_t> cost;
  for (std::size_t i = 0; i < textures.size(); ++i) {
    if (const absl::Status parts = check_parts(textures, i, cost); !parts.ok()) {
      return absl::InvalidArgumentError(absl::StrCat(item("textures", i), ".", parts.message()));
    }
    if (const auto* image = std::get_if<ImageTexture>(&textures[i])) {
      RETURN_IF_ERROR(check_image(item("textures", i), *image));
    }
  }
  return absl::OkStatus();
}

/// All values that a texture can take.
absl::Status check_values(const std::string& field, const std::vector<Texture>& textures,
                          TextureId id, float most) {
  const Texture& texture = textures[index_of(id)];
  if (const auto* constant = std::get_if<ConstantTexture>(&texture)) {
    return check_color(field, constant->value, most);
  }
  if (!std::holds_alternative<ImageTexture>(texture)) {
    const float found = max_value(textures, id);
    return found <= most
               ? absl::OkStatus()
               : invalid(field, absl::StrCat("must be in [0, ", most, "], reaches ", found));
  }
  const auto& image = std::get<ImageTexture>(texture);
  if (image.format != ImageTexture::Format::kFloat32) {
    return absl::OkStatus();  // Codes are in [0, 1] whatever they are.
  }
  for (std::size_t i = 0; i < image.texels.size() / sizeof(float); ++i) {
    float value;
    std::memcpy(&value, image.texels.data() + i * sizeof value, sizeof value);
    if (!(value >= 0 && value <= most) || !std::isfinite(value)) {
      return check_color(absl::StrCat(field, ": texel ", i / image.channels), gray(value), most);
    }
  }
  return absl::OkStatus();
}

absl::Status check_texture(const std::string& field, TextureId id,
                           const std::vector<Texture>& textures, float most) {
  RETURN_IF_ERROR(check_index(field, id, textures.size()));
  return check_values(field, textures, id, most);
}

absl::Status check_unit(const std::string& field, double value) {
  return value >= 0 && value <= 1 ? absl::OkStatus()
                                  : invalid(field, absl::StrCat("must be in [0, 1], is ", value));
}

absl::Status check_channel(const std::string& field, const Channel& channel,
                           const std::vector<Texture>& textures) {
  RETURN_IF_ERROR(check_unit(field + ".factor", channel.factor));
  return check_index(field + ".texture", channel.texture, textures.size());
}

absl::Status check_principled(const std::string& field, const Principled& m,
                              const std::vector<Texture>& textures) {
  RETURN_IF_ERROR(check_texture(field + ".base_color", m.base_color.texture, textures, 1));
  RETURN_IF_ERROR(check_color(field + ".base_color.factor", m.base_color.factor, 1));
  const auto infinite = static_cast<float>(kInfinity);
  RETURN_IF_ERROR(check_texture(field + ".emissive", m.emissive.texture, textures, infinite));
  RETURN_IF_ERROR(check_color(field + ".emissive.factor", m.emissive.factor, infinite));
  RETURN_IF_ERROR(check_channel(field + ".metallic", m.metallic, textures));
  RETURN_IF_ERROR(check_channel(field + ".roughness", m.roughness, textures));
  RETURN_IF_ERROR(check_channel(field + ".alpha", m.alpha, textures));
  RETURN_IF_ERROR(check_channel(field + ".coat", m.coat, textures));
  RETURN_IF_ERROR(check_channel(field + ".coat_roughness", m.coat_roughness, textures));
  RETURN_IF_ERROR(check_channel(field + ".transmission", m.transmission, textures));
  if (m.normal) {
    RETURN_IF_ERROR(check_index(field + ".normal", *m.normal, textures.size()));
  }
  if (!std::isfinite(m.normal_scale)) {
    return invalid(field + ".normal_scale", "must be finite");
  }
  if (!(m.alpha_cutoff >= 0)) {
    return invalid(field + ".alpha_cutoff", absl::StrCat("must be >= 0, is ", m.alpha_cutoff));
  }
  if (!(m.index_of_refraction >= 1 && m.index_of_refraction <= 5)) {
    return invalid(field + ".index_of_refraction",
                   absl::StrCat("must be in [1, 5], is ", m.index_of_refraction));
  }
  return absl::OkStatus();
}

absl::Status check_material(const std::string& field, const Material& material,
                            const std::vector<Texture>& textures) {
  if (const auto* diffuse = std::get_if<Diffuse>(&material)) {
    return check_texture(field + ".reflectance", diffuse->reflectance, textures, 1);
  }
  if (const auto* metal = std::get_if<Metal>(&material)) {
    if (!(metal->fuzz >= 0 && metal->fuzz <= 1)) {
      return invalid(field + ".fuzz", absl::StrCat("must be in [0, 1], is ", metal->fuzz));
    }
    return check_texture(field + ".reflectance", metal->reflectance, textures, 1);
  }
  if (const auto* glass = std::get_if<Dielectric>(&material)) {
    if (!(glass->index_of_refraction >= 1 && glass->index_of_refraction <= 5)) {
      return invalid(field + ".index_of_refraction",
                     absl::StrCat("must be in [1, 5], is ", glass->index_of_refraction));
    }
    return check_unit(field + ".roughness", glass->roughness);
  }
  if (const auto* principled = std::get_if<Principled>(&material)) {
    return check_principled(field, *principled, textures);
  }
  const auto& emissive = std::get<Emissive>(material);
  return check_texture(field + ".radiance", emissive.radiance, textures,
                       static_cast<float>(kInfinity));
}

absl::Status check_shapes(const Geometry& geometry, std::size_t materials) {
  for (std::size_t i = 0; i < geometry.spheres.size(); ++i) {
    const Sphere& sphere = geometry.spheres[i];
    const std::string field = item("spheres", i);
    RETURN_IF_ERROR(check_point(field + ".center", sphere.center));
    if (!(sphere.radius > 0)) {
      return invalid(field + ".radius", absl::StrCat("must be > 0, is ", sphere.radius));
    }
    RETURN_IF_ERROR(check_point(field + ".radius", {sphere.radius, 0, 0}));
    RETURN_IF_ERROR(check_index(field + ".material", sphere.material, materials));
  }
  for (std::size_t i = 0; i < geometry.quads.size(); ++i) {
    const Quad& quad = geometry.quads[i];
    const std::string field = item("quads", i);
    RETURN_IF_ERROR(check_point(field + ".corner", quad.corner));
    RETURN_IF_ERROR(check_point(field + ".u", quad.u));
    RETURN_IF_ERROR(check_point(field + ".v", quad.v));
    RETURN_IF_ERROR(check_index(field + ".material", quad.material, materials));
  }
  for (std::size_t i = 0; i < geometry.triangles.size(); ++i) {
    const Triangle& triangle = geometry.triangles[i];
    const std::string field = item("triangles", i);
    RETURN_IF_ERROR(check_point(field + ".a", triangle.a));
    RETURN_IF_ERROR(check_point(field + ".b", triangle.b));
    RETURN_IF_ERROR(check_point(field + ".c", triangle.c));
    RETURN_IF_ERROR(check_index(field + ".material", triangle.material, materials));
  }
  return absl::OkStatus();
}

absl::Status check_mesh(const std::string& field, const Mesh& mesh) {
  const std::size_t vertices = mesh.positions.size();
  if (!mesh.normals.empty() && mesh.normals.size() != vertices) {
    return invalid(field + ".normals", absl::StrCat("must be none or one a position (", vertices,
                                                    "), are ", mesh.normals.size()));
  }
  if (!mesh.uvs.empty() && mesh.uvs.size() != vertices) {
    return invalid(field + ".uvs", absl::StrCat("must be none or one a position (", vertices,
                                                "), are ", mesh.uvs.size()));
  }
  if (!mesh.uvs2.empty() && mesh.uvs2.size() != vertices) {
    return invalid(field + ".uvs2", absl::StrCat("must be none or one a position (", vertices,
                                                 "), are ", mesh.uvs2.size()));
  }
  if (!mesh.colors.empty() && mesh.colors.size() != vertices) {
    return invalid(field + ".colors", absl::StrCat("must be none or one a position (", vertices,
                                                   "), are ", mesh.colors.size()));
  }
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    for (const std::uint32_t index : mesh.triangles[i]) {
      if (index >= vertices) {
        return invalid(absl::StrCat(field, ".triangles[", i, "]"),
                       absl::StrCat("must be indices below ", vertices, ", one is ", index));
      }
    }
  }
  return absl::OkStatus();
}

absl::Status check_instance(const std::string& field, const Instance& instance,
                            const SceneDescription& scene) {
  RETURN_IF_ERROR(check_index(field + ".mesh", instance.mesh, scene.geometry.meshes.size()));
  RETURN_IF_ERROR(check_index(field + ".material", instance.material, scene.materials.size()));
  for (const auto& row : instance.to_world.m) {
    for (const double entry : row) {
      if (!(std::abs(entry) <= kMaxCoordinate)) {
        return invalid(field + ".to_world", absl::StrCat("entries must be within +-",
                                                         kMaxCoordinate, ", one is ", entry));
      }
    }
  }
  if (!inverse(instance.to_world)) {
    return invalid(field + ".to_world",
                   "must have an inverse (it scales by 0, or by too different factors)");
  }
  return absl::OkStatus();
}

}  // namespace

absl::Status validate(const SceneDescription& scene) {
  RETURN_IF_ERROR(check_camera(scene.camera));
  RETURN_IF_ERROR(validate(scene.filter));
  RETURN_IF_ERROR(check_local_shading(scene.local_shading));
  const auto infinite = static_cast<float>(kInfinity);
  RETURN_IF_ERROR(check_color("background.bottom", scene.background.bottom, infinite));
  RETURN_IF_ERROR(check_color("background.top", scene.background.top, infinite));
  RETURN_IF_ERROR(check_textures(scene.textures));
  for (std::size_t i = 0; i < scene.materials.size(); ++i) {
    RETURN_IF_ERROR(check_material(item("materials", i), scene.materials[i], scene.textures));
  }
  const Geometry& geometry = scene.geometry;
  RETURN_IF_ERROR(check_shapes(geometry, scene.materials.size()));
  for (std::size_t i = 0; i < geometry.meshes.size(); ++i) {
    RETURN_IF_ERROR(check_mesh(item("meshes", i), geometry.meshes[i]));
  }
  for (std::size_t i = 0; i < geometry.instances.size(); ++i) {
    RETURN_IF_ERROR(check_instance(item("instances", i), geometry.instances[i], scene));
  }
  return absl::OkStatus();
}

}  // namespace bandsaw
