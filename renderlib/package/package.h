#pragma once

// Scene packages (proto/package.proto): encode a description, and decode one with every index,
// count and digest checked.

#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "proto/wire/digest.h"
#include "renderlib/image/display.h"
#include "renderlib/package/blob_source.h"
#include "renderlib/scene/description.h"

namespace bandsaw {

/// What a package says beside the scene itself.
struct PackageInfo {
  std::string name;
  std::uint32_t width = 600;
  std::uint32_t height = 400;
  std::uint32_t max_depth = 32;
  std::vector<std::string> warnings;
  Integrator integrator = Integrator::kPath;
  Display display = {};
  std::vector<std::string> model_cameras = {};  ///< names of cameras that its models bring
};

/// A blob that a manifest names.
struct BlobRef {
  wire::Digest digest;
  std::uint64_t size = 0;
};

/// Puts the scene's arrays into `blobs` and returns the manifest's bytes (not yet a blob
/// themselves).
std::string encode_package(const SceneDescription& scene, const PackageInfo& info, BlobMap& blobs);

/// What a manifest says, without its blobs; checks its form. INVALID_ARGUMENT naming the field.
absl::StatusOr<PackageInfo> package_info(const std::string& manifest);

/// Every blob that a manifest names, each once. INVALID_ARGUMENT: a broken manifest, or past a
/// limit.
absl::StatusOr<std::vector<BlobRef>> package_blobs(const std::string& manifest);

/// The scene. INVALID_ARGUMENT naming the field that is wrong; NOT_FOUND, DATA_LOSS: from `blobs`.
absl::StatusOr<SceneDescription> decode_package(const std::string& manifest, BlobSource& blobs);

}  // namespace bandsaw
