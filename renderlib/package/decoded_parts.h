#pragma once

// Remembers the large parts of decoded scene packages as long as a scene uses the parts: meshes,
// and blobs (flat arrays). If a package that is decoded later has an equal part, it shares the
// remembered part. So for each frame of an animation only the parts that change are read.
// decode_package() (package.h) uses this class.

#include <cstddef>
#include <map>
#include <memory>
#include <string>

#include "proto/wire/digest.h"
#include "renderlib/geometry/mesh.h"
#include "renderlib/package/blob_source.h"

namespace bandsaw {

/// Not thread-safe. It keeps no part alive.
class DecodedParts {
 public:
  /// Returns the mesh whose message in a manifest (package::Mesh) has these bytes; nullptr: none is
  /// in use.
  std::shared_ptr<const Mesh> mesh(const std::string& message) const;
  /// Returns the blob with this digest; nullptr: it is not in use.
  std::shared_ptr<const BlobBytes> blob(const wire::Digest& digest) const;

  /// These functions remember a part as long as somebody uses it.
  void add(const std::string& message, const std::shared_ptr<const Mesh>& mesh);
  void add(const wire::Digest& digest, const std::shared_ptr<const BlobBytes>& blob);
  /// Forgets parts that nobody uses any more.
  void forget_unused();
  std::size_t size() const { return meshes_.size() + blobs_.size(); }

 private:
  std::map<std::string, std::weak_ptr<const Mesh>> meshes_;
  std::map<wire::Digest, std::weak_ptr<const BlobBytes>> blobs_;
};

}  // namespace bandsaw
