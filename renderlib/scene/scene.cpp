#include "renderlib/scene/scene.h"

#include <algorithm>

#include "renderlib/base/status_macros.h"
#include "renderlib/material/bsdf.h"
#include "renderlib/material/ggx.h"
#include "renderlib/material/opacity.h"
#include "renderlib/scene/clean.h"
#include "renderlib/scene/rest.h"
#include "renderlib/scene/validate.h"

namespace bandsaw {
namespace {

bool is_specular(const Material& material) {
  const auto* metal = std::get_if<Metal>(&material);
  const auto* glass = std::get_if<Dielectric>(&material);
  return (glass != nullptr && glass->roughness * glass->roughness < kLeastAlpha) ||
         (metal != nullptr && metal->fuzz < kLeastFuzz);
}

bool is_nested(const Material& material) {
  const auto* glass = std::get_if<Dielectric>(&material);
  return glass != nullptr && glass->priority > 0;
}

bool has_normal_map(const Material& material) {
  const auto* principled = std::get_if<Principled>(&material);
  return principled != nullptr &&
         (principled->normal.has_value() || principled->coat_normal.has_value());
}

Needs needs_of(const SceneDescription& scene, const Lights& lights) {
  Needs needs;
  needs.lights = !lights.empty();
  needs.background = scene.background.environment || !is_black(scene.background.bottom) ||
                     !is_black(scene.background.top);
  needs.environment = scene.background.environment.has_value();
  needs.specular = std::any_of(scene.materials.begin(), scene.materials.end(), is_specular);
  needs.image_textures = std::any_of(
      scene.textures.begin(), scene.textures.end(),
      [](const Texture& texture) { return std::holds_alternative<ImageTexture>(texture); });
  const auto any = [&](bool (*holds)(const Material&)) {
    return std::any_of(scene.materials.begin(), scene.materials.end(), holds);
  };
  needs.alpha = any(has_alpha);
  needs.nested_glass = any(is_nested);
  needs.uv_directions = any(has_normal_map);
  needs.motion = moves(scene.geometry) || moves(scene.media.boundaries);
  needs.instances = !scene.geometry.instances.empty();
  needs.media = scene.media.fog || scene.media.has_boundaries();
  return needs;
}

}  // namespace

absl::StatusOr<std::shared_ptr<const Scene>> Scene::build(SceneDescription description,
                                                          Pool& pool) {
  RETURN_IF_ERROR(validate(description));
  // Trees and lights point into the scene: it has its place before they are made.
  std::shared_ptr<Scene> scene(new Scene(std::move(description)));
  SceneDescription& own = scene->description_;
  scene->dropped_ = clean(own.geometry);
  const Shutter& shutter = shutter_of(own.camera);
  const Interval interval = {shutter.open, shutter.close};
  rest(interval, own.geometry);
  rest(interval, own.media.boundaries);
  scene->accel_ = std::make_unique<Accel>(Accel::build(own.geometry, pool, interval));
  scene->lights_ = Lights(own.geometry, own.materials, own.textures, own.lights, own.background,
                          interval);
  scene->needs_ = needs_of(own, scene->lights_);
  if (scene->needs_.media) {
    scene->boundary_accel_ =
        std::make_unique<Accel>(Accel::build(own.media.boundaries, pool, interval));
  }
  return std::shared_ptr<const Scene>(std::move(scene));
}

}  // namespace bandsaw
