#pragma once

// Runs `bandsaw-import`, which reads foreign files in a confined process with resource limits. A
// crash, a hang or excessive memory use in a parser becomes one clear error here.

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
  /// Parent folder of the temporary folder; empty: the system's default.
  std::string scratch;
  /// Setting it to true kills the child and makes the call return CANCELLED. May be nullptr.
  const std::atomic<bool>* stop = nullptr;
};

class Coprocess;

/// A temporary folder that is removed with its contents by the destructor.
class ScratchFolder;

/// An imported scene: its manifest, byte for byte as serialised by the importer, and its blobs in a
/// temporary folder that is removed with this object.
class ImportedPackage {
 public:
  ImportedPackage(std::shared_ptr<const ScratchFolder> folder, std::string manifest,
                  PackageInfo info);
  ~ImportedPackage();
  ImportedPackage(ImportedPackage&&) noexcept;
  ImportedPackage& operator=(ImportedPackage&&) noexcept;

  const std::string& manifest() const { return manifest_; }
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

/// A file that a scene or an archive names.
struct ListedFile {
  std::string name;   ///< relative, below the folder
  int number = kOld;  ///< the file's name in SceneFiles::folder_path; kOld: not copied there
  static constexpr int kOld = -1;  ///< the file lies below the folder of the foreign scene
};

/// A foreign scene that was converted to a Bandsaw scene file, and the files that this names.
struct SceneFiles {
  std::string text;
  std::vector<std::string> warnings;
  std::vector<ListedFile> list;
  std::string folder_path;
  std::shared_ptr<const ScratchFolder> folder;  ///< keeps folder_path
};

/// Imports a scene file or model; blocks until done. Errors name the file and, for a scene file,
/// line and column. INVALID_ARGUMENT, NOT_FOUND, PERMISSION_DENIED: a problem with the file, or
/// with one that it references. DEADLINE_EXCEEDED, RESOURCE_EXHAUSTED: a limit was exceeded.
/// DATA_LOSS: the importer crashed. CANCELLED: `stop`, or Ctrl-C. FAILED_PRECONDITION: the program
/// is missing. If `scene_path` is a zip file, imports the scene `choices.inside` in it. If that is
/// empty, imports the only scene in the zip file: the outermost .textproto, if there is none the
/// outermost .pbrt or .xml, if there is none the outermost model.
absl::StatusOr<ImportedPackage> import_in_process(const std::string& scene_path,
                                                  const ImportLimits& limits = {},
                                                  const SceneChoices& choices = {});

/// Imports a scene at many frames, by one process that reads its files once.
class ImportSession {
 public:
  /// `choices.frame` is ignored. Starts the process. Errors as import_in_process.
  static absl::StatusOr<std::unique_ptr<ImportSession>> start(const std::string& scene_path,
                                                              const ImportLimits& limits,
                                                              SceneChoices choices);
  ~ImportSession();
  ImportSession(const ImportSession&) = delete;
  ImportSession& operator=(const ImportSession&) = delete;

  /// Imports the scene at a frame. The package of the frame before is not valid any more. The
  /// seconds of the limits are for each frame. Setting `stop` ends the process. Errors as
  /// import_in_process; the session is over then.
  absl::StatusOr<ImportedPackage> import(std::int64_t frame, const std::atomic<bool>* stop);

 private:
  ImportSession(std::string scene, double seconds, std::shared_ptr<const ScratchFolder> unpacked,
                std::shared_ptr<const ScratchFolder> folder, std::unique_ptr<Coprocess> importer);

  const std::string scene_;
  const double seconds_;
  const std::shared_ptr<const ScratchFolder> unpacked_;  ///< files of a zip file; nullptr: none
  const std::shared_ptr<const ScratchFolder> folder_;    ///< the package
  const std::unique_ptr<Coprocess> importer_;
};

/// Converts a scene of pbrt or Mitsuba, or a model, to a scene file of ours. Same errors.
absl::StatusOr<SceneFiles> scene_files_in_process(const std::string& scene_path,
                                                  const ImportLimits& limits = {},
                                                  const SceneChoices& choices = {});

/// Reads a picture and converts it to linear values: PNG, JPEG, TGA, BMP, PNM, HDR, PFM. Same
/// limits and errors.
absl::StatusOr<Image> read_image_in_process(const std::string& path,
                                            const ImportLimits& limits = {});

}  // namespace bandsaw::coordinator
