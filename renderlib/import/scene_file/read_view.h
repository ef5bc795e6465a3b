#pragma once

// Reads the settings of a scene file that are not shapes, materials, lights or media: camera, size
// of the image, background, depth. All functions return INVALID_ARGUMENT, with the name of the
// field, if a field is invalid.

#include "absl/status/statusor.h"
#include "proto/scene.pb.h"
#include "renderlib/camera/camera.h"
#include "renderlib/import/draft/scene_draft.h"
#include "renderlib/import/scene_file/field.h"

namespace bandsaw {

/// Reads the camera; the scene MUST have one. The camera gets `shutter`.
absl::StatusOr<Camera> read_camera(const Field& root, const scene::Scene& from,
                                   const Shutter& shutter);
/// Sets the window of `camera`, and exchanges left and right of the image if `from` is mirrored.
/// `in` is the place of the message `from`. Returns INVALID_ARGUMENT if the window or the resulting
/// camera is invalid.
absl::Status set_window(const Field& in, const scene::Camera& from, Camera& camera);
/// Returns the shutter interval of the frame at `time`, in seconds of the scene's time. The scene
/// file gives the interval relative to the frame's time. By default the shutter opens and closes at
/// the frame's time.
absl::StatusOr<Shutter> read_shutter(const Field& root, const scene::Scene& from, double time);
/// Reads the frames per second, or returns the default.
absl::StatusOr<double> read_fps(const Field& root, const scene::Scene& from);
/// Reads the pixel filter, or returns the default.
absl::StatusOr<PixelFilter> read_filter(const Field& root, const scene::Scene& from);
/// Reads the parameters of the integrators `direct` and `ambient occlusion`. Absent parameters have
/// their defaults.
absl::StatusOr<LocalShading> read_local_shading(const Field& root, const scene::Scene& from);
/// Reads the settings of image and integrator into `info`. An absent exposure becomes 0. Other
/// absent settings keep their values.
absl::Status read_settings(const Field& root, const scene::Scene& from, PackageInfo& info);
/// Reads the background; the scene MUST have one.
absl::StatusOr<Background> read_background(const Field& root, const scene::Scene& from,
                                           SceneDraft& draft);

}  // namespace bandsaw
