// Converts the image settings of a pbrt scene: film, filter, integrator and camera in this order,
// because the camera's field of view depends on the film's shape.

#include "renderlib/import/pbrt/view.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "absl/strings/str_cat.h"
#include "renderlib/base/status_macros.h"
#include "renderlib/math/constants.h"
#include "renderlib/math/elementary.h"

namespace bandsaw::pbrt {
namespace {

/// The image in pixels, and the part of it that is rendered.
struct Film {
  double width = 1280;
  double height = 720;
  double crop[4] = {0, 1, 0, 1};  ///< x0, x1, y0, y1, shares of the whole, y from the top
};

/// Reads the film. Also sets Builder::light_factor, by which all light is multiplied: the exposure
/// time in seconds times ISO / 100.
absl::StatusOr<Film> read_film(const ViewSource& view, double exposure_time, Builder& builder) {
  Film film;
  Parameters none;
  const Parameters& in = view.film ? view.film->second : none;
  ASSIGN_OR_RETURN(const int width, in.integer("xresolution", 1280));
  ASSIGN_OR_RETURN(const int height, in.integer("yresolution", 720));
  if (width < 1 || height < 1 || width > 65536 || height > 65536) {
    return error_at(
        in.place, absl::StrCat("the resolution must be in [1, 65536], is ", width, " x ", height));
  }
  film.width = width;
  film.height = height;
  ASSIGN_OR_RETURN(const auto crop, in.numbers("cropwindow", {"float"}, 4));
  ASSIGN_OR_RETURN(const auto pixels, in.numbers("pixelbounds", {"integer", "float"}, 4));
  const double sizes[2] = {film.width, film.height};
  for (std::size_t k = 0; k < 4; ++k) {
    const double size = sizes[k / 2];
    const double share = !pixels.empty() ? pixels[k] / size
                         : !crop.empty() ? crop[k]
                                         : film.crop[k];
    film.crop[k] = std::clamp(std::ceil(share * size), 0.0, size) / size;
  }
  if (!(film.crop[0] < film.crop[1] && film.crop[2] < film.crop[3])) {
    return error_at(in.place, "the crop window is empty");
  }
  ASSIGN_OR_RETURN(const double iso, in.number("iso", 100));
  ASSIGN_OR_RETURN(const std::string sensor, in.text("sensor", "cie1931"));
  ASSIGN_OR_RETURN(const double white, in.number("whitebalance", 0));
  builder.light_factor = std::clamp(exposure_time * iso / 100, 0.0, 1e12);
  if (sensor != "cie1931") {
    builder.warn(in.place,
                 absl::StrCat("the sensor \"", sensor,
                              "\" is not known here; the sensor cie1931 is used instead"));
  }
  if (white != 0 && white != 6500 && white != 6504) {
    builder.warn(in.place, "the white balance is left out: white is D65");
  }
  in.ignore({"filename", "savefp16", "maxcomponentvalue", "diagonal", "coordinatesystem",
             "lambdamin", "lambdamax", "nbuckets"});
  return film;
}

absl::Status read_filter(const ViewSource& view, Builder& builder) {
  Parameters none;
  const Parameters& in = view.filter ? view.filter->second : none;
  const std::string type = view.filter ? view.filter->first : "gaussian";
  const double default_radius = type == "box"        ? 0.5
                                : type == "gaussian" ? 1.5
                                : type == "sinc"     ? 4
                                                     : 2;
  ASSIGN_OR_RETURN(const double x, in.number("xradius", default_radius));
  ASSIGN_OR_RETURN(const double y, in.number("yradius", default_radius));
  double radius = std::clamp((x + y) / 2, 0.0, 16.0);
  if (x != y) {
    builder.warn(in.place, "the filter has the mean of both radii");
  }
  auto* filter = builder.out.mutable_image()->mutable_filter();
  if (type == "box") {
    filter->mutable_box()->set_radius(radius);
  } else if (type == "triangle") {
    filter->mutable_tent()->set_radius(radius);
  } else {
    if (type == "gaussian") {
      ASSIGN_OR_RETURN(const double sigma, in.number("sigma", 0.5));
      radius = std::clamp(3 * sigma, 0.0, 16.0);  // PixelFilter's Gaussian ends at 3 sigma
    } else {
      builder.warn(in.place, absl::StrCat("the filter \"", type,
                                          "\" has no counterpart; a Gaussian stands for it"));
      radius = type == "mitchell" ? radius * 0.75 : 1.5;
      in.ignore({"B", "C", "tau"});
    }
    filter->mutable_gaussian()->set_radius(radius);
  }
  return absl::OkStatus();
}

absl::Status read_integrator(const ViewSource& view, Builder& builder) {
  Parameters none;
  const Parameters& in = view.integrator ? view.integrator->second : none;
  const std::string type = view.integrator ? view.integrator->first : "volpath";
  scene::Integrator& out = *builder.out.mutable_integrator();
  ASSIGN_OR_RETURN(const int depth, in.integer("maxdepth", 5));
  out.set_max_depth(static_cast<std::uint32_t>(std::clamp(depth, 1, 1024)));
  if (type == "ambientocclusion") {
    out.set_kind(scene::Integrator::KIND_AMBIENT_OCCLUSION);
    ASSIGN_OR_RETURN(const auto distance, in.number("maxdistance"));
    if (distance && *distance > 0) {
      out.set_occlusion_distance(*distance);
    }
  }
  // The parameters of all other integrators are ignored, because these integrators compute the same
  // image in other ways.
  for (const Parameter& parameter : in.list) {
    parameter.is_used = true;
  }
  return absl::OkStatus();
}

/// The position and the axes of the camera at one time, in the world.
struct CameraPlace {
  Vec3 position;
  Vec3 ahead;       ///< unit
  Vec3 up;          ///< unit
  double unit = 1;  ///< the camera's unit of length
  bool is_mirrored = false;
  bool is_stretched = false;
};

CameraPlace place_of(const Transform& to_world) {
  const Vec3 right = to_world.direction({1, 0, 0});
  const Vec3 up = to_world.direction({0, 1, 0});
  const Vec3 forward = to_world.direction({0, 0, 1});
  CameraPlace place;
  place.unit = length(forward);
  place.position = to_world.point({0, 0, 0});
  place.ahead = forward / place.unit;
  place.up = up / length(up);
  // The axes of pbrt's camera are left-handed: if pbrt does not mirror the image, right is
  // cross(up, forward). Such a camera is mirrored in Bandsaw, whose axes are right-handed.
  place.is_mirrored = dot(cross(forward, up), right) < 0;
  const double limit = 1e-3 * place.unit;
  place.is_stretched = std::abs(length(up) - place.unit) > limit ||
                       std::abs(length(right) - place.unit) > limit ||
                       std::abs(dot(up, forward)) > limit * place.unit ||
                       std::abs(dot(right, up)) > limit * place.unit;
  return place;
}

void add_track(const char* field, const Vec3& first, const Vec3& second, Builder& builder) {
  scene::Track& track = *builder.out.add_track();
  track.set_field(field);
  const std::pair<double, Vec3> keys[] = {{builder.start_time, first}, {builder.end_time, second}};
  for (const auto& [time, value] : keys) {
    scene::TrackKey& key = *track.add_key();
    key.set_time(time);
    set_vec3(value, key.mutable_value());
  }
}

/// Sets position and direction by the camera's axes in the world, at both times if it moves.
/// Returns the camera's unit of length in the world.
absl::StatusOr<double> set_place(const ViewSource& view, Builder& builder) {
  const Place& written = view.camera ? view.camera->second.place : view.medium_place;
  CameraPlace places[2];
  for (std::size_t k = 0; k < 2; ++k) {
    const auto to_world = inverse(view.to_camera[k]);
    if (!to_world) {
      return error_at(written, "the camera's transformation is singular");
    }
    places[k] = place_of(*to_world);
  }
  const auto& [first, second] = places;
  if (first.is_stretched || second.is_stretched) {
    builder.warn(written, "the camera's transformation stretches or shears; its direction is kept");
  }
  scene::Camera& camera = *builder.out.mutable_camera();
  // The point `look_at` is so far ahead that the sum of position and direction keeps the precision
  // of the direction.
  const double ahead = std::max({1.0, max_abs(first.position), max_abs(second.position)});
  set_vec3(first.position, camera.mutable_position());
  set_vec3(first.position + first.ahead * ahead, camera.mutable_look_at());
  set_vec3(first.up, camera.mutable_up());
  camera.set_mirrored(first.is_mirrored);
  if (view.to_camera[0] == view.to_camera[1]) {
    return first.unit;
  }
  if (first.is_mirrored != second.is_mirrored || !(builder.start_time < builder.end_time)) {
    builder.warn(written, "the camera does not move: its motion mirrors it or has no duration");
    return first.unit;
  }
  builder.has_motion = true;
  add_track("camera.position", first.position, second.position, builder);
  add_track("camera.look_at", first.position + first.ahead * ahead,
            second.position + second.ahead * ahead, builder);
  add_track("camera.up", first.up, second.up, builder);
  return first.unit;
}

/// Returns x0, x1, y0, y1 of the whole image in pbrt's screen space, in which the shorter side is
/// [-1, 1] by default.
absl::StatusOr<std::vector<double>> read_screen(const Parameters& in, double aspect) {
  ASSIGN_OR_RETURN(std::vector<double> screen, in.numbers("screenwindow", {"float"}, 4));
  ASSIGN_OR_RETURN(const double frame, in.number("frameaspectratio", aspect));
  if (screen.empty()) {
    screen = frame > 1 ? std::vector<double>{-frame, frame, -1, 1}
                       : std::vector<double>{-1, 1, -1 / frame, 1 / frame};
  }
  if (screen.size() != 4 || !(screen[0] < screen[1] && screen[2] < screen[3])) {
    return error_at(in.place, "\"screenwindow\" must be 4 numbers, x0 < x1 and y0 < y1");
  }
  return screen;
}

/// Sets the camera, and the size of the rendered part of the image. If this part is not the whole
/// image, if the screen window is off centre, or if the pixels are not square, the camera gets a
/// window in screen space.
absl::Status read_camera(const ViewSource& view, const Film& film, Builder& builder) {
  Parameters none;
  const Parameters& in = view.camera ? view.camera->second : none;
  const std::string type = view.camera ? view.camera->first : "perspective";
  ASSIGN_OR_RETURN(const double unit, set_place(view, builder));
  scene::Camera& camera = *builder.out.mutable_camera();
  ASSIGN_OR_RETURN(const std::vector<double> screen, read_screen(in, film.width / film.height));
  const bool is_whole =
      film.crop[0] == 0 && film.crop[1] == 1 && film.crop[2] == 0 && film.crop[3] == 1;
  ASSIGN_OR_RETURN(double fov, in.number("fov", 90));
  ASSIGN_OR_RETURN(const double lens, in.number("lensradius", 0));
  ASSIGN_OR_RETURN(const double focus, in.number("focaldistance", 1e6));
  if (type != "perspective" && type != "orthographic") {
    builder.warn(in.place, absl::StrCat("the camera \"", type,
                                        "\" has no counterpart; a perspective camera of 60 "
                                        "degrees stands for it"));
    fov = 60;
    for (const Parameter& parameter : in.list) {
      parameter.is_used = true;
    }
  }
  if (!(fov > 0 && fov < 180)) {
    return error_at(in.place, absl::StrCat("\"fov\" must be in (0, 180), is ", fov));
  }
  const bool is_flat = type == "orthographic";
  // Without a window, Bandsaw's camera shows the whole height with square pixels.
  const double aspect = film.width / film.height;
  const bool is_square =
      std::abs((screen[1] - screen[0]) / (screen[3] - screen[2]) - aspect) < 1e-9 * aspect &&
      screen[0] == -screen[1] && screen[2] == -screen[3];
  // Half of the height that the camera would show without a window, in screen space. It is 1 if
  // there is a window, so that the window's edges are in screen space too.
  const double half = is_square && is_whole ? screen[3] : 1;
  if (is_flat) {
    camera.mutable_orthographic()->set_height(2 * half * unit);
    in.ignore({"lensradius", "focaldistance"});
    if (lens > 0) {
      builder.warn(in.place, "an orthographic camera has no lens");
    }
  } else {
    camera.set_vertical_fov(2 * atan2(tan_degrees(fov / 2) * half, 1) * 180 / kPi);
    if (lens > 0) {
      camera.set_aperture(std::min(2 * lens * unit, 1e30));
      camera.set_focus_distance(std::clamp(focus * unit, 1e-9, 1e30));
    }
  }
  if (!(is_square && is_whole)) {
    const double w = screen[1] - screen[0];
    const double h = screen[3] - screen[2];
    camera.add_window(screen[0] + film.crop[0] * w);
    camera.add_window(screen[0] + film.crop[1] * w);
    camera.add_window(screen[3] - film.crop[3] * h);
    camera.add_window(screen[3] - film.crop[2] * h);
  }
  auto* image = builder.out.mutable_image();
  const auto pixels = [](double size, double share) {
    return static_cast<std::uint32_t>(std::max(1.0, std::round(size * share)));
  };
  image->set_width(pixels(film.width, film.crop[1] - film.crop[0]));
  image->set_height(pixels(film.height, film.crop[3] - film.crop[2]));
  builder.warn_of_unused(in);
  return absl::OkStatus();
}

}  // namespace

absl::Status set_view(const ViewSource& view, Builder& builder) {
  Parameters none;
  const Parameters& camera = view.camera ? view.camera->second : none;
  ASSIGN_OR_RETURN(const double open, camera.number("shutteropen", 0));
  ASSIGN_OR_RETURN(const double close, camera.number("shutterclose", 1));
  if (!(open <= close && std::abs(open) <= 1e9 && std::abs(close) <= 1e9)) {
    return error_at(camera.place, "the shutter must close after it opens");
  }
  ASSIGN_OR_RETURN(const Film film, read_film(view, close > open ? close - open : 1, builder));
  if (view.film) {
    builder.warn_of_unused(view.film->second);
  }
  RETURN_IF_ERROR(read_filter(view, builder));
  RETURN_IF_ERROR(read_integrator(view, builder));
  RETURN_IF_ERROR(read_camera(view, film, builder));
  builder.out.mutable_camera()->set_shutter_open(open);
  builder.out.mutable_camera()->set_shutter_close(close);
  return absl::OkStatus();
}

}  // namespace bandsaw::pbrt
