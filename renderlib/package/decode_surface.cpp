// Decodes these parts of a scene package: camera, filter, local shading (ambient light and the
// distance of ambient occlusion) and background. Only the form is checked here; validate() checks
// the values.

#include "renderlib/package/decode_surface.h"

#include "absl/strings/str_cat.h"
#include "renderlib/base/status_macros.h"
#include "renderlib/package/decode_enum.h"
#include "renderlib/package/lights.h"
#include "renderlib/package/manifest.h"

namespace bandsaw {
namespace {

template <class List>
absl::Status check_length(const List& list, int length, const std::string& field) {
  if (list.size() == length) {
    return absl::OkStatus();
  }
  return manifest_error(field, absl::StrCat("must have ", length, " numbers, has ", list.size()));
}

}  // namespace

absl::StatusOr<Vec3> decode_vec3(const google::protobuf::RepeatedField<double>& list,
                                 const std::string& field) {
  RETURN_IF_ERROR(check_length(list, 3, field));
  return Vec3{list[0], list[1], list[2]};
}

absl::StatusOr<Rgb> decode_rgb(const google::protobuf::RepeatedField<float>& list,
                               const std::string& field) {
  RETURN_IF_ERROR(check_length(list, 3, field));
  return Rgb{list[0], list[1], list[2]};
}

absl::StatusOr<Camera> decode_camera(const package::Camera& from, const std::string& field) {
  View view;
  ASSIGN_OR_RETURN(view.position, decode_vec3(from.position(), field + ".position"));
  ASSIGN_OR_RETURN(view.look_at, decode_vec3(from.look_at(), field + ".look_at"));
  ASSIGN_OR_RETURN(view.up, decode_vec3(from.up(), field + ".up"));
  const Shutter shutter = {from.shutter_open(), from.shutter_close()};
  std::optional<ImageWindow> window;
  if (from.window_size() != 0) {
    if (from.window_size() != 4) {
      return manifest_error(field + ".window", "must be 4 numbers");
    }
    window = {from.window(0), from.window(1), from.window(2), from.window(3)};
  }
  // The orthographic height of a perspective camera is 0.
  if (from.orthographic_height() != 0) {
    return Camera(OrthographicCamera{view.position, view.look_at, view.up,
                                     from.orthographic_height(), from.mirrored(), shutter, window});
  }
  PerspectiveCamera camera{.position = view.position, .look_at = view.look_at, .up = view.up};
  camera.shutter = shutter;
  camera.mirrored = from.mirrored();
  camera.window = window;
  camera.vertical_fov = from.vertical_fov();
  camera.aperture = from.aperture();
  camera.focus_distance = from.aperture() == 0 ? camera.focus_distance : from.focus_distance();
  return Camera(camera);
}

absl::StatusOr<PixelFilter> decode_filter(const package::Manifest& manifest) {
  PixelFilter filter;
  if (manifest.has_filter()) {
    ASSIGN_OR_RETURN(filter.kind, decode_enum<PixelFilter::Kind>(manifest.filter().kind(),
                                                                 /*last=*/3, "filter.kind"));
    filter.radius = manifest.filter().radius();
  }
  return filter;
}

absl::StatusOr<LocalShading> decode_local_shading(const package::Manifest& manifest) {
  LocalShading local;
  if (manifest.has_ambient()) {
    ASSIGN_OR_RETURN(local.ambient, decode_rgb(manifest.ambient().rgb(), "ambient.rgb"));
  }
  if (manifest.occlusion_distance() != 0) {
    local.occlusion_distance = manifest.occlusion_distance();
  }
  return local;
}

absl::StatusOr<Background> decode_background(const package::Manifest& manifest) {
  if (!manifest.has_background()) {
    return manifest_error("background", "is missing");
  }
  Background background;
  ASSIGN_OR_RETURN(background.bottom,
                   decode_rgb(manifest.background().bottom(), "background.bottom"));
  ASSIGN_OR_RETURN(background.top, decode_rgb(manifest.background().top(), "background.top"));
  if (manifest.background().has_environment()) {
    ASSIGN_OR_RETURN(background.environment,
                     decode_environment(manifest.background().environment()));
  }
  return background;
}

}  // namespace bandsaw
