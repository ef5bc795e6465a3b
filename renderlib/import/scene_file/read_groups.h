#pragma once

// Reads the groups and the instances of a scene file. A group is a named list of shapes, models and
// instances. An instance places a group once or many times.

#include "absl/status/status.h"
#include "proto/scene.pb.h"
#include "renderlib/import/draft/scene_draft.h"
#include "renderlib/import/scene_file/field.h"

namespace bandsaw {

using InstanceList = google::protobuf::RepeatedPtrField<scene::Instance>;

/// Reads all groups of a scene file into SceneDraft::groups. Materials and shutter MUST have been
/// read.
absl::Status read_groups(const Field& root, const scene::Scene& from, SceneDraft& draft);

/// Reads the instances of `parent`, which is the scene or a group, into SceneDraft::placed. The
/// groups to which they refer MUST have been read.
absl::Status read_instances(const Field& parent, const InstanceList& instances, SceneDraft& draft);

}  // namespace bandsaw
