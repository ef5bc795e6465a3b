#pragma once

// Runs `bandsaw-import`, which reads scenes, models and pictures in a confined process with
// resource limits, because they may come from strangers. A crash, a hang or excessive memory use in
// a parser becomes one clear error here. The result is a scene package: a manifest, which describes
// the scene, and blobs, its arrays.

#include <atomic>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "coordinator/cli/options/scene_choices.h"
#include "renderlib/image/image.h"
#include "renderlib/package/blob_folder.h"
#include "renderlib/package/package.h"

namespace bandsaw::coordinator {

struct ImportLimits {
  double seconds = 300;                     ///< wall-clock time, and CPU time of the child
  std::uint64_t memory_bytes = 8ull << 30;  ///< address space of the child
  /// Program to run; empty: `bandsaw-import` in the folder of the running program.
  std::string program;
  /// Folder in which temporary folders are made; empty: the system's default.
  std::string scratch;
  /// If another thread sets it to true, the child is killed and the call returns CANCELLED. May be
  /// nullptr.
  const std::atomic<bool>* stop = nullptr;
};

class Coprocess;

class ScratchFolder;  // coordinator/store/scratch_folder.h

/// An imported scene. Its blobs are in a temporary folder that is removed with this object.
class ImportedPackage {
 public:
  ImportedPackage(std::shared_ptr<const ScratchFolder> folder, std::string manifest,
                  PackageInfo info);
  ~ImportedPackage();
  ImportedPackage(ImportedPackage&&) noexcept;
  ImportedPackage& operator=(ImportedPackage&&) noexcept;

  /// Returns the manifest, byte for byte as the importer has serialised it.
  const std::string& manifest() const { return manifest_; }
  /// Returns what the manifest says about the image: its name, size, warnings and the like.
  const PackageInfo& info() const { return info_; }
  BlobFolder& blobs() { return blobs_; }

 private:
  std::shared_ptr<const ScratchFolder> folder_;
  std::string manifest_;
  PackageInfo info_;
  BlobFolder blobs_;
};

/// Returns the path of the import program. FAILED_PRECONDITION: it is missing.
absl::StatusOr<std::string> import_program(const ImportLimits& limits = {});

/// A file that a converted scene names, or that a zip file has.
struct ListedFile {
  /// Path relative to the folder of the scene file or of the zip file's contents; has no "..".
  std::string name;
  /// The importer has written the file to its output folder, with this number as the file name. For
  /// a converted scene, the output folder is SceneFiles::folder_path. kOld: the importer has not
  /// written the file, because the file is in the folder of the scene that was converted.
  int number = kOld;
  static constexpr int kOld = -1;
};

/// A scene of another format that was converted to a scene file, and the files that the scene file
/// names.
struct SceneFiles {
  std::string text;                             ///< the contents of the scene file
  std::vector<std::string> warnings;            ///< sentences about what was left out
  std::vector<ListedFile> list;                 ///< the files that the scene file names
  std::string folder_path;                      ///< temporary folder with the written files
  std::shared_ptr<const ScratchFolder> folder;  ///< removes that folder when it is destroyed
};

/// Returns a time limit in seconds for the import of the scene file `path`: `seconds`, and one
/// second more for each 4 MB of files in the folder of `path` and below, because a large scene
/// takes long.
double import_timeout_s(const std::string& path, double seconds);

/// Imports a scene file, a scene of pbrt or Mitsuba, or a model; blocks until done. The message of
/// an error names the file and, for a scene file, line and column. INVALID_ARGUMENT, NOT_FOUND,
/// PERMISSION_DENIED: there is a problem with the file, or with one that it references.
/// DEADLINE_EXCEEDED, RESOURCE_EXHAUSTED: a limit was exceeded. DATA_LOSS: the importer crashed.
/// CANCELLED: limits.stop was set, or Ctrl-C ended the importer. FAILED_PRECONDITION: the program
/// is missing.
///
/// If `scene_path` is a zip file, imports the scene `choices.inside` in it. If `choices.inside` is
/// empty, imports the only scene in the zip file. This scene is searched for in the first of these
/// groups that has a file: .textproto; .pbrt and .xml; .pbrt.gz; .glb and .gltf; .json; other
/// models. Of this group, only the files with the fewest folders in their paths are considered.
absl::StatusOr<ImportedPackage> import_in_process(const std::string& scene_path,
                                                  const ImportLimits& limits = {},
                                                  const SceneChoices& choices = {});

/// Imports a scene at many frames of its animation. One process imports all of them and reads the
/// files of the scene only once.
class ImportSession {
 public:
  /// Starts the process. `choices.frame` is ignored. limits.stop only ends the unpacking of a zip
  /// file. Errors as import_in_process.
  static absl::StatusOr<std::unique_ptr<ImportSession>> start(const std::string& scene_path,
                                                              const ImportLimits& limits,
                                                              SceneChoices choices);
  ~ImportSession();
  ImportSession(const ImportSession&) = delete;
  ImportSession& operator=(const ImportSession&) = delete;

  /// Imports the scene at a frame. The package of the frame before becomes invalid. The time limit
  /// applies to each frame. If `stop` is set, the process ends; nullptr: it cannot be stopped.
  /// Errors as import_in_process; after an error import() MUST NOT be called again.
  absl::StatusOr<ImportedPackage> import(std::int64_t frame, const std::atomic<bool>* stop);

 private:
  ImportSession(std::string scene, double seconds, std::shared_ptr<const ScratchFolder> unpacked,
                std::shared_ptr<const ScratchFolder> folder, std::unique_ptr<Coprocess> importer);

  const std::string scene_;
  const double seconds_;
  const std::shared_ptr<const ScratchFolder> unpacked_;  ///< files of a zip file; nullptr: none
  const std::shared_ptr<const ScratchFolder> folder_;    ///< has the package of the last frame
  const std::unique_ptr<Coprocess> importer_;
};

/// Converts a scene of pbrt or Mitsuba, or a model, to a scene file, for `bandsaw import`. Errors
/// as import_in_process.
absl::StatusOr<SceneFiles> scene_files_in_process(const std::string& scene_path,
                                                  const ImportLimits& limits = {},
                                                  const SceneChoices& choices = {});

/// Reads a picture (PNG, JPEG, TGA, BMP, PNM, HDR, PFM) and converts it to linear values, for
/// `bandsaw compare`. Errors as import_in_process.
absl::StatusOr<Image> read_image_in_process(const std::string& path,
                                            const ImportLimits& limits = {});

}  // namespace bandsaw::coordinator
