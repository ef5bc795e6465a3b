#pragma once

// Scene packages: the form in which a scene is sent over the network. A package is a manifest (a
// message of proto/package.proto) and the blobs (flat arrays) that it names by their SHA-256. This
// file encodes scene descriptions as packages and decodes packages. Decoding checks every index,
// count, value and digest.

#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "proto/wire/digest.h"
#include "renderlib/image/display.h"
#include "renderlib/package/blob_source.h"
#include "renderlib/package/decoded_parts.h"
#include "renderlib/package/encoded_parts.h"
#include "renderlib/scene/description.h"

namespace bandsaw {

/// The data of a package besides the scene itself: defaults for rendering it, and texts.
struct PackageInfo {
  std::string name;
  std::uint32_t width = 600;   ///< pixels
  std::uint32_t height = 400;  ///< pixels
  std::uint32_t max_depth = 32;
  std::vector<std::string> warnings;  ///< of the importer
  Integrator integrator = Integrator::kPath;
  Display display = {};
  std::vector<std::string> model_cameras = {};  ///< names of the cameras in the scene's models
};

/// A blob to which a manifest refers.
struct BlobRef {
  wire::Digest digest;
  std::uint64_t size = 0;
};

/// Adds the scene's arrays to `blobs` and returns the bytes of the manifest, which are not added.
/// `parts` remembers the last package that was encoded with it. Meshes, texels and grids that are
/// the same objects as in this last package are not added again.
std::string encode_package(const SceneDescription& scene, const PackageInfo& info, BlobMap& blobs,
                           EncodedParts* parts = nullptr);

/// Returns the PackageInfo. It is stored in the manifest itself, so no blobs are needed. Errors are
/// those of parse_manifest() (manifest.h): INVALID_ARGUMENT with the field.
absl::StatusOr<PackageInfo> package_info(const std::string& manifest);

/// Returns every blob to which a manifest refers, each once. Returns INVALID_ARGUMENT if the
/// manifest is broken or exceeds a limit.
absl::StatusOr<std::vector<BlobRef>> package_blobs(const std::string& manifest);

/// Returns the blobs that decode_package() would read now if it were called with this manifest and
/// `parts`. Their order and the errors are those of package_blobs().
absl::StatusOr<std::vector<BlobRef>> missing_blobs(const std::string& manifest,
                                                   const DecodedParts& parts);

/// Returns the scene, which is valid (scene/validate.h). Returns INVALID_ARGUMENT, with the field
/// that is wrong, if the manifest, a blob's size or the scene is not valid. Returns the errors of
/// `blobs`, such as NOT_FOUND or DATA_LOSS.
///
/// `parts` remembers meshes, texels and grids of earlier packages as long as some scene uses them.
/// The new scene shares the meshes, texels and grids that `parts` remembers. All others are read
/// and added to `parts`.
absl::StatusOr<SceneDescription> decode_package(const std::string& manifest, BlobSource& blobs,
                                                DecodedParts* parts = nullptr);

}  // namespace bandsaw
