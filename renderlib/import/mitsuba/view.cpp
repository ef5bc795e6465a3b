// Converts the sensor and the integrator of a Mitsuba scene. The film of the sensor is read first,
// because the camera's field of view depends on the film's aspect ratio.

#include "renderlib/import/mitsuba/view.h"

#include <algorithm>
#include <cmath>
#include <string_view>

#include "absl/strings/str_cat.h"
#include "renderlib/base/status_macros.h"
#include "renderlib/import/mitsuba/field_of_view.h"
#include "renderlib/import/mitsuba/frame.h"

namespace bandsaw::mitsuba {
namespace {

constexpr std::int64_t kMaxSide = 65536;
constexpr std::int64_t kMaxDepth = 1024;

/// Appends x, y and z.
void set(const Vec3& v, google::protobuf::RepeatedField<double>* to) {
  to->Add(v.x);
  to->Add(v.y);
  to->Add(v.z);
}

/// The size of a film and the part of it that is rendered (crop), in pixels from the top left
/// corner.
struct Film {
  std::int64_t width = 768;
  std::int64_t height = 576;
  std::int64_t crop_x = 0;
  std::int64_t crop_y = 0;
  std::int64_t crop_width = 768;
  std::int64_t crop_height = 576;
  double aspect() const { return static_cast<double>(width) / static_cast<double>(height); }
};

/// Converts the reconstruction filter of a film. Any type except box and tent becomes a Gaussian.
absl::Status read_filter(const Object& filter, scene::Image& image, Conversion& to) {
  const Parameters from(filter);
  if (filter.type == "box") {
    ASSIGN_OR_RETURN(const double radius, from.number("radius", 0.5));
    image.mutable_filter()->mutable_box()->set_radius(std::clamp(radius, 0.0, 16.0));
  } else if (filter.type == "tent") {
    ASSIGN_OR_RETURN(const double radius, from.number("radius", 1));
    image.mutable_filter()->mutable_tent()->set_radius(std::clamp(radius, 0.0, 16.0));
  } else {
    if (filter.type != "gaussian") {
      constexpr std::string_view kWithNegativeLobes[] = {"mitchell", "catmullrom", "lanczos"};
      const bool is_known = std::ranges::count(kWithNegativeLobes, filter.type) > 0;
      to.warn(filter.place, absl::StrCat("filter \"", filter.type,
                                         is_known ? "\" has negative lobes" : "\" is not known",
                                         "; a gaussian stands in its place"));
      from.ignore({"a", "b", "B", "C", "lobes", "radius"});
    }
    ASSIGN_OR_RETURN(const double deviation, from.number("stddev", 0.5));
    // Bandsaw's Gaussian filter ends at three standard deviations.
    image.mutable_filter()->mutable_gaussian()->set_radius(std::clamp(3 * deviation, 0.0, 16.0));
  }
  to.warn_of_unused(from);
  return absl::OkStatus();
}

/// Returns the width or height `name` in pixels; `otherwise` if it is absent.
absl::StatusOr<std::int64_t> side_of(const Parameters& from, const char* name,
                                     std::int64_t otherwise) {
  ASSIGN_OR_RETURN(const std::int64_t side, from.integer(name, otherwise));
  if (side < 1 || side > kMaxSide) {
    return error_at(from.place(), absl::StrCat(name, " must be in [1, ", kMaxSide, "], is ", side));
  }
  return side;
}

/// Reads the sensor's film. Sets the size and the filter of `image`.
absl::StatusOr<Film> read_film(const Parameters& sensor, scene::Image& image, Conversion& to) {
  Film film;
  image.mutable_filter()->mutable_gaussian()->set_radius(1.5);  // Mitsuba's default
  const auto films = sensor.objects("film");
  if (!films.empty()) {
    const Parameters from(*object_in(*films.back()));
    ASSIGN_OR_RETURN(film.width, side_of(from, "width", film.width));
    ASSIGN_OR_RETURN(film.height, side_of(from, "height", film.height));
    ASSIGN_OR_RETURN(film.crop_width, side_of(from, "crop_width", film.width));
    ASSIGN_OR_RETURN(film.crop_height, side_of(from, "crop_height", film.height));
    ASSIGN_OR_RETURN(film.crop_x, from.integer("crop_offset_x", 0));
    ASSIGN_OR_RETURN(film.crop_y, from.integer("crop_offset_y", 0));
    if (film.crop_x < 0 || film.crop_y < 0 || film.crop_x > film.width - film.crop_width ||
        film.crop_y > film.height - film.crop_height) {
      return error_at(from.place(), "the crop lies outside of the film");
    }
    for (const Property* filter : from.objects("rfilter")) {
      RETURN_IF_ERROR(read_filter(*object_in(*filter), image, to));
    }
    from.ignore({"file_format", "pixel_format", "component_format", "banner", "gamma", "exposure",
                 "tonemap_method", "sample_border", "compensate", "high_quality_edges",
                 "attach_log"});
    to.warn_of_unused(from);
  } else {
    film.crop_width = film.width;
    film.crop_height = film.height;
  }
  image.set_width(static_cast<std::uint32_t>(film.crop_width));
  image.set_height(static_cast<std::uint32_t>(film.crop_height));
  return film;
}

/// Sets the visible part of the image plane, in units of half the film's height. Sets nothing if
/// the whole film is visible and not shifted. The shifts are to the right and down, as shares of
/// the film's width and height.
void set_window(const Film& film, double shift_x, double shift_y, scene::Camera& camera) {
  const bool whole = film.crop_width == film.width && film.crop_height == film.height;
  if (whole && shift_x == 0 && shift_y == 0) {
    return;
  }
  const auto across = [&](std::int64_t pixel) {
    return film.aspect() *
           (2 * (static_cast<double>(pixel) / static_cast<double>(film.width) + shift_x) - 1);
  };
  const auto up = [&](std::int64_t pixel) {
    return 1 - 2 * (static_cast<double>(pixel) / static_cast<double>(film.height) + shift_y);
  };
  for (const double edge : {across(film.crop_x), across(film.crop_x + film.crop_width),
                            up(film.crop_y + film.crop_height), up(film.crop_y)}) {
    camera.add_window(edge);
  }
}

/// Sets the field of view and the shift of a perspective camera.
absl::Status set_perspective(const Parameters& from, const Film& film, scene::Camera& camera) {
  ASSIGN_OR_RETURN(const double half_height, half_height_of_view(from, film.aspect()));
  camera.set_vertical_fov(vertical_fov(half_height));
  ASSIGN_OR_RETURN(const double x, from.number("principal_point_offset_x", 0));
  ASSIGN_OR_RETURN(const double y, from.number("principal_point_offset_y", 0));
  set_window(film, x, y, camera);
  return absl::OkStatus();
}

/// Sets the aperture and the focus distance of a thin lens.
absl::Status set_lens(const Parameters& from, scene::Camera& camera) {
  ASSIGN_OR_RETURN(const double radius, from.number("aperture_radius", 0));
  ASSIGN_OR_RETURN(const double distance, from.number("focus_distance", 1e4));
  if (!(radius >= 0 && distance > 0)) {
    return error_at(from.place(), "aperture_radius must be >= 0 and focus_distance > 0");
  }
  camera.set_aperture(2 * radius);
  camera.set_focus_distance(distance);
  return absl::OkStatus();
}

}  // namespace

absl::Status set_sensor(const Object& sensor, scene::Scene& scene, Conversion& to) {
  const Parameters from(sensor);
  scene::Camera& camera = *scene.mutable_camera();
  ASSIGN_OR_RETURN(const Film film, read_film(from, *scene.mutable_image(), to));
  ASSIGN_OR_RETURN(const Transform to_world, from.transform("to_world"));
  if (!inverse(to_world)) {
    return error_at(from.place(), "to_world is singular");
  }
  const Frame frame = frame_of(to_world);
  set(frame.position, camera.mutable_position());
  // The point `look_at` is so far ahead that the sum of position and direction keeps the precision
  // of the direction.
  const double ahead = std::max(1.0, max_abs(frame.position));
  set(frame.position + frame.ahead * ahead, camera.mutable_look_at());
  set(frame.up, camera.mutable_up());
  camera.set_mirrored(frame.mirrored);
  ASSIGN_OR_RETURN(const double open, from.number("shutter_open", 0));
  ASSIGN_OR_RETURN(const double close, from.number("shutter_close", open));
  camera.set_shutter_open(open);
  camera.set_shutter_close(std::max(open, close));
  from.ignore({"near_clip", "far_clip", "sampler", "focus_distance", "srf"});
  from.objects("sampler");  // the number of samples is chosen when a scene is rendered
  const double uneven = std::abs(frame.scale.x - frame.scale.y);
  if (frame.skewed || uneven > 1e-6 * frame.scale.x) {
    to.warn(from.place(), "the unequal scale or the shear of the sensor is left out");
  }
  if (sensor.type == "orthographic") {
    // Without a scale, Mitsuba's orthographic camera shows a width of 2 scene units.
    camera.mutable_orthographic()->set_height(2 * frame.scale.x / film.aspect());
    set_window(film, 0, 0, camera);
  } else if (sensor.type == "perspective" || sensor.type == "thinlens") {
    RETURN_IF_ERROR(set_perspective(from, film, camera));
    if (sensor.type == "thinlens") {
      RETURN_IF_ERROR(set_lens(from, camera));
    }
  } else {
    return error_at(from.place(), absl::StrCat("sensor \"", sensor.type,
                                               "\" is not supported; it must be perspective, "
                                               "thinlens or orthographic"));
  }
  to.warn_of_unused(from);
  return absl::OkStatus();
}

absl::Status set_integrator(const Object& integrator, scene::Scene& scene, Conversion& to) {
  const Parameters from(integrator);
  const std::string& type = integrator.type;
  const auto nested = from.objects("integrator");
  if (type == "moment" || type == "aov") {
    from.ignore({"aovs"});
    return nested.empty() ? absl::OkStatus()
                          : set_integrator(*object_in(*nested.front()), scene, to);
  }
  scene::Integrator& out = *scene.mutable_integrator();
  ASSIGN_OR_RETURN(const bool hides, from.boolean("hide_emitters", false));
  if (hides) {
    to.warn(from.place(), "\"hide_emitters\" is left out: lights are visible");
  }
  from.ignore({"rr_depth", "block_size", "samples_per_pass", "timeout", "strict_normals",
               "shading_samples", "emitter_samples", "bsdf_samples", "use_mis", "sampler"});
  ASSIGN_OR_RETURN(const std::int64_t depth, from.integer("max_depth", -1));
  if (type == "depth") {
    out.set_kind(scene::Integrator::KIND_DEPTH);
  } else if (type == "direct") {
    out.set_max_depth(1);
  } else {
    if (type.find("path") == std::string::npos && type != "ptracer" && type != "bdpt") {
      to.warn(from.place(), absl::StrCat("integrator \"", type, "\" is replaced by a path tracer"));
      for (const Property* unused : from.unused()) {
        from.ignore({unused->name.c_str()});
      }
    }
    if (depth == 0 || depth == 1) {
      to.warn(from.place(), absl::StrCat("max_depth ", depth,
                                         " shows only light sources; max_depth 2, which is "
                                         "direct light, is used instead"));
    }
    // volpath and volpathmis do not count the passage through a thin pane towards max_depth.
    to.passages_are_free = type == "volpath" || type == "volpathmis";
    // Mitsuba's limit counts the segments of a path; Bandsaw's counts the vertices between them.
    out.set_max_depth(static_cast<std::uint32_t>(
        depth < 0 ? kMaxDepth : std::clamp<std::int64_t>(depth - 1, 1, kMaxDepth)));
  }
  to.warn_of_unused(from);
  return absl::OkStatus();
}

}  // namespace bandsaw::mitsuba
