// Reads placements of models and instances in a scene file: scale, rotations and translation, or a
// matrix. A moving object has keys, which are placements at given times. Between keys the shortest
// rotation is used. So if the angles of two keys about one axis differ by more than kMaxTurn,
// further keys are added in between, and full turns are not lost.

#include "renderlib/import/scene_file/read_placement.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "absl/strings/str_cat.h"
#include "renderlib/base/status_macros.h"
#include "renderlib/camera/camera.h"
#include "renderlib/import/scene_file/numbers.h"

namespace bandsaw {
namespace {

/// Maximum rotation about one axis between two keys. It is well below 180 degrees, because beyond
/// 180 degrees the shortest rotation runs in the opposite direction.
constexpr double kMaxTurn = 90;  // degrees
/// Maximum number of keys that add_keys() appends for one key of the scene file.
constexpr double kMaxKeys = 100'000;

struct Turn {
  Vec3 axis;
  double degrees = 0;
};

/// The fields of a placement as they are written. The turns are applied one after the other.
struct Written {
  Vec3 scale{1, 1, 1};
  std::vector<Turn> turns;
  Vec3 translate;
};

absl::StatusOr<Vec3> read_scale(const Field& in, const Numbers& list) {
  if (list.empty()) {
    return Vec3{1, 1, 1};
  }
  if (list.size() != 1 && list.size() != 3) {
    return in.error("scale", absl::StrCat("must be 1 or 3 numbers, has ", list.size()));
  }
  for (int i = 0; i < list.size(); ++i) {
    if (!std::isfinite(list[i]) || list[i] == 0) {
      return in.error("scale", absl::StrCat("must be finite and not zero, is ", list[i]), i);
    }
  }
  return list.size() == 1 ? Vec3{list[0], list[0], list[0]} : Vec3{list[0], list[1], list[2]};
}

template <class Message>
absl::StatusOr<Written> read_written(const Field& in, const Message& from) {
  Written written;
  ASSIGN_OR_RETURN(written.scale, read_scale(in, from.scale()));
  for (int i = 0; i < from.rotate_size(); ++i) {
    const Field rotate = in.child("rotate", i);
    Turn turn;
    ASSIGN_OR_RETURN(turn.axis, read_direction(rotate, "axis", from.rotate(i).axis()));
    turn.degrees = from.rotate(i).degrees();
    if (!std::isfinite(turn.degrees)) {
      return rotate.error("degrees", absl::StrCat("must be finite, is ", turn.degrees));
    }
    written.turns.push_back(turn);
  }
  ASSIGN_OR_RETURN(written.translate, read_vec3(in, "translate", from.translate(), Vec3{}));
  return written;
}

Transform transform_of(const Written& written) {
  Transform placement = scaling(written.scale);
  for (const Turn& turn : written.turns) {
    placement = rotation(turn.axis, turn.degrees) * placement;
  }
  return translation(written.translate) * placement;
}

/// Reads a placement that is written as scale, rotate and translate, and not as a matrix.
template <class Message>
absl::StatusOr<Transform> read_any_placement(const Field& in, const Message& from) {
  ASSIGN_OR_RETURN(const Written written, read_written(in, from));
  const Transform placement = transform_of(written);
  if (!inverse(placement)) {
    return in.error("scale", "flattens the model: its largest and smallest scale differ too much");
  }
  return placement;
}

/// Reads the 12 numbers of a 3 x 4 matrix, row by row.
template <class Message>
absl::StatusOr<Transform> read_matrix(const Field& in, const Message& from) {
  constexpr int kNumbers = 12;
  const Numbers& list = from.matrix();
  if (list.size() != kNumbers) {
    return in.error("matrix", absl::StrCat("must be 12 numbers, has ", list.size()));
  }
  if (!from.translate().empty() || !from.scale().empty() || from.rotate_size() > 0 ||
      from.key_size() > 0) {
    return in.error("matrix", "cannot be combined with translate, scale, rotate or key");
  }
  Transform placement;
  for (int i = 0; i < kNumbers; ++i) {
    if (!std::isfinite(list[i])) {
      return in.error("matrix", absl::StrCat("must be finite, is ", list[i]), i);
    }
    placement.m[static_cast<std::size_t>(i / 4)][static_cast<std::size_t>(i % 4)] = list[i];
  }
  if (!inverse(placement)) {
    return in.error("matrix", "flattens the model: its determinant is 0, or nearly");
  }
  return placement;
}

struct WrittenKey {
  double time = 0;
  Written pose;
};

bool same_sign(const Vec3& a, const Vec3& b) {
  return a.x * b.x > 0 && a.y * b.y > 0 && a.z * b.z > 0;
}

/// Returns the rotation of `pose` if it is one rotation about one axis. If `pose` has no rotation
/// and `other` has one, returns a rotation by 0 about the axis of `other`. Returns std::nullopt in
/// all other cases.
std::optional<Turn> only_turn(const Written& pose, const Written& other) {
  if (pose.turns.size() == 1) {
    return pose.turns[0];
  }
  const bool rests = pose.turns.empty() && other.turns.size() == 1;
  return rests ? std::optional(Turn{other.turns[0].axis, 0}) : std::nullopt;
}

/// Appends the keys after `a`, up to and including `b`. If both rotate about the same axis and the
/// rotation between them exceeds kMaxTurn, further keys are added in between.
void add_keys(const WrittenKey& a, const WrittenKey& b, std::vector<Key>& keys) {
  const std::optional<Turn> from = only_turn(a.pose, b.pose);
  const std::optional<Turn> to = only_turn(b.pose, a.pose);
  const bool one_axis = from && to && from->axis == to->axis;
  const double turn = one_axis ? to->degrees - from->degrees : 0;
  const double steps = std::clamp(std::ceil(std::abs(turn) / kMaxTurn), 1.0, kMaxKeys);
  for (double step = 1; step < steps; ++step) {
    const double u = step / steps;
    Written between;
    between.scale = a.pose.scale + u * (b.pose.scale - a.pose.scale);
    between.turns = {{from->axis, from->degrees + u * turn}};
    between.translate = a.pose.translate + u * (b.pose.translate - a.pose.translate);
    keys.emplace_back(a.time + u * (b.time - a.time), transform_of(between));
  }
  keys.emplace_back(b.time, transform_of(b.pose));
}

absl::StatusOr<WrittenKey> read_key(const Field& in, const scene::Key& from,
                                    const std::vector<WrittenKey>& earlier) {
  WrittenKey key;
  key.time = from.time();
  RETURN_IF_ERROR(check_range(in, "time", key.time, -kMaxTime, kMaxTime));
  if (!earlier.empty() && !(key.time > earlier.back().time)) {
    return in.error("time", absl::StrCat("must be after ", earlier.back().time,
                                         ", the time of the key before; it is ", key.time));
  }
  ASSIGN_OR_RETURN(key.pose, read_written(in, from));
  if (!earlier.empty() && !same_sign(key.pose.scale, earlier.back().pose.scale)) {
    return in.error(
        "scale",
        "must keep its signs from key to key: between opposite signs, it would pass through 0");
  }
  if (!decompose(transform_of(key.pose))) {
    return in.error("scale", "flattens the model: its largest and smallest scale differ too much");
  }
  return key;
}

/// Reads the keys of an object, and adds keys where the rotation between two of them is large.
template <class Message>
absl::StatusOr<std::vector<Key>> read_any_keys(const Field& in, const Message& from) {
  std::vector<WrittenKey> written;
  std::vector<Key> keys;
  for (int i = 0; i < from.key_size(); ++i) {
    ASSIGN_OR_RETURN(WrittenKey key, read_key(in.child("key", i), from.key(i), written));
    if (written.empty()) {
      keys.emplace_back(key.time, transform_of(key.pose));
    } else {
      add_keys(written.back(), key, keys);
    }
    written.push_back(std::move(key));
  }
  if (!keys.empty() &&
      (!from.translate().empty() || !from.scale().empty() || from.rotate_size() > 0)) {
    return in.error("key", "write key, or translate, scale and rotate, not both", 0);
  }
  return keys;
}

}  // namespace

absl::StatusOr<Transform> read_placement(const Field& in, const scene::Model& from) {
  return from.matrix().empty() ? read_any_placement(in, from) : read_matrix(in, from);
}
absl::StatusOr<Transform> read_placement(const Field& in, const scene::Instance& from) {
  return from.matrix().empty() ? read_any_placement(in, from) : read_matrix(in, from);
}
absl::StatusOr<Transform> read_placement(const Field& in, const scene::Copy& from) {
  return read_any_placement(in, from);
}

absl::StatusOr<std::vector<Key>> read_keys(const Field& in, const scene::Model& from) {
  return read_any_keys(in, from);
}
absl::StatusOr<std::vector<Key>> read_keys(const Field& in, const scene::Instance& from) {
  return read_any_keys(in, from);
}

}  // namespace bandsaw
