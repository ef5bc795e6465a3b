#pragma once

#include "absl/status/statusor.h"
#include "proto/scene.pb.h"
#include "renderlib/camera/camera.h"
#include "renderlib/import/field.h"
#include "renderlib/import/scene_draft.h"

namespace bandsaw {

/// The camera of a model that the scene file names, with lens and shutter as the file says; the
/// models have been read.
absl::StatusOr<Camera> use_camera(const Field& root, const scene::Scene& from,
                                  const SceneDraft& draft);

}  // namespace bandsaw
