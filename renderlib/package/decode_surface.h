#pragma once

// Decodes some parts of a manifest, the message that describes a scene package
// (proto/package.proto): camera, filter, local shading (ambient light and the distance of ambient
// occlusion), background, and lists of three numbers. Checks only the form, not the values
// (scene/validate.h).

#include "absl/status/statusor.h"
#include "proto/package.pb.h"
#include "renderlib/scene/description.h"

namespace bandsaw {

// `field` is the name of the decoded field in error messages. All functions return INVALID_ARGUMENT
// if a list has a wrong length or an enum has an unknown value.

absl::StatusOr<Camera> decode_camera(const package::Camera& from, const std::string& field);
/// Returns the default filter if the manifest has none.
absl::StatusOr<PixelFilter> decode_filter(const package::Manifest& manifest);
/// Returns the default for each value that the manifest does not have.
absl::StatusOr<LocalShading> decode_local_shading(const package::Manifest& manifest);
/// Returns INVALID_ARGUMENT also if the manifest has no background.
absl::StatusOr<Background> decode_background(const package::Manifest& manifest);
absl::StatusOr<Vec3> decode_vec3(const google::protobuf::RepeatedField<double>& list,
                                 const std::string& field);
absl::StatusOr<Rgb> decode_rgb(const google::protobuf::RepeatedField<float>& list,
                               const std::string& field);

}  // namespace bandsaw
