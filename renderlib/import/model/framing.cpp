// Places a camera in front of a model, a little to the right and above. The camera is as near as it
// can be while it sees all vertices.

#include "renderlib/import/model/framing.h"

#include <algorithm>
#include <limits>

#include "renderlib/geometry/placement.h"
#include "renderlib/math/elementary.h"

namespace bandsaw {
namespace {

constexpr double kVerticalFov = 35;      // in degrees; a small angle distorts little
constexpr double kMargin = 0.94;         // share of the image that the model may fill
const Vec3 kToCamera = {0.55, 0.38, 1};  // from the model: front, a little right and above

// Calls `visit` with the world position of each vertex at time 0. Instances of groups are left out.
template <class Visit>
void for_each_vertex(const Geometry& geometry, const std::vector<Instance>& instances,
                     Visit visit) {
  for (const Instance& instance : instances) {
    if (instance.group != kNoGroup) {
      continue;
    }
    const Transform to_world = to_world_at(geometry, instance, 0);
    const Mesh& mesh = geometry.meshes[index_of(instance.mesh)];
    for (const auto& p : mesh.positions) {
      visit(to_world.point({p[0], p[1], p[2]}));
    }
  }
}

// Considers one axis of the image, horizontal or vertical, and finds the nearest place from which a
// camera sees all points along this axis. A camera at (a, d) with half-angle tangent t sees a point
// (x, z), z towards the camera, if |x - a| <= t (d - z). So d t >= x + t z - a and
// d t >= -x + t z + a. Over all points, let R (`right`) be the maximum of x + t z, and L (`left`)
// the maximum of -x + t z. Then the least d is (R + L) / (2 t), and it is reached at
// a = (R - L) / 2.
struct Fit {
  double tangent;
  double right = -std::numeric_limits<double>::infinity();
  double left = -std::numeric_limits<double>::infinity();

  void add(double x, double z) {
    right = std::max(right, x + tangent * z);
    left = std::max(left, -x + tangent * z);
  }
  double distance() const { return (right + left) / (2 * tangent); }
  double centre() const { return (right - left) / 2; }
};

}  // namespace

PerspectiveCamera frame(const Geometry& geometry, const std::vector<Instance>& instances,
                        double aspect_ratio) {
  if (instances.empty()) {
    return {};
  }
  const Vec3 back = normalize(kToCamera);
  const Vec3 right = normalize(cross(Vec3{0, 1, 0}, back));
  const Vec3 up = cross(back, right);
  const double tangent = tan_degrees(kVerticalFov / 2) * kMargin;
  Fit wide{tangent * aspect_ratio};
  Fit high{tangent};
  for_each_vertex(geometry, instances, [&](const Vec3& p) {
    wide.add(dot(p, right), dot(p, back));
    high.add(dot(p, up), dot(p, back));
  });
  double distance = std::max(wide.distance(), high.distance());
  // The camera looks at the point halfway between the nearest and the farthest vertex along the
  // view direction.
  double nearest = -std::numeric_limits<double>::infinity();
  double farthest = std::numeric_limits<double>::infinity();
  for_each_vertex(geometry, instances, [&](const Vec3& p) {
    nearest = std::max(nearest, dot(p, back));
    farthest = std::min(farthest, dot(p, back));
  });
  if (!(distance > nearest)) {
    distance = nearest + 1;  // all points are equal
  }
  const Vec3 axis = right * wide.centre() + up * high.centre();
  PerspectiveCamera camera;
  camera.position = axis + back * distance;
  camera.look_at = axis + back * ((nearest + farthest) / 2);
  camera.vertical_fov = kVerticalFov;
  return camera;
}

Background default_sky() { return {{0.22f, 0.21f, 0.20f}, {1.0f, 1.2f, 1.5f}}; }

}  // namespace bandsaw
