#pragma once

// Runs `bandsaw-import`: foreign files are read in a process of their own, confined and bounded, so
// that a crash, a hang or an allocation bomb in a parser is one clear error here.

#include <atomic>
#include <cstdint>
#include <memory>
#include <string>

#include "absl/status/statusor.h"
#include "coordinator/cli/options/scene_choices.h"
#include "renderlib/image/image.h"
#include "renderlib/package/blob_folder.h"
#include "renderlib/package/package.h"

namespace bandsaw::coordinator {

struct ImportLimits {
  double seconds = 300;                     ///< wall clock, and CPU time of the child
  std::uint64_t memory_bytes = 8ull << 30;  ///< address space of the child
  /// The program to run; empty: `bandsaw-import` in the folder of the running program.
  std::string program;
  /// Where the temporary folder is made; empty: the system's.
  std::string scratch;
  /// When it becomes true the child is killed and the call returns CANCELLED. May be null.
  const std::atomic<bool>* stop = nullptr;
};

/// A folder that is removed, with everything in it, by the last owner.
class ScratchFolder;

/// An imported scene: its manifest, byte for byte as the importer serialised it, and its blobs in a
/// temporary folder that lives as long as this value.
class ImportedPackage {
 public:
  ImportedPackage(std::unique_ptr<ScratchFolder> folder, std::string manifest, PackageInfo info);
  ~ImportedPackage();
  ImportedPackage(ImportedPackage&&) noexcept;
  ImportedPackage& operator=(ImportedPackage&&) noexcept;

  const std::string& manifest() const { return manifest_; }
  const PackageInfo& info() const { return info_; }
  BlobFolder& blobs() { return blobs_; }

 private:
  std::unique_ptr<ScratchFolder> folder_;
  std::string manifest_;
  PackageInfo info_;
  BlobFolder blobs_;
};

/// The program that would be run. FAILED_PRECONDITION: it is missing.
absl::StatusOr<std::string> import_program(const ImportLimits& limits = {});

/// Blocks until the scene file or model is imported. Errors name the file and, in a scene file,
/// line and column: INVALID_ARGUMENT, NOT_FOUND, PERMISSION_DENIED: what is wrong with the file, or
/// with one that it refers to. DEADLINE_EXCEEDED, RESOURCE_EXHAUSTED: past a limit. DATA_LOSS: the
/// importer crashed. CANCELLED: `stop`, or Ctrl-C. FAILED_PRECONDITION: the program is missing.
absl::StatusOr<ImportedPackage> import_in_process(const std::string& scene_path,
                                                  const ImportLimits& limits = {},
                                                  const SceneChoices& choices = {});

/// A picture, linear: PNG, JPEG, TGA, BMP, PNM, HDR, PFM. The same limits and errors.
absl::StatusOr<Image> read_image_in_process(const std::string& path,
                                            const ImportLimits& limits = {});

}  // namespace bandsaw::coordinator
