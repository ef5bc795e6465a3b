#pragma once

// Lists of numbers in a scene file as vectors and colours; each error names its field.

#include <google/protobuf/repeated_field.h>

#include "absl/status/statusor.h"
#include "proto/scene.pb.h"
#include "renderlib/import/scene_file/field.h"
#include "renderlib/math/rgb.h"
#include "renderlib/math/vec.h"

namespace bandsaw {

using Numbers = google::protobuf::RepeatedField<double>;

/// Three finite numbers, at most 1e30 in absolute value (so that no product of a few of them
/// overflows). Required.
absl::StatusOr<Vec3> read_vec3(const Field& in, const std::string& name, const Numbers& list);
/// The same, or `otherwise` where nothing was written.
absl::StatusOr<Vec3> read_vec3(const Field& in, const std::string& name, const Numbers& list,
                               const Vec3& otherwise);
/// The same, required and not zero.
absl::StatusOr<Vec3> read_direction(const Field& in, const std::string& name, const Numbers& list);

/// A number in [least, most].
absl::Status check_range(const Field& in, const std::string& name, double value, double least,
                         double most);

/// `color` is the message that `in` stands for; each channel in [0, most].
absl::StatusOr<Rgb> read_color(const Field& in, const scene::Color& color, float most);

}  // namespace bandsaw
