#pragma once

// Cameras that models bring, by their names: that of the node, else the camera's own where several
// nodes are called so, else "FILE/NODE" where several models have such a node.

#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "proto/scene.pb.h"
#include "renderlib/camera/camera.h"
#include "renderlib/import/draft/scene_draft.h"
#include "renderlib/import/model/model.h"
#include "renderlib/import/scene_file/field.h"

namespace bandsaw {

/// Makes a model's cameras known where `to_world` puts them: once for each file, and not those of
/// models in groups, which stand nowhere by themselves.
void add_cameras(const std::string& file, const Model& model, const Transform& to_world,
                 SceneDraft& draft);

/// A name for each camera that has one of its own; of more than a package says, for the first.
std::vector<std::string> names_of(const std::vector<FoundCamera>& cameras);

/// The camera that the scene file names, with lens and shutter as the file says; the models have
/// been read. INVALID_ARGUMENT: no camera or several are called so; the error lists what there is.
absl::StatusOr<Camera> use_camera(const Field& root, const scene::Scene& from,
                                  const SceneDraft& draft);

/// The camera that somebody named beside the scene, as its file describes it. The same errors.
absl::StatusOr<Camera> chosen_camera(const std::string& name, const SceneDraft& draft);

}  // namespace bandsaw
