#pragma once

// Reads the materials of a scene file whose surface is a microfacet distribution.

#include "absl/status/statusor.h"
#include "proto/scene.pb.h"
#include "renderlib/import/draft/scene_draft.h"
#include "renderlib/import/scene_file/field.h"

namespace bandsaw {

/// In each function, `in` is the field that holds the message `from`. The functions return
/// INVALID_ARGUMENT, with the name of the field, if a field is invalid.
absl::StatusOr<Microfacets> read_microfacets(const Field& in, const scene::Microfacets& from,
                                             SceneDraft& draft);
absl::StatusOr<Material> read_conductor(const Field& in, const scene::Conductor& from,
                                        SceneDraft& draft);
absl::StatusOr<Material> read_plastic(const Field& in, const scene::Plastic& from,
                                      SceneDraft& draft);

}  // namespace bandsaw
