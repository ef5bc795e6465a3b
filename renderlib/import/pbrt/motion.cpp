#include "renderlib/import/pbrt/motion.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace bandsaw::pbrt {
namespace {

/// Returns axis and angle of a rotation by the largest of the four terms of its quaternion.
void set_rotation(const Vec3 columns[3], Pose& pose) {
  const auto m = [&](int row, int column) { return columns[column][row]; };
  const double trace = m(0, 0) + m(1, 1) + m(2, 2);
  double w = 0;
  Vec3 v;
  if (trace > 0) {
    w = std::sqrt(1 + trace) / 2;
    v = Vec3{m(2, 1) - m(1, 2), m(0, 2) - m(2, 0), m(1, 0) - m(0, 1)} / (4 * w);
  } else {
    const int i = m(0, 0) >= m(1, 1) && m(0, 0) >= m(2, 2) ? 0 : m(1, 1) >= m(2, 2) ? 1 : 2;
    const int j = (i + 1) % 3;
    const int k = (i + 2) % 3;
    const double s = std::sqrt(std::max(0.0, 1 + m(i, i) - m(j, j) - m(k, k))) / 2;
    double q[3] = {};
    q[i] = s;
    q[j] = (m(j, i) + m(i, j)) / (4 * s);
    q[k] = (m(k, i) + m(i, k)) / (4 * s);
    w = (m(k, j) - m(j, k)) / (4 * s);
    v = {q[0], q[1], q[2]};
  }
  const double sine = length(v);
  if (sine > 1e-12) {
    pose.axis = v / sine;
    pose.degrees = 2 * std::atan2(sine, w) * 180 / std::numbers::pi;
  }
}

void add_key(double time, const Pose& pose, scene::Key& key) {
  key.set_time(time);
  set_vec3(pose.translate, key.mutable_translate());
  set_vec3(pose.scale, key.mutable_scale());
  if (pose.degrees != 0) {
    auto* rotate = key.add_rotate();
    set_vec3(pose.axis, rotate->mutable_axis());
    rotate->set_degrees(pose.degrees);
  }
}

template <class Placed>
void add_any_keys(const Transforms& transforms, const Place& place, Placed& to, Builder& builder) {
  const auto first = pose_of(transforms[0]);
  const auto second = pose_of(transforms[1]);
  const bool same_side = determinant(transforms[0]) * determinant(transforms[1]) > 0;
  if (!first || !second || !same_side || !(builder.start_time < builder.end_time)) {
    builder.warn(place, "the shape stands still: its motion shears or mirrors it");
    set_matrix(transforms[0], to.mutable_matrix());
    return;
  }
  add_key(builder.start_time, *first, *to.add_key());
  add_key(builder.end_time, *second, *to.add_key());
}

}  // namespace

std::optional<Pose> pose_of(const Transform& t) {
  Vec3 columns[3] = {t.direction({1, 0, 0}), t.direction({0, 1, 0}), t.direction({0, 0, 1})};
  double scale[3] = {};
  for (int k = 0; k < 3; ++k) {
    scale[k] = length(columns[k]);
    if (!(scale[k] > 0)) {
      return std::nullopt;
    }
    columns[k] = columns[k] / scale[k];
  }
  constexpr double kLimit = 1e-6;
  if (std::abs(dot(columns[0], columns[1])) > kLimit ||
      std::abs(dot(columns[1], columns[2])) > kLimit ||
      std::abs(dot(columns[2], columns[0])) > kLimit) {
    return std::nullopt;
  }
  if (dot(cross(columns[0], columns[1]), columns[2]) < 0) {
    scale[0] = -scale[0];
    columns[0] = -columns[0];
  }
  Pose pose;
  pose.scale = {scale[0], scale[1], scale[2]};
  pose.translate = t.point({0, 0, 0});
  set_rotation(columns, pose);
  return pose;
}

void add_keys(const Transforms& transforms, const Place& place, scene::Model& to,
              Builder& builder) {
  add_any_keys(transforms, place, to, builder);
}

void add_keys(const Transforms& transforms, const Place& place, scene::Instance& to,
              Builder& builder) {
  add_any_keys(transforms, place, to, builder);
}

void place_instance(const Place& place, const Transforms& transforms, scene::Instance& to,
                    Builder& builder) {
  if (!(transforms[0] == transforms[1])) {
    builder.has_motion = true;
    add_keys(transforms, place, to, builder);
  } else if (!(transforms[0] == Transform{})) {
    set_matrix(transforms[0], to.mutable_matrix());
  }
}

}  // namespace bandsaw::pbrt
