// Reads a list of rotations of a scene file, each about an axis by an angle in degrees, and
// multiplies them.

#include "renderlib/import/scene_file/read_rotation.h"

#include <cmath>

#include "absl/strings/str_cat.h"
#include "renderlib/base/status_macros.h"
#include "renderlib/import/scene_file/numbers.h"

namespace bandsaw {

absl::StatusOr<Transform> read_rotation(
    const Field& in, const google::protobuf::RepeatedPtrField<scene::Rotation>& list) {
  Transform turn;
  for (int i = 0; i < list.size(); ++i) {
    const Field rotate = in.child("rotate", i);
    ASSIGN_OR_RETURN(const Vec3 axis, read_direction(rotate, "axis", list[i].axis()));
    const double degrees = list[i].degrees();
    if (!std::isfinite(degrees)) {
      return rotate.error("degrees", absl::StrCat("must be finite, is ", degrees));
    }
    turn = rotation(axis, degrees) * turn;
  }
  return turn;
}

}  // namespace bandsaw
