// Places models and instances of a pbrt scene. A motion becomes two keys: a pose (scale, rotation
// and translation) at its start, and a pose at its end. If the moving object is sheared, it is put
// into a group, and an instance of this group moves by the keys.

#include "renderlib/import/pbrt/motion.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <type_traits>
#include <utility>

#include "absl/strings/str_cat.h"
#include "renderlib/math/elementary.h"

namespace bandsaw::pbrt {
namespace {

/// Sets axis and angle of `pose` to those of the rotation matrix with these columns. Divides by the
/// term w of the rotation's quaternion if the trace is positive, otherwise by the largest of the
/// terms x, y and z, so that the divisor is never close to 0.
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
    pose.degrees = 2 * atan2(sine, w) * 180 / std::numbers::pi;
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

/// models() and instances() return the list to which a model or an instance is added: that of the
/// open group, or that of the scene if no group is open.
auto& models(Builder& builder) {
  return builder.group != nullptr ? *builder.group->mutable_model() : *builder.out.mutable_model();
}
auto& instances(Builder& builder) {
  return builder.group != nullptr ? *builder.group->mutable_instance()
                                  : *builder.out.mutable_instance();
}
void add(scene::Model placed, Builder& builder) { *models(builder).Add() = std::move(placed); }
void add(scene::Instance placed, Builder& builder) {
  *instances(builder).Add() = std::move(placed);
}

/// Gives the object `to` the pose `first` at the start of the motion and `second` at its end.
template <class Placed>
void set_keys(const Pose& first, const Pose& second, const Builder& builder, Placed& to) {
  add_key(builder.start_time, first, *to.add_key());
  add_key(builder.end_time, second, *to.add_key());
}

template <class Placed>
Placed& add_to(scene::Group& group, Placed placed) {
  if constexpr (std::is_same_v<Placed, scene::Model>) {
    return *group.add_model() = std::move(placed);
  } else {
    return *group.add_instance() = std::move(placed);
  }
}

/// Adds a sheared object whose motion keeps the shear: the second transformation is the product of
/// a pose and the first transformation. Returns false, and adds nothing, if there is no such pose.
template <class Placed>
bool add_sheared(const Transforms& transforms, Placed& placed, Builder& builder) {
  const auto back = inverse(transforms[0]);
  const auto moved = back ? pose_of(transforms[1] * *back) : std::nullopt;
  if (!moved) {
    return false;
  }
  // The pose turns about the origin of the shape.
  const Vec3 origin = transforms[0].point({0, 0, 0});
  Pose first;
  first.translate = origin;
  Pose second = *moved;
  second.translate = transforms[1].point({0, 0, 0});
  std::string name;
  scene::Group& group = add_helper_group(builder, name);
  set_matrix(translation(-origin) * transforms[0], placed.mutable_matrix());
  add_to(group, std::move(placed));
  scene::Instance instance;
  instance.set_of(name);
  set_keys(first, second, builder, instance);
  add(std::move(instance), builder);
  return true;
}

/// Adds an object with keys for both transformations. If no keys can describe the motion, the
/// object stays at the first transformation, with a warning.
template <class Placed>
void add_moving(const Place& place, const Transforms& transforms, Placed placed, Builder& builder) {
  builder.has_motion = true;
  const bool same_side = determinant(transforms[0]) * determinant(transforms[1]) > 0;
  const bool has_times = builder.start_time < builder.end_time;
  const auto first = pose_of(transforms[0]);
  const auto second = pose_of(transforms[1]);
  if (same_side && has_times && first && second) {
    set_keys(*first, *second, builder, placed);
  } else if (same_side && has_times && add_sheared(transforms, placed, builder)) {
    return;
  } else {
    builder.warn(place,
                 "the shape stands still: its motion shears or mirrors it, or has no duration");
    set_matrix(transforms[0], placed.mutable_matrix());
  }
  add(std::move(placed), builder);
}

/// Adds an object, with keys if the two transformations differ, otherwise with one matrix.
template <class Placed>
void add_any(const Place& place, const Transforms& transforms, Placed placed, Builder& builder) {
  if (!(transforms[0] == transforms[1])) {
    add_moving(place, transforms, std::move(placed), builder);
    return;
  }
  if (!(transforms[0] == Transform{})) {
    set_matrix(transforms[0], placed.mutable_matrix());
  }
  add(std::move(placed), builder);
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

scene::Group& add_helper_group(Builder& builder, std::string& name) {
  name = absl::StrCat("part_", ++builder.helper_groups);
  auto& groups = *builder.out.mutable_group();
  scene::Group* group = groups.Add();
  if (builder.group != nullptr) {
    // The new group will be placed in the group that ObjectBegin has opened, so it must come before
    // the open group.
    const int last = groups.size() - 1;
    groups.SwapElements(last - 1, last);
    builder.group = groups.Mutable(last);
    group = groups.Mutable(last - 1);
  }
  group->set_name(name);
  return *group;
}

void add_placed(const Place& place, const Transforms& transforms, scene::Model model,
                Builder& builder) {
  add_any(place, transforms, std::move(model), builder);
}

void add_placed(const Place& place, const Transforms& transforms, scene::Instance instance,
                Builder& builder) {
  add_any(place, transforms, std::move(instance), builder);
}

}  // namespace bandsaw::pbrt
