#pragma once

// Selects cameras of models by name: the name of the node, or the camera's own if several nodes
// share that name, or "FILE/NODE" if several models have such a node.

#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "proto/scene.pb.h"
#include "renderlib/camera/camera.h"
#include "renderlib/import/draft/scene_draft.h"
#include "renderlib/import/model/model.h"
#include "renderlib/import/scene_file/field.h"

namespace bandsaw {

/// Adds a model's cameras, transformed by `to_world`, to the draft: once for each file, and not for
/// models in groups, which have no place of their own.
void add_cameras(const std::string& file, const Model& model, const Transform& to_world,
                 SceneDraft& draft);

/// Returns the names of the cameras that have a unique name; only the first ones if there are more
/// than a package can list.
std::vector<std::string> names_of(const std::vector<FoundCamera>& cameras);

/// Returns the camera that the scene file names, with the lens and shutter of the scene file. The
/// models MUST have been read. Returns INVALID_ARGUMENT, with the names of all cameras, if no
/// camera or several have this name.
absl::StatusOr<MovingCamera> use_camera(const Field& root, const scene::Scene& from,
                                        const SceneDraft& draft);

/// Returns a camera of a model with the shutter of the scene.
MovingCamera with_shutter(const FoundCamera& camera, const Shutter& shutter);

/// Returns the camera that the user named, with the lens of its file. The same errors.
absl::StatusOr<MovingCamera> chosen_camera(const std::string& name, const SceneDraft& draft);

}  // namespace bandsaw
