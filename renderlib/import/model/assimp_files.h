#pragma once

// Assimp opens files only through the file systems of this header. With AssimpFiles, Assimp
// reads files of the scene's folder. With PlainGltfFiles, Assimp reads a rewritten glTF document in
// memory.

#include <assimp/IOSystem.hpp>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "absl/strings/string_view.h"
#include "renderlib/import/files/scene_folder.h"
#include "renderlib/import/model/mtl_options.h"

namespace bandsaw {

/// Maximum size of each file of a model, in bytes.
inline constexpr std::uint64_t kMaxModelFileBytes = std::uint64_t{8} << 30;

/// Files to which a model refers and which Assimp could not open. MUST outlive the Assimp importer,
/// which owns the AssimpFiles.
struct RefusedFiles {
  std::vector<std::string> missing;  ///< names as in the model
  std::vector<std::string> outside;  ///< error messages for files outside of the scene's folder
};

/// A model that Assimp opens.
struct ModelSource {
  std::string path;  ///< real path; for a model in memory, the path that it would have
  std::optional<absl::string_view> bytes;  ///< set for a model in memory; MUST outlive the reading
};

/// The files of the scene's folder. They cannot be written.
class AssimpFiles : public Assimp::IOSystem {
 public:
  /// The names of files other than the model are relative to the model's folder. The options of MTL
  /// files that Assimp opens are added to `mtl`. `folder`, `refused` and `mtl` MUST outlive this
  /// object.
  AssimpFiles(const SceneFolder& folder, const ModelSource& model, RefusedFiles& refused,
              MtlOptions& mtl)
      : folder_(folder),
        model_(model),
        model_folder_(folder_of(model.path)),
        refused_(refused),
        mtl_(mtl) {}

  bool Exists(const char* file) const override;
  char getOsSeparator() const override { return '/'; }
  Assimp::IOStream* Open(const char* file, const char* mode) override;
  void Close(Assimp::IOStream* stream) override;

 private:
  /// Returns the real path of a file. Returns NOT_FOUND if it is missing, PERMISSION_DENIED if it
  /// lies outside of the scene's folder or may not be read, and INVALID_ARGUMENT if `file` does
  /// not name a regular file.
  absl::StatusOr<std::string> find(const std::string& file) const;
  bool is_in_memory(const char* file) const { return model_.bytes && file == model_.path; }
  const SceneFolder& folder_;
  ModelSource model_;
  std::string model_folder_;
  RefusedFiles& refused_;
  MtlOptions& mtl_;
};

/// A glTF document in memory: its JSON under the name kDocument, its buffer under any other name.
class PlainGltfFiles : public Assimp::IOSystem {
 public:
  static constexpr char kDocument[] = "plain.gltf";
  /// Both arguments MUST outlive this object and the streams that it opens.
  PlainGltfFiles(absl::string_view json, absl::string_view buffer) : json_(json), buffer_(buffer) {}

  bool Exists(const char*) const override { return true; }
  char getOsSeparator() const override { return '/'; }
  Assimp::IOStream* Open(const char* file, const char* mode) override;
  void Close(Assimp::IOStream* stream) override;

 private:
  absl::string_view json_;
  absl::string_view buffer_;
};

}  // namespace bandsaw
