#pragma once

// Where rays start. A closed set.

#include <optional>
#include <variant>

#include "absl/status/status.h"
#include "renderlib/camera/lens_view.h"
#include "renderlib/geometry/ray.h"
#include "renderlib/math/vec.h"

namespace bandsaw {

/// Where a camera stands and where it looks.
struct View {
  Vec3 position{0, 0, 0};
  Vec3 look_at{0, 0, -1};  ///< differs from position
  Vec3 up{0, 1, 0};        ///< not parallel to the view direction
};

/// When the image is taken: rays have times from open to close, evenly. Equal: at one moment.
struct Shutter {
  double open = 0;
  double close = 0;  ///< >= open
  friend bool operator==(const Shutter&, const Shutter&) = default;
};

/// A pinhole, or a thin lens (Potmesil and Chakravarty 1981): a point at distance z along the view
/// spreads on the plane of focus, at distance f, over a disk of radius aperture / 2 |z - f| / z.
struct PerspectiveCamera {
  Vec3 position{0, 0, 0};
  Vec3 look_at{0, 0, -1};
  Vec3 up{0, 1, 0};
  double vertical_fov = 40;   ///< degrees, (0, 180)
  double aperture = 0;        ///< diameter of the lens, [0, kMostLens]; 0: a pinhole
  double focus_distance = 1;  ///< of the sharp plane, along the view, [kLeastFocus, kMostLens]
  Shutter shutter = {};
};

inline constexpr double kMostTime = 1e9;
inline constexpr double kLeastFocus = 1e-9;
inline constexpr double kMostLens = 1e30;

/// Parallel rays from the plane through `position`, which is the middle of the image.
struct OrthographicCamera {
  Vec3 position{0, 0, 0};
  Vec3 look_at{0, 0, -1};
  Vec3 up{0, 1, 0};
  double height = 2;      ///< of what the image shows, scene units, > 0, at most kMostLens
  bool mirrored = false;  ///< left and right are exchanged
  Shutter shutter = {};
};

using Camera = std::variant<PerspectiveCamera, OrthographicCamera>;

View view_of(const Camera& camera);
const Shutter& shutter_of(const Camera& camera);

/// INVALID_ARGUMENT with the reason when a camera cannot make rays.
absl::Status validate(const Camera& camera);

/// A camera made ready for an image of a given size: what one ray costs is a few multiplications.
class RayGenerator {
 public:
  /// `camera` MUST be valid; sizes in pixels, >= 1.
  RayGenerator(const Camera& camera, int width, int height);
  /// The ray through image position (x, y), in pixels from the top left corner; (lens_u, lens_v) in
  /// [0, 1)^2. The direction is a unit vector. It is at `share` of the time that the shutter is
  /// open, in [0, 1].
  Ray ray(double x, double y, double lens_u, double lens_v, double share = 0) const;
  /// What the lens sees there through the plane of focus; nothing: it is no lens, or too wide.
  std::optional<LensView> lens_view(double x, double y) const;

 private:
  Ray ray_now(double x, double y, double lens_u, double lens_v) const;

  enum class Kind { kPinhole, kLens, kParallel };

  void prepare(const PerspectiveCamera& camera, int width, int height);
  void prepare(const OrthographicCamera& camera, int width, int height);

  Kind kind_ = Kind::kPinhole;
  Vec3 origin_;  ///< parallel: the direction of all rays
  Vec3 corner_;  ///< direction through image position (0, 0), not normalised; parallel: its origin
  Vec3 dx_;      ///< change of it a pixel to the right
  Vec3 dy_;      ///< and a pixel down
  Vec3 lens_x_;  ///< the lens' radius to the right
  Vec3 lens_y_;  ///< and upwards
  Vec3 forward_;
  double lens_radius_ = 0;
  double focus_distance_ = 1;
  Shutter shutter_;
};

}  // namespace bandsaw
