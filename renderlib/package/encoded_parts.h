#pragma once

// Large parts of the package that was encoded last, so that the package of the next frame of a
// sequence does not hash them again.

#include <cstddef>
#include <memory>
#include <string>
#include <utility>

#include "proto/wire/digest.h"
#include "renderlib/base/kept_values.h"
#include "renderlib/base/shared_bytes.h"
#include "renderlib/geometry/mesh.h"

namespace bandsaw {

/// Keeps its parts alive until a package without them is encoded.
class EncodedParts {
 public:
  /// Returns true for a mesh of the last package.
  bool knows(const Mesh& mesh) const { return meshes_.contains(&mesh); }
  /// Returns the message of a mesh of the last package (package::Mesh), which becomes part of this
  /// one; nullptr: it was not in it.
  const std::string* message_of(const Mesh& mesh);
  /// Returns the digest of bytes of the last package with the same address, which become part of
  /// this one; nullptr: they were not in it.
  const wire::Digest* digest_of(const SharedBytes& bytes);

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
