// The constructor of RayGenerator computes, for both ends of the shutter interval, a linear map
// from image positions to directions (Projection). ray() evaluates it, interpolated in time if the
// camera moves.

#include "renderlib/camera/camera.h"

#include <algorithm>
#include <cmath>

#include "absl/strings/str_cat.h"
#include "renderlib/base/status_macros.h"
#include "renderlib/math/elementary.h"
#include "renderlib/sampling/warp.h"

namespace bandsaw {
namespace {

/// Minimum sine of the angle between view direction and `up`. At this angle the direction to the
/// right, their cross product, still has ten correct digits.
constexpr double kMinUpSine = 1e-6;

absl::Status invalid(absl::string_view field, absl::string_view why) {
  return absl::InvalidArgumentError(absl::StrCat("camera.", field, ": ", why));
}

absl::Status validate_view(const View& camera) {
  if (!is_finite(camera.position)) {
    return invalid("position", "must be finite");
  }
  if (!is_finite(camera.look_at)) {
    return invalid("look_at", "must be finite");
  }
  if (!is_finite(camera.up)) {
    return invalid("up", "must be finite");
  }
  const Vec3 view = camera.look_at - camera.position;
  const double distance = length(view);
  if (!(distance > 0 && distance < kInfinity)) {
    return invalid("look_at", "must differ from position, by a distance that is a finite number");
  }
  const double up_length = length(camera.up);
  if (!(up_length > 0 && up_length < kInfinity)) {
    return invalid("up", "must have a length that is finite and not zero");
  }
  if (length(cross(view / distance, camera.up / up_length)) < kMinUpSine) {
    return invalid("up", "must not be parallel to the view direction");
  }
  return absl::OkStatus();
}

absl::Status validate_shutter(const Shutter& shutter) {
  for (const double time : {shutter.open, shutter.close}) {
    if (!(std::abs(time) <= kMaxTime)) {
      return invalid("shutter_open, shutter_close",
                     absl::StrCat("must be in [-1e9, 1e9], one is ", time));
    }
  }
  if (!(shutter.open <= shutter.close)) {
    return invalid("shutter_close",
                   absl::StrCat("must not be before ", shutter.open,
                                ", the value of shutter_open; it is ", shutter.close));
  }
  return absl::OkStatus();
}

absl::Status validate_window(const std::optional<ImageWindow>& window) {
  if (!window) {
    return absl::OkStatus();
  }
  for (const double side : {window->left, window->right, window->bottom, window->top}) {
    if (!(std::abs(side) <= kMaxWindow)) {
      return invalid("window", absl::StrCat("must be in [-1e6, 1e6], one number is ", side));
    }
  }
  if (!(window->left < window->right && window->bottom < window->top)) {
    return invalid("window", "left must be less than right, and bottom less than top");
  }
  return absl::OkStatus();
}

absl::Status validate_kind(const PerspectiveCamera& camera) {
  if (!(camera.vertical_fov > 0 && camera.vertical_fov < 180)) {
    return invalid("vertical_fov",
                   absl::StrCat("must be in (0, 180) degrees, is ", camera.vertical_fov));
  }
  if (!(camera.aperture >= 0 && camera.aperture <= kMaxLens)) {
    return invalid("aperture", absl::StrCat("must be in [0, 1e30], is ", camera.aperture));
  }
  if (!(camera.focus_distance >= kMinFocus && camera.focus_distance <= kMaxLens)) {
    return invalid("focus_distance",
                   absl::StrCat("must be in [1e-9, 1e30], is ", camera.focus_distance));
  }
  return absl::OkStatus();
}

absl::Status validate_kind(const OrthographicCamera& camera) {
  if (!(camera.height > 0 && camera.height <= kMaxLens)) {
    return invalid("orthographic.height",
                   absl::StrCat("must be > 0 and at most 1e30, is ", camera.height));
  }
  return absl::OkStatus();
}

/// Orthonormal axes of a camera.
struct Axes {
  explicit Axes(const Camera& camera) {
    const View view = view_of(camera);
    forward = normalize(view.look_at - view.position);
    right = normalize(cross(forward, normalize(view.up)));
    up = cross(right, forward);
    right = is_mirrored(camera) ? -right : right;
  }
  Vec3 forward;
  Vec3 right;  ///< points to the right in the image, i.e. to the left of the view if mirrored
  Vec3 up;
};

}  // namespace

View view_of(const Camera& camera) {
  return std::visit([](const auto& c) { return View{c.position, c.look_at, c.up}; }, camera);
}

bool is_mirrored(const Camera& camera) {
  return std::visit([](const auto& c) { return c.mirrored; }, camera);
}

const std::optional<ImageWindow>& window_of(const Camera& camera) {
  return std::visit([](const auto& c) -> const std::optional<ImageWindow>& { return c.window; },
                    camera);
}

const Shutter& shutter_of(const Camera& camera) {
  return std::visit([](const auto& c) -> const Shutter& { return c.shutter; }, camera);
}

absl::Status validate(const Camera& camera) {
  RETURN_IF_ERROR(validate_view(view_of(camera)));
  RETURN_IF_ERROR(validate_shutter(shutter_of(camera)));
  RETURN_IF_ERROR(validate_window(window_of(camera)));
  return std::visit([](const auto& c) { return validate_kind(c); }, camera);
}

absl::Status validate_motion(const Camera& at_open, const Camera& at_close) {
  RETURN_IF_ERROR(validate(at_close));
  if (at_open.index() != at_close.index() || shutter_of(at_open) != shutter_of(at_close)) {
    return absl::InvalidArgumentError(
        "camera: its kind and its shutter must not change while the shutter is open");
  }
  const auto* from = std::get_if<PerspectiveCamera>(&at_open);
  const auto* to = std::get_if<PerspectiveCamera>(&at_close);
  return from != nullptr && (from->aperture > 0) != (to->aperture > 0)
             ? invalid("aperture", "must be 0 at both ends of the shutter interval, or at neither")
             : absl::OkStatus();
}

RayGenerator::RayGenerator(const Camera& camera, int width, int height,
                           const std::optional<Camera>& at_close)
    : kind_(std::holds_alternative<OrthographicCamera>(camera) ? Kind::kParallel
            : std::get<PerspectiveCamera>(camera).aperture > 0 ? Kind::kLens
                                                               : Kind::kPinhole),
      at_open_(std::visit([&](const auto& c) { return project(c, width, height); }, camera)),
      shutter_(shutter_of(camera)) {
  if (at_close) {
    at_close_ = std::visit([&](const auto& c) { return project(c, width, height); }, *at_close);
  }
}

void RayGenerator::set_image(const Vec3& centre, const Vec3& right, const Vec3& up, double half,
                             const std::optional<ImageWindow>& window, int width, int height,
                             Projection& to) {
  if (!window) {  // pixels are square
    const double pixel = 2 * half / height;
    to.dx = right * pixel;
    to.dy = up * -pixel;
    to.corner = centre - to.dx * (width / 2.0) - to.dy * (height / 2.0);
    return;
  }
  to.dx = right * (half * (window->right - window->left) / width);
  to.dy = up * (-half * (window->top - window->bottom) / height);
  to.corner = centre + right * (half * window->left) + up * (half * window->top);
}

RayGenerator::Projection RayGenerator::project(const PerspectiveCamera& camera, int width,
                                               int height) {
  const Axes axes(camera);
  Projection to;
  to.origin = camera.position;
  // The image plane at distance 1 has height 2 tan(fov / 2).
  set_image(axes.forward, axes.right, axes.up, tan_degrees(camera.vertical_fov / 2), camera.window,
            width, height, to);
  to.lens_x = axes.right * (camera.aperture / 2);
  to.lens_y = axes.up * (camera.aperture / 2);
  to.forward = axes.forward;
  to.lens_radius = camera.aperture / 2;
  to.focus_distance = camera.focus_distance;
  return to;
}

RayGenerator::Projection RayGenerator::project(const OrthographicCamera& camera, int width,
                                               int height) {
  const Axes axes(camera);
  Projection to;
  to.origin = axes.forward;  // the direction of all rays; the image points are their origins
  set_image(camera.position, axes.right, axes.up, camera.height / 2, camera.window, width, height,
            to);
  return to;
}

RayGenerator::Projection RayGenerator::between(double share) const {
  const auto mixed = [share](const auto& a, const auto& b) { return a + (b - a) * share; };
  const Projection& a = at_open_;
  const Projection& b = *at_close_;
  Projection out;
  out.origin = mixed(a.origin, b.origin);
  if (kind_ == Kind::kParallel) {
    out.origin = normalize(out.origin);
    out.corner = mixed(a.corner, b.corner);
    out.dx = mixed(a.dx, b.dx);
    out.dy = mixed(a.dy, b.dy);
    return out;
  }
  // The interpolated axes are made perpendicular again, so that image and lens belong to one view
  // direction. `aside` is the interpolated direction to the right.
  out.forward = normalize(mixed(a.forward, b.forward));
  const Vec3 aside = mixed(normalize(a.dx), normalize(b.dx));
  const Vec3 right = normalize(aside - out.forward * dot(aside, out.forward));
  const Vec3 across = cross(out.forward, right);
  // `across` points down, or up in a mirrored image. A mirrored image stays mirrored.
  const Vec3 down = dot(cross(a.forward, a.dx), a.dy) > 0 ? across : -across;
  out.dx = right * mixed(length(a.dx), length(b.dx));
  out.dy = down * mixed(length(a.dy), length(b.dy));
  // column() and row() return the corner's coordinates along the image's axes, in pixels.
  const auto column = [](const Projection& p) { return dot(p.corner, p.dx) / dot(p.dx, p.dx); };
  const auto row = [](const Projection& p) { return dot(p.corner, p.dy) / dot(p.dy, p.dy); };
  out.corner = out.forward + out.dx * mixed(column(a), column(b)) + out.dy * mixed(row(a), row(b));
  out.lens_radius = mixed(a.lens_radius, b.lens_radius);
  out.lens_x = right * (dot(a.lens_x, a.dx) < 0 ? -out.lens_radius : out.lens_radius);
  out.lens_y = down * (dot(a.lens_y, a.dy) > 0 ? out.lens_radius : -out.lens_radius);
  out.focus_distance = mixed(a.focus_distance, b.focus_distance);
  return out;
}

Ray RayGenerator::ray(double x, double y, double lens_u, double lens_v, double share) const {
  Ray ray = ray_now(at_close_ ? between(share) : at_open_, x, y, lens_u, lens_v);
  ray.time = std::min(shutter_.open + share * (shutter_.close - shutter_.open), shutter_.close);
  return ray;
}

std::optional<LensView> RayGenerator::lens_view(double x, double y, double share) const {
  if (kind_ != Kind::kLens) {
    return std::nullopt;
  }
  const Projection now = at_close_ ? between(share) : at_open_;
  return LensView::make(now.origin, now.forward, now.lens_radius, now.focus_distance,
                        now.corner + now.dx * x + now.dy * y);
}

Ray RayGenerator::ray_now(const Projection& now, double x, double y, double lens_u,
                          double lens_v) const {
  const Vec3 at = now.corner + now.dx * x + now.dy * y;
  if (kind_ == Kind::kPinhole) {
    return {.origin = now.origin, .direction = normalize(at)};
  }
  if (kind_ == Kind::kParallel) {
    return {.origin = at, .direction = now.origin};  // Projection::origin holds the direction.
  }
  const Vec2 on_lens = sample_disk(lens_u, lens_v);
  const Vec3 from = now.lens_x * on_lens.x + now.lens_y * on_lens.y;
  // The ray passes through the point in focus, origin + focus_distance * at. Its direction is
  // computed in units of the focus distance, because that distance may be huge.
  return {.origin = now.origin + from, .direction = normalize(at - from / now.focus_distance)};
}

}  // namespace bandsaw
