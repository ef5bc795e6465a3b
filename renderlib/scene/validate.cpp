// Checks a description part by part; geometry, surfaces, lights and media have files of their own.

#include "renderlib/scene/validate.h"

#include <cmath>
#include <string>

#include "absl/strings/str_cat.h"
#include "renderlib/base/status_macros.h"
#include "renderlib/light/check_light_counts.h"
#include "renderlib/light/check_lights.h"
#include "renderlib/scene/validate_field.h"

namespace bandsaw {
namespace {

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

}  // namespace

absl::Status validate(const SceneDescription& scene, MeshVertices vertices,
                      const IsChecked& checked) {
  RETURN_IF_ERROR(check_camera(scene.camera));
  if (scene.camera_at_close) {
    RETURN_IF_ERROR(check_camera(*scene.camera_at_close));
    RETURN_IF_ERROR(validate_motion(scene.camera, *scene.camera_at_close));
  }
  RETURN_IF_ERROR(validate(scene.filter));
  RETURN_IF_ERROR(check_local_shading(scene.local_shading));
  const auto infinite = static_cast<float>(kInfinity);
  RETURN_IF_ERROR(check_color("background.bottom", scene.background.bottom, infinite));
  RETURN_IF_ERROR(check_color("background.top", scene.background.top, infinite));
  RETURN_IF_ERROR(check_surfaces(scene));
  RETURN_IF_ERROR(check_lights(scene.background, scene.textures, scene.lights));
  RETURN_IF_ERROR(check_geometry("", scene.geometry, scene.materials.size(), vertices, checked));
  RETURN_IF_ERROR(
      check_light_counts(scene.geometry, scene.materials, scene.textures, scene.lights.size()));
  return validate(scene.media);
}

}  // namespace bandsaw
