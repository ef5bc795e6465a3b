#pragma once

// What a scene file says beside surfaces: camera, size of the image, background, depth.

#include "absl/status/statusor.h"
#include "proto/scene.pb.h"
#include "renderlib/camera/camera.h"
#include "renderlib/import/draft/scene_draft.h"
#include "renderlib/import/scene_file/field.h"

namespace bandsaw {

/// The written camera; the scene MUST have one.
absl::StatusOr<Camera> read_camera(const Field& root, const scene::Scene& from);
/// The written shutter, or the default.
absl::StatusOr<Shutter> read_shutter(const Field& root, const scene::Scene& from);
/// The written filter, or the default.
absl::StatusOr<PixelFilter> read_filter(const Field& root, const scene::Scene& from);
absl::StatusOr<LocalShading> read_local_shading(const Field& root, const scene::Scene& from);
/// Image and integrator, where written.
absl::Status read_settings(const Field& root, const scene::Scene& from, PackageInfo& info);
/// The written background; the scene MUST have one.
absl::StatusOr<Background> read_background(const Field& root, const scene::Scene& from,
                                           SceneDraft& draft);

}  // namespace bandsaw
