// Reads the settings of a scene file that are not shapes, materials, lights or media: one function
// for each.

#include "renderlib/import/scene_file/read_view.h"

#include <algorithm>
#include <utility>

#include "absl/status/statusor.h"
#include "absl/strings/str_cat.h"
#include "proto/scene.pb.h"
#include "renderlib/base/status_macros.h"
#include "renderlib/import/draft/color_limits.h"
#include "renderlib/import/draft/environment_image.h"
#include "renderlib/import/draft/named_file.h"
#include "renderlib/import/draft/scene_draft.h"
#include "renderlib/import/image/decode_image.h"
#include "renderlib/import/scene_file/field.h"
#include "renderlib/import/scene_file/numbers.h"
#include "renderlib/import/scene_file/read_rotation.h"
#include "renderlib/math/transform.h"
#include "renderlib/render/settings.h"

namespace bandsaw {

namespace {

/// Reads the image file `file`, which the field `name` of `in` gives, as an image of an environment
/// map.
absl::StatusOr<TextureId> read_image(const Field& in, const std::string& name,
                                     const std::string& file, SceneDraft& draft) {
  if (file.empty()) {
    return in.error(name, "is required: the name of an image file");
  }
  const auto found = find_named_file(file, draft);
  if (!found.ok()) {
    return in.error(name, found.status().message());
  }
  const auto bytes = found->read(kMaxImageFileBytes);
  if (!bytes.ok()) {
    return in.error(name, bytes.status().message());
  }
  auto image = add_environment_image(*bytes, file, draft);
  return image.ok() ? image : in.error(name, image.status().message());
}

/// Reads strength and rotation of an environment map.
template <class Message>
absl::Status read_placement(const Field& in, const Message& from, Environment& to) {
  constexpr double kMaxStrength = 1e6;
  const double strength = from.has_strength() ? from.strength() : 1;
  RETURN_IF_ERROR(check_range(in, "strength", strength, 0, kMaxStrength));
  to.strength = static_cast<float>(strength);
  ASSIGN_OR_RETURN(const Transform turn, read_rotation(in, from.rotate()));
  to.axes = {turn.direction({1, 0, 0}), turn.direction({0, 1, 0}), turn.direction({0, 0, 1})};
  return absl::OkStatus();
}

/// Reads the environment map `in`, and adds the texels of its image to the draft. Returns
/// INVALID_ARGUMENT if a field or the file is invalid.
absl::StatusOr<Environment> read_environment(const Field& in, const scene::EnvironmentMap& from,
                                             SceneDraft& draft) {
  Environment to;
  RETURN_IF_ERROR(read_placement(in, from, to));
  ASSIGN_OR_RETURN(const TextureId image, read_image(in, "file", from.file(), draft));
  to.images = {image};
  return to;
}

/// Reads the cube map `in`, and adds the texels of its six images to the draft. A left-handed cube
/// map has its x axis reversed. Returns INVALID_ARGUMENT if a field or a file is invalid.
absl::StatusOr<Environment> read_cube_map(const Field& in, const scene::CubeMap& from,
                                          SceneDraft& draft) {
  Environment to;
  to.kind = Environment::Kind::kCube;
  RETURN_IF_ERROR(read_placement(in, from, to));
  to.axes.x = from.left_handed() ? -to.axes.x : to.axes.x;
  for (const auto& [name, file] :
       {std::pair("positive_x", from.positive_x()), std::pair("negative_x", from.negative_x()),
        std::pair("positive_y", from.positive_y()), std::pair("negative_y", from.negative_y()),
        std::pair("positive_z", from.positive_z()), std::pair("negative_z", from.negative_z())}) {
    ASSIGN_OR_RETURN(const TextureId id, read_image(in, name, file, draft));
    to.images.push_back(id);
    const auto& image = std::get<ImageTexture>(draft.textures[id]);
    const auto& first = std::get<ImageTexture>(draft.textures[to.images.front()]);
    if (image.width != image.height || image.width != first.width) {
      return in.error(name, absl::StrCat("images of a cube map must be square and of one size; \"",
                                         file, "\" is ", image.width, " x ", image.height));
    }
  }
  return to;
}

/// Sets the direction of `view` by the field `rotate` of the camera, and returns the view. The
/// position of `view` MUST be set. An unrotated camera looks along -z, and y is up.
absl::StatusOr<View> read_turned(const Field& in, const scene::Camera& from, View view) {
  if (!from.look_at().empty() || !from.up().empty()) {
    return in.error("rotate", "write rotate, or look_at and up, not both");
  }
  ASSIGN_OR_RETURN(const Transform turn, read_rotation(in, from.rotate()));
  // The distance of the point look_at is at least the largest coordinate of the position. So the
  // sum of position and direction keeps the precision of the direction.
  const double ahead = std::max(1.0, max_abs(view.position));
  view.look_at = view.position + turn.direction({0, 0, -1}) * ahead;
  view.up = turn.direction({0, 1, 0});
  return view;
}

absl::StatusOr<View> read_view(const Field& in, const scene::Camera& from) {
  View view;
  ASSIGN_OR_RETURN(view.position, read_vec3(in, "position", from.position(), Vec3{0, 0, 0}));
  if (from.rotate_size() > 0) {
    return read_turned(in, from, view);
  }
  ASSIGN_OR_RETURN(view.look_at, read_vec3(in, "look_at", from.look_at()));
  ASSIGN_OR_RETURN(view.up, read_vec3(in, "up", from.up(), Vec3{0, 1, 0}));
  if (view.look_at == view.position) {
    return in.error("look_at", "must differ from position");
  }
  if (!(length_squared(view.up) > 0)) {
    return in.error("up", "must not be zero");
  }
  const Vec3 ahead = normalize(view.look_at - view.position);
  // The sine of the angle between the view direction and up must be above 1e-12.
  if (!(length_squared(cross(ahead, normalize(view.up))) > 1e-24)) {
    return in.error("up", from.up().empty()
                              ? "is [0, 1, 0] unless written, and the camera looks along it; write "
                                "another, for example [0, 0, 1]"
                              : "must not be parallel to the view direction");
  }
  return view;
}

absl::StatusOr<Camera> read_perspective(const Field& in, const scene::Camera& from,
                                        const View& view) {
  PerspectiveCamera camera{.position = view.position, .look_at = view.look_at, .up = view.up};
  camera.vertical_fov = from.has_vertical_fov() ? from.vertical_fov() : camera.vertical_fov;
  if (!(camera.vertical_fov > 0 && camera.vertical_fov < 180)) {
    return in.error("vertical_fov",
                    absl::StrCat("must lie in (0, 180) degrees, is ", camera.vertical_fov));
  }
  camera.aperture = from.aperture();
  RETURN_IF_ERROR(check_range(in, "aperture", camera.aperture, 0, kMaxLens));
  if (from.has_focus_distance()) {
    camera.focus_distance = from.focus_distance();
    RETURN_IF_ERROR(check_range(in, "focus_distance", camera.focus_distance, kMinFocus, kMaxLens));
  } else if (camera.aperture > 0) {
    if (from.rotate_size() > 0) {
      return in.error("focus_distance", "is required if rotate is written instead of look_at");
    }
    camera.focus_distance = length(view.look_at - view.position);
  }
  return Camera(camera);
}

absl::StatusOr<Camera> read_orthographic(const Field& in, const scene::Camera& from,
                                         const View& view) {
  for (const char* name : {"vertical_fov", "aperture", "focus_distance"}) {
    if (in.has(name)) {
      return in.error(name, "is of a perspective camera; this one is orthographic");
    }
  }
  const Field orthographic = in.child("orthographic");
  const double height = from.orthographic().height();
  if (!from.orthographic().has_height()) {
    return orthographic.error("height",
                              "is required; it is the height of the image in scene units");
  }
  if (!(height > 0 && height <= kMaxLens)) {
    return orthographic.error("height", absl::StrCat("must be > 0, at most 1e30, is ", height));
  }
  return Camera(OrthographicCamera{view.position, view.look_at, view.up, height,
                                   from.orthographic().mirrored()});
}

absl::StatusOr<std::optional<ImageWindow>> read_window(const Field& in, const Numbers& list) {
  if (list.empty()) {
    return std::nullopt;
  }
  if (list.size() != 4) {
    return in.error(
        "window", absl::StrCat("must be 4 numbers, [left, right, bottom, top], has ", list.size()));
  }
  return ImageWindow{list[0], list[1], list[2], list[3]};
}

}  // namespace

absl::Status set_window(const Field& in, const scene::Camera& from, Camera& camera) {
  ASSIGN_OR_RETURN(const auto window, read_window(in, from.window()));
  std::visit(
      [&](auto& c) {
        c.window = window;
        c.mirrored = c.mirrored != from.mirrored();
      },
      camera);
  const absl::Status valid = validate(camera);
  return valid.ok() ? valid : in.error(valid.message());
}

absl::StatusOr<double> read_fps(const Field& root, const scene::Scene& from) {
  constexpr double kDefault = 24;
  const double fps = from.has_fps() ? from.fps() : kDefault;
  RETURN_IF_ERROR(check_range(root, "fps", fps, 0.01, 10'000));
  return fps;
}

absl::StatusOr<Shutter> read_shutter(const Field& root, const scene::Scene& from, double time) {
  const Shutter shutter = {from.camera().shutter_open(), from.camera().shutter_close()};
  const Shutter at_frame = {time + shutter.open, time + shutter.close};
  if (!from.has_camera()) {
    return at_frame;
  }
  const Field in = root.child("camera");
  RETURN_IF_ERROR(check_range(in, "shutter_open", shutter.open, -kMaxTime, kMaxTime));
  RETURN_IF_ERROR(check_range(in, "shutter_close", shutter.close, -kMaxTime, kMaxTime));
  if (shutter.close < shutter.open) {
    return in.error("shutter_close",
                    absl::StrCat("must not be before ", shutter.open,
                                 ", the value of shutter_open; it is ", shutter.close));
  }
  return at_frame;
}

absl::StatusOr<Camera> read_camera(const Field& root, const scene::Scene& from,
                                   const Shutter& shutter) {
  const Field in = root.child("camera");
  ASSIGN_OR_RETURN(const View view, read_view(in, from.camera()));
  ASSIGN_OR_RETURN(Camera camera, from.camera().has_orthographic()
                                      ? read_orthographic(in, from.camera(), view)
                                      : read_perspective(in, from.camera(), view));
  std::visit([&](auto& c) { c.shutter = shutter; }, camera);
  RETURN_IF_ERROR(set_window(in, from.camera(), camera));
  return camera;
}

absl::StatusOr<PixelFilter> read_filter(const Field& root, const scene::Scene& from) {
  if (!from.image().has_filter()) {
    return PixelFilter{};
  }
  using Kind = PixelFilter::Kind;
  const Field in = root.child("image").child("filter");
  const scene::PixelFilter& written = from.image().filter();
  const auto read = [&](Kind kind, const char* name,
                        const scene::FilterSize& size) -> absl::StatusOr<PixelFilter> {
    const PixelFilter filter{kind, size.has_radius() ? size.radius() : default_radius(kind)};
    RETURN_IF_ERROR(check_range(in.child(name), "radius", filter.radius, 0, kMaxFilterRadius));
    return filter;
  };
  switch (written.kind_case()) {
    case scene::PixelFilter::kBox:
      return read(Kind::kBox, "box", written.box());
    case scene::PixelFilter::kTent:
      return read(Kind::kTent, "tent", written.tent());
    case scene::PixelFilter::kGaussian:
      return read(Kind::kGaussian, "gaussian", written.gaussian());
    case scene::PixelFilter::KIND_NOT_SET:
      break;
  }
  return in.error("is empty: write box, tent or gaussian");
}

absl::Status read_settings(const Field& root, const scene::Scene& from, PackageInfo& info) {
  if (from.has_image()) {
    const Field image = root.child("image");
    info.width = from.image().has_width() ? from.image().width() : info.width;
    info.height = from.image().has_height() ? from.image().height() : info.height;
    RETURN_IF_ERROR(check_range(image, "width", info.width, 1, kMaxSide));
    RETURN_IF_ERROR(check_range(image, "height", info.height, 1, kMaxSide));
    if (std::uint64_t{info.width} * info.height > kMaxPixels) {
      return image.error(absl::StrCat("has ", std::uint64_t{info.width} * info.height,
                                      " pixels, at most ", kMaxPixels, " are allowed"));
    }
  }
  // The enums of PackageInfo count from 0. Those of the file have the same order, but their 0 means
  // "unspecified".
  if (from.integrator().kind() != scene::Integrator::KIND_UNSPECIFIED) {
    info.integrator = static_cast<Integrator>(static_cast<int>(from.integrator().kind()) - 1);
  }
  if (from.image().tone() != scene::Image::TONE_UNSPECIFIED) {
    info.display.tone = static_cast<Tone>(static_cast<int>(from.image().tone()) - 1);
  }
  info.display.exposure = from.image().exposure();
  RETURN_IF_ERROR(check_range(root.child("image"), "exposure", info.display.exposure, -kMaxExposure,
                              kMaxExposure));
  if (from.integrator().has_max_depth()) {
    info.max_depth = from.integrator().max_depth();
    RETURN_IF_ERROR(
        check_range(root.child("integrator"), "max_depth", info.max_depth, 1, kMaxDepth));
  }
  return absl::OkStatus();
}

absl::StatusOr<LocalShading> read_local_shading(const Field& root, const scene::Scene& from) {
  LocalShading local;
  const Field in = root.child("integrator");
  if (from.integrator().has_ambient()) {
    ASSIGN_OR_RETURN(local.ambient,
                     read_color(in.child("ambient"), from.integrator().ambient(), kMaxRadiance));
  }
  if (from.integrator().has_occlusion_distance()) {
    local.occlusion_distance = from.integrator().occlusion_distance();
    if (!(local.occlusion_distance > 0)) {
      return in.error("occlusion_distance",
                      absl::StrCat("must be > 0, is ", local.occlusion_distance));
    }
  }
  return local;
}

absl::StatusOr<Background> read_background(const Field& root, const scene::Scene& from,
                                           SceneDraft& draft) {
  const Field in = root.child("background");
  switch (from.background().kind_case()) {
    case scene::Background::kConstant: {
      ASSIGN_OR_RETURN(const Rgb radiance, read_color(in.child("constant"),
                                                      from.background().constant(), kMaxRadiance));
      return Background{radiance, radiance};
    }
    case scene::Background::kGradient: {
      const Field gradient = in.child("gradient");
      const scene::Gradient& of = from.background().gradient();
      if (!of.has_bottom() || !of.has_top()) {
        return gradient.error("needs bottom and top");
      }
      Background background;
      ASSIGN_OR_RETURN(background.bottom,
                       read_color(gradient.child("bottom"), of.bottom(), kMaxRadiance));
      ASSIGN_OR_RETURN(background.top, read_color(gradient.child("top"), of.top(), kMaxRadiance));
      return background;
    }
    case scene::Background::kEnvironment: {
      Background background;
      ASSIGN_OR_RETURN(
          background.environment,
          read_environment(in.child("environment"), from.background().environment(), draft));
      return background;
    }
    case scene::Background::kCubeMap: {
      Background background;
      ASSIGN_OR_RETURN(background.environment,
                       read_cube_map(in.child("cube_map"), from.background().cube_map(), draft));
      return background;
    }
    case scene::Background::KIND_NOT_SET:
      break;
  }
  return in.error("is empty: write constant, gradient, environment or cube_map");
}

}  // namespace bandsaw
