#pragma once

// Remembers the large parts (meshes, texels, grids) of the package that was encoded last, so that
// encode_package() (package.h) need not hash them again for the next frame of an animation.

#include <cstddef>
#include <memory>
#include <string>
#include <utility>

#include "proto/wire/digest.h"
#include "renderlib/base/kept_values.h"
#include "renderlib/base/shared_bytes.h"
#include "renderlib/geometry/mesh.h"

namespace bandsaw {

/// Keeps its parts alive until a package without them is encoded. The present package is the one
/// that is being encoded.
class EncodedParts {
 public:
  /// Returns true for a mesh of the last package.
  bool knows(const Mesh& mesh) const { return meshes_.contains(&mesh); }
  /// Returns the serialised message (package::Mesh) of the mesh if this same object was in the last
  /// package, otherwise nullptr. A mesh that is found becomes a part of the present package.
  const std::string* message_of(const Mesh& mesh);
  /// Returns the digest of the bytes if the same number of bytes at the same address was in the
  /// last package, otherwise nullptr. Bytes that are found become a part of the present package.
  const wire::Digest* digest_of(const SharedBytes& bytes);

  /// Adds a part to the present package.
  void add(std::shared_ptr<const Mesh> mesh, std::string message);
  void add(SharedBytes bytes, const wire::Digest& digest);
  /// Ends the present package: forgets the parts that were not in it.
  void end_package();

 private:
  struct KnownMesh {
    std::shared_ptr<const Mesh> mesh;
    std::string message;
  };
  struct KnownBytes {
    SharedBytes bytes;
    wire::Digest digest;
  };
  KeptValues<const Mesh*, KnownMesh> meshes_;
  /// Keyed by address and number of bytes.
  KeptValues<std::pair<const std::byte*, std::size_t>, KnownBytes> bytes_;
};

}  // namespace bandsaw
