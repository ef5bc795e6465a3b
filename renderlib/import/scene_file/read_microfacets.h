#pragma once

// Materials of a scene file whose surface is a microfacet distribution.

#include "absl/status/statusor.h"
#include "proto/scene.pb.h"
#include "renderlib/import/draft/scene_draft.h"
#include "renderlib/import/scene_file/field.h"

namespace bandsaw {

/// `in` is the message itself.
absl::StatusOr<Microfacets> read_microfacets(const Field& in, const scene::Microfacets& from,
                                             SceneDraft& draft);
absl::StatusOr<Material> read_conductor(const Field& in, const scene::Conductor& from,
                                        SceneDraft& draft);
absl::StatusOr<Material> read_plastic(const Field& in, const scene::Plastic& from,
                                      SceneDraft& draft);

}  // namespace bandsaw
