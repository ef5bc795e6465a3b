#pragma once

// Cameras: generation of primary rays. `Camera` is a closed set (a std::variant) of perspective and
// orthographic cameras; RayGenerator makes the rays of an image.

#include <optional>
#include <variant>

#include "absl/status/status.h"
#include "renderlib/camera/lens_view.h"
#include "renderlib/geometry/ray.h"
#include "renderlib/math/vec.h"

namespace bandsaw {

/// Position and orientation of a camera.
struct View {
  Vec3 position{0, 0, 0};
  Vec3 look_at{0, 0, -1};  ///< differs from position
  Vec3 up{0, 1, 0};        ///< not parallel to the view direction
};

/// Exposure interval. The times of rays are uniformly distributed from `open` to `close`. If `open`
/// and `close` are equal, all rays have this time. The unit is that of the scene's animation.
struct Shutter {
  double open = 0;
  double close = 0;  ///< >= open
  friend bool operator==(const Shutter&, const Shutter&) = default;
};

/// The visible part of the image plane. The unit is half the height that the camera shows without a
/// window; the view direction passes through (0, 0).
struct ImageWindow {
  double left = -1;
  double right = 1;  ///< > left
  double bottom = -1;
  double top = 1;  ///< > bottom
  friend bool operator==(const ImageWindow&, const ImageWindow&) = default;
};

/// A pinhole camera, or a thin lens (Potmesil and Chakravarty 1981). A lens that is focused at the
/// distance f spreads a point at distance z along the view direction over a disk. The radius of the
/// disk on the plane of focus is (aperture / 2) * |z - f| / z.
struct PerspectiveCamera {
  Vec3 position{0, 0, 0};
  Vec3 look_at{0, 0, -1};
  Vec3 up{0, 1, 0};
  double vertical_fov = 40;  ///< degrees, (0, 180)
  double aperture = 0;       ///< diameter of the lens, [0, kMaxLens]; 0: a pinhole
  /// Distance of the plane of focus along the view direction, [kMinFocus, kMaxLens].
  double focus_distance = 1;
  Shutter shutter = {};
  bool mirrored = false;  ///< left and right are exchanged
  /// The visible part of the image plane; std::nullopt: the whole height, and square pixels.
  std::optional<ImageWindow> window = std::nullopt;
};

constexpr double middle_of(const Shutter& shutter) {
  return shutter.open + (shutter.close - shutter.open) / 2;
}

// Ranges that validate() accepts.
inline constexpr double kMaxTime = 1e9;    ///< largest magnitude of a shutter time
inline constexpr double kMinFocus = 1e-9;  ///< of focus_distance
inline constexpr double kMaxLens = 1e30;   ///< of aperture, focus_distance and height
inline constexpr double kMaxWindow = 1e6;  ///< largest magnitude of a side of ImageWindow

/// Parallel rays from the plane through `position`, which is the centre of the image.
struct OrthographicCamera {
  Vec3 position{0, 0, 0};
  Vec3 look_at{0, 0, -1};
  Vec3 up{0, 1, 0};
  double height = 2;      ///< height of the visible region in scene units, > 0, at most kMaxLens
  bool mirrored = false;  ///< left and right are exchanged
  Shutter shutter = {};
  std::optional<ImageWindow> window = std::nullopt;  ///< as in PerspectiveCamera
};

using Camera = std::variant<PerspectiveCamera, OrthographicCamera>;

/// A camera that may move while the shutter is open.
struct MovingCamera {
  Camera at_open;
  std::optional<Camera> at_close = std::nullopt;  ///< of the same kind; absent: it does not move
};

// These functions return the members that both kinds of camera have.
View view_of(const Camera& camera);
bool is_mirrored(const Camera& camera);
const std::optional<ImageWindow>& window_of(const Camera& camera);
const Shutter& shutter_of(const Camera& camera);

/// Returns INVALID_ARGUMENT with the reason if the camera cannot generate rays.
absl::Status validate(const Camera& camera);

/// Returns INVALID_ARGUMENT if the two cameras cannot be the two ends of one moving camera: they
/// differ in kind or shutter, only one of them has a lens, or `at_close` is not valid.
absl::Status validate_motion(const Camera& at_open, const Camera& at_close);

/// A camera prepared for an image of a given size, so that a ray costs only a few multiplications.
/// If the camera moves, its position, its focus and the size of a pixel change linearly while the
/// shutter is open, and the view direction turns.
class RayGenerator {
 public:
  /// `camera` MUST be valid, and `at_close` too (validate_motion); sizes are in pixels, >= 1.
  RayGenerator(const Camera& camera, int width, int height,
               const std::optional<Camera>& at_close = std::nullopt);
  /// Returns the ray through image position (x, y), in pixels from the top left corner; (lens_u,
  /// lens_v) in [0, 1)^2 selects the point on the lens. The direction is a unit vector. `share` in
  /// [0, 1] is the position of the ray's time in the shutter interval.
  Ray ray(double x, double y, double lens_u, double lens_v, double share = 0) const;
  /// Returns the view through the lens (camera/lens_view.h) at image position (x, y) and at `share`
  /// of the shutter interval. Returns std::nullopt if there is no lens, or if the radius of the
  /// lens is not less than the distance to the point in focus.
  std::optional<LensView> lens_view(double x, double y, double share = 0) const;

 private:
  enum class Kind { kPinhole, kLens, kParallel };

  /// The camera at one time.
  struct Projection {
    Vec3 origin;  ///< orthographic: the direction of all rays
    /// Direction through image position (0, 0), not normalised; orthographic: the origin of the ray
    /// at this position.
    Vec3 corner;
    Vec3 dx;      ///< change of `corner` per pixel to the right
    Vec3 dy;      ///< change of `corner` per pixel down
    Vec3 lens_x;  ///< the lens' radius to the right
    Vec3 lens_y;  ///< the lens' radius upwards
    Vec3 forward;
    double lens_radius = 0;
    double focus_distance = 1;
  };
  static Projection project(const PerspectiveCamera& camera, int width, int height);
  static Projection project(const OrthographicCamera& camera, int width, int height);
  /// Sets the corner and the axes of the image in `to`. The view direction passes through the image
  /// plane at `centre`; `half` is half the height that the camera shows without a window.
  static void set_image(const Vec3& centre, const Vec3& right, const Vec3& up, double half,
                        const std::optional<ImageWindow>& window, int width, int height,
                        Projection& to);
  /// Returns the camera at a share of the shutter interval; at_close_ MUST be set.
  Projection between(double share) const;
  /// Returns the ray of the camera `now`, without its time.
  Ray ray_now(const Projection& now, double x, double y, double lens_u, double lens_v) const;

  Kind kind_;
  Projection at_open_;                  ///< when the shutter opens
  std::optional<Projection> at_close_;  ///< when it closes; std::nullopt: the camera does not move
  Shutter shutter_;
};

}  // namespace bandsaw
