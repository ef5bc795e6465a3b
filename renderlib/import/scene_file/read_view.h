#pragma once

// Reads the other settings of a scene file: camera, size of the image, background, depth.

#include "absl/status/statusor.h"
#include "proto/scene.pb.h"
#include "renderlib/camera/camera.h"
#include "renderlib/import/draft/scene_draft.h"
#include "renderlib/import/scene_file/field.h"

namespace bandsaw {

/// Reads the camera; the scene MUST have one. The camera gets `shutter`.
absl::StatusOr<Camera> read_camera(const Field& root, const scene::Scene& from,
                                   const Shutter& shutter);
/// Returns the shutter of the frame at `time`. The scene file, or the default, gives it relative to
/// that time.
absl::StatusOr<Shutter> read_shutter(const Field& root, const scene::Scene& from, double time);
/// Reads the frames per second, or returns the default.
absl::StatusOr<double> read_fps(const Field& root, const scene::Scene& from);
/// Reads the pixel filter, or returns the default.
absl::StatusOr<PixelFilter> read_filter(const Field& root, const scene::Scene& from);
absl::StatusOr<LocalShading> read_local_shading(const Field& root, const scene::Scene& from);
/// Reads image and integrator settings that are present.
absl::Status read_settings(const Field& root, const scene::Scene& from, PackageInfo& info);
/// Reads the background; the scene MUST have one.
absl::StatusOr<Background> read_background(const Field& root, const scene::Scene& from,
                                           SceneDraft& draft);

}  // namespace bandsaw
