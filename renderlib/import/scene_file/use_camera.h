#pragma once

// Selects cameras of models by name. A camera is called by the name of its node, by its own name if
// no node has the name, or by "FILE/NODE", for example if several models have such a node.

#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "proto/scene.pb.h"
#include "renderlib/camera/camera.h"
#include "renderlib/import/draft/scene_draft.h"
#include "renderlib/import/model/model.h"
#include "renderlib/import/scene_file/field.h"

namespace bandsaw {

/// Adds a model's cameras to the draft. `at_open`, `at_close`: the transforms from the model to the
/// world when the shutter opens and when it closes. Does nothing if cameras of the same file have
/// been added, or if the model is in a group, which has no place of its own.
void add_cameras(const std::string& file, const Model& model, const Transform& at_open,
                 const Transform& at_close, SceneDraft& draft);

/// Returns one name for each camera: the first of its names, in the order above, by which only this
/// camera is found. Leaves out cameras without such a name, and all further cameras if there are
/// more than a package can list.
std::vector<std::string> names_of(const std::vector<FoundCamera>& cameras);

/// Returns the camera that the scene file names, with the lens and shutter of the scene file. The
/// models MUST have been read. Returns INVALID_ARGUMENT, with the names of all cameras, if no
/// camera has this name or several cameras have it.
absl::StatusOr<MovingCamera> use_camera(const Field& root, const scene::Scene& from,
                                        const SceneDraft& draft);

/// Returns a camera of a model with the shutter of the scene.
MovingCamera with_shutter(const FoundCamera& camera, const Shutter& shutter);

/// Returns the camera that the user named, with the lens of its model's file. Errors as
/// use_camera(), with the name of the scene file.
absl::StatusOr<MovingCamera> chosen_camera(const std::string& name, const SceneDraft& draft);

}  // namespace bandsaw
