// Remembers the encoded messages of meshes and the digests of bytes until a package no longer uses
// them.

#include "renderlib/package/encoded_parts.h"

#include <utility>

namespace bandsaw {

const std::string* EncodedParts::message_of(const Mesh& mesh) {
  const KnownMesh* known = meshes_.find(&mesh);
  return known != nullptr ? &known->message : nullptr;
}

const wire::Digest* EncodedParts::digest_of(const SharedBytes& bytes) {
  const KnownBytes* known = bytes_.find({bytes.data(), bytes.size()});
  return known != nullptr ? &known->digest : nullptr;
}

void EncodedParts::add(std::shared_ptr<const Mesh> mesh, std::string message) {
  const Mesh* key = mesh.get();
  meshes_.set(key, {std::move(mesh), std::move(message)});
}

void EncodedParts::add(SharedBytes bytes, const wire::Digest& digest) {
  const std::pair key(bytes.data(), bytes.size());
  bytes_.set(key, {std::move(bytes), digest});
}

void EncodedParts::end_package() {
  meshes_.end_round();
  bytes_.end_round();
}

}  // namespace bandsaw
