#pragma once

// Reads lists of numbers of a scene file as vectors and colours; each error names its field.

#include <google/protobuf/repeated_field.h>

#include "absl/status/statusor.h"
#include "proto/scene.pb.h"
#include "renderlib/import/scene_file/field.h"
#include "renderlib/math/rgb.h"
#include "renderlib/math/vec.h"

namespace bandsaw {

using Numbers = google::protobuf::RepeatedField<double>;

/// Reads three finite numbers of at most 1e30 in absolute value, so that products of a few such
/// numbers do not overflow. The field is required.
absl::StatusOr<Vec3> read_vec3(const Field& in, const std::string& name, const Numbers& list);
/// Reads a vector like the first read_vec3(). Returns `otherwise` if the field is absent.
absl::StatusOr<Vec3> read_vec3(const Field& in, const std::string& name, const Numbers& list,
                               const Vec3& otherwise);
/// Reads a vector like the first read_vec3(). The vector must not be zero.
absl::StatusOr<Vec3> read_direction(const Field& in, const std::string& name, const Numbers& list);

/// Returns INVALID_ARGUMENT for the field `name` unless `value` is in [least, most].
absl::Status check_range(const Field& in, const std::string& name, double value, double least,
                         double most);

/// Reads a colour, each channel in [0, most]. `in` is the place of the message `color`.
absl::StatusOr<Rgb> read_color(const Field& in, const scene::Color& color, float most);

}  // namespace bandsaw
