#pragma once

// Finds a file that a field of the scene names: first among the files that the converter of another
// renderer's scene made, then in the scene's folder.

#include <cstdint>
#include <string>

#include "absl/status/statusor.h"
#include "renderlib/import/draft/scene_draft.h"

namespace bandsaw {

struct NamedFile {
  std::string key;                    ///< identifies the file: its real path, or "made:NAME"
  const std::string* made = nullptr;  ///< bytes of a file that a converter made, owned by the draft

  /// Returns the bytes. The error is RESOURCE_EXHAUSTED or INVALID_ARGUMENT if there are more than
  /// `max_bytes`, NOT_FOUND if the file has disappeared.
  absl::StatusOr<std::string> read(std::uint64_t max_bytes) const;
};

/// Finds the file to which a field refers by `name`. `draft` is the scene that is being read. The
/// errors are those of SceneFolder::resolve(): NOT_FOUND, INVALID_ARGUMENT or PERMISSION_DENIED.
absl::StatusOr<NamedFile> find_named_file(const std::string& name, const SceneDraft& draft);

}  // namespace bandsaw
