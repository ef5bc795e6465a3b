#include "renderlib/scene/scene.h"

#include <algorithm>

#include "renderlib/base/status_macros.h"
#include "renderlib/material/opacity.h"
#include "renderlib/scene/clean.h"
#include "renderlib/scene/rest.h"
#include "renderlib/scene/sharing.h"
#include "renderlib/scene/validate.h"

namespace bandsaw {
namespace {

Needs needs_of(const SceneDescription& scene, const Lights& lights) {
  Needs needs;
  needs.lights = !lights.empty();
  needs.alpha = std::any_of(scene.materials.begin(), scene.materials.end(), has_alpha);
  needs.motion = moves(scene.geometry) || moves(scene.media.boundaries);
  needs.uv = std::any_of(scene.textures.begin(), scene.textures.end(), uses_uv);
  needs.media = scene.media.fog || scene.media.has_boundaries();
  return needs;
}

}  // namespace

absl::StatusOr<std::shared_ptr<const Scene>> Scene::build_with(const Kernel& kernel,
                                                               SceneDescription description,
                                                               Pool& pool, const Needs& forced,
                                                               Traversal traversal) {
  RETURN_IF_ERROR(validate(description));
  // Trees and lights point into the scene: it has its place before they are made.
  std::shared_ptr<Scene> scene(new Scene(kernel, std::move(description)));
  SceneDescription& own = scene->description_;
  scene->dropped_ = clean(own.geometry);
  const Shutter& shutter = shutter_of(own.camera);
  const Interval interval = {shutter.open, shutter.close};
  rest(interval, own.geometry);
  rest(interval, own.media.boundaries);
  prepare_surfaces(own.geometry);
  scene->accel_ = std::make_unique<Accel>(Accel::build(own.geometry, pool, interval, traversal));
  scene->lights_ =
      Lights(own.geometry, own.materials, own.textures, own.lights, own.background, interval);
  const Needs needs = needs_of(own, scene->lights_);
  scene->shares_paths_ = bandsaw::shares_paths(own, scene->lights_, needs);
  scene->needs_ = needs | forced;
  if (scene->needs_.media) {
    scene->boundary_accel_ =
        std::make_unique<Accel>(Accel::build(own.media.boundaries, pool, interval, traversal));
  }
  return std::shared_ptr<const Scene>(std::move(scene));
}

}  // namespace bandsaw
