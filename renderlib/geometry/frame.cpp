// An animated frame has keys: transforms at times. Between two keys, translation, rotation and
// scale are interpolated separately; decompose() finds them, and refuses transforms with shear.

#include "renderlib/geometry/frame.h"

#include <algorithm>
#include <cmath>

namespace bandsaw {
namespace {

/// Tolerance of decompose(), relative to the largest element of the linear part.
constexpr double kDecomposeTolerance = 1e-9;

/// Returns the largest magnitude of an element of the linear part.
double largest(const Transform& t) {
  double most = 0;
  for (const auto& row : t.m) {
    for (std::size_t k = 0; k < 3; ++k) {
      most = std::max(most, std::abs(row[k]));
    }
  }
  return most;
}

Transform compose(const Pose& pose) {
  return translation(pose.translate) * rotation(pose.rotate) * scaling(pose.scale);
}

/// Returns the motion at `time`, which lies between the times of the consecutive keys `a` and `b`.
Transform between(const Key& a, const Key& b, double time) {
  const double u = (time - a.time) / (b.time - a.time);
  const Vec3 moved = a.pose.translate + u * (b.pose.translate - a.pose.translate);
  if (a.pose.rotate == b.pose.rotate && a.pose.scale == b.pose.scale) {
    Transform t = a.at;  // Only a translation: the linear part keeps its bits.
    t.m[0][3] = moved.x;
    t.m[1][3] = moved.y;
    t.m[2][3] = moved.z;
    return t;
  }
  const Vec3 scale = a.pose.scale + u * (b.pose.scale - a.pose.scale);
  return compose({moved, slerp(a.pose.rotate, b.pose.rotate, u), scale});
}

}  // namespace

std::optional<Pose> decompose(const Transform& t) {
  if (!inverse(t)) {
    return std::nullopt;
  }
  Pose pose;
  pose.translate = {t.m[0][3], t.m[1][3], t.m[2][3]};
  const double sign = determinant(t) < 0 ? -1 : 1;
  const auto column = [&](std::size_t k) {
    return sign * length(Vec3{t.m[0][k], t.m[1][k], t.m[2][k]});
  };
  pose.scale = {column(0), column(1), column(2)};
  Transform turn;
  for (std::size_t i = 0; i < 3; ++i) {
    turn.m[i] = {t.m[i][0] / pose.scale.x, t.m[i][1] / pose.scale.y, t.m[i][2] / pose.scale.z, 0};
  }
  pose.rotate = quaternion(turn);
  const Transform again = compose(pose);
  const double most = kDecomposeTolerance * largest(t);
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      if (!(std::abs(again.m[i][k] - t.m[i][k]) <= most)) {
        return std::nullopt;
      }
    }
  }
  return pose;
}

Key::Key(double when, const Transform& where)
    : time{when}, at(where), pose(decompose(where).value_or(Pose{})) {}

Transform motion_at(const Frame& frame, double time) {
  const std::vector<Key>& keys = frame.keys;
  const auto after = std::upper_bound(keys.begin(), keys.end(), time,
                                      [](double t, const Key& key) { return t < key.time; });
  if (after == keys.begin()) {
    return keys.front().at;
  }
  const Key& before = *(after - 1);
  return after == keys.end() || before.time == time ? before.at : between(before, *after, time);
}

Transform frame_at(const std::vector<Frame>& frames, FrameId id, double time) {
  const Frame* frame = &frames[index_of(id)];
  Transform to_world = frame->placement * motion_at(*frame, time);
  while (frame->parent != kNoFrame) {
    frame = &frames[index_of(frame->parent)];
    to_world = frame->placement * motion_at(*frame, time) * to_world;
  }
  return to_world;
}

}  // namespace bandsaw
