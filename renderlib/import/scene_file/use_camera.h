#pragma once

// Selects cameras of models by name. A node is the object of a model that carries a camera. A name
// is compared first with the names of the cameras' nodes. If no node has this name, the name is
// compared with the cameras' own names, and then with "FILE/NODE". "FILE/NODE" is useful if several
// models have a node of the same name.

#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "proto/scene.pb.h"
#include "renderlib/camera/camera.h"
#include "renderlib/import/draft/scene_draft.h"
#include "renderlib/import/model/model.h"
#include "renderlib/import/scene_file/field.h"

namespace bandsaw {

/// Adds a model's cameras to the draft. `at_open` and `at_close` are the transforms from the model
/// to the world when the shutter opens and when it closes. Does nothing if cameras of this file
/// have been added before. Does nothing if the model is in a group, because a group has no place in
/// the world.
void add_cameras(const std::string& file, const Model& model, const Transform& at_open,
                 const Transform& at_close, SceneDraft& draft);

/// Returns one name for each camera: the name of the node, the own name or "FILE/NODE". It is the
/// first of these three by which only this camera is found. Leaves out cameras without such a name,
/// and all further cameras if there are more than a package can list.
std::vector<std::string> names_of(const std::vector<FoundCamera>& cameras);

/// Returns the camera that the scene file names, with the lens and shutter of the scene file. The
/// models MUST have been read. Returns INVALID_ARGUMENT, with the names of all cameras, if no
/// camera has this name or several cameras have it.
absl::StatusOr<MovingCamera> use_camera(const Field& root, const scene::Scene& from,
                                        const SceneDraft& draft);

/// Returns a camera of a model with the shutter of the scene.
MovingCamera with_shutter(const FoundCamera& camera, const Shutter& shutter);

/// Returns the camera called `name`, which the user chose, with the lens of its model's file and
/// the shutter of the draft. Returns INVALID_ARGUMENT, with the names of all cameras, if no camera
/// has this name or several cameras have it. The message begins with the name of the scene file.
absl::StatusOr<MovingCamera> chosen_camera(const std::string& name, const SceneDraft& draft);

}  // namespace bandsaw
