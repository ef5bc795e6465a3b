// Finds a file that a scene names, first among the files that a converter made, then in the scene's
// folder.

#include "renderlib/import/draft/named_file.h"

#include "absl/strings/str_cat.h"
#include "renderlib/base/file.h"
#include "renderlib/base/status_macros.h"

namespace bandsaw {

absl::StatusOr<std::string> NamedFile::read(std::uint64_t max_bytes) const {
  if (made == nullptr) {
    return read_whole_file(key, max_bytes);
  }
  if (made->size() > max_bytes) {
    return absl::InvalidArgumentError(
        absl::StrCat("has ", made->size(), " bytes, at most ", max_bytes, " are read"));
  }
  return *made;
}

absl::StatusOr<NamedFile> find_named_file(const std::string& name, const SceneDraft& draft) {
  if (const auto made = draft.made_files->find(name); made != draft.made_files->end()) {
    return NamedFile{absl::StrCat("made:", name), &made->second};
  }
  ASSIGN_OR_RETURN(std::string path, draft.folder.resolve(name, draft.folder.path()));
  return NamedFile{std::move(path)};
}

}  // namespace bandsaw
