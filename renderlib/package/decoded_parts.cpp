// Holds weak references to parts of packages that were decoded earlier: a part can be found as long
// as a scene holds it.

#include "renderlib/package/decoded_parts.h"

namespace bandsaw {
namespace {

template <class Parts, class Key>
auto found_in(const Parts& parts, const Key& key) {
  const auto found = parts.find(key);
  return found == parts.end() ? decltype(found->second.lock())() : found->second.lock();
}

}  // namespace

std::shared_ptr<const Mesh> DecodedParts::mesh(const std::string& message) const {
  return found_in(meshes_, message);
}

std::shared_ptr<const BlobBytes> DecodedParts::blob(const wire::Digest& digest) const {
  return found_in(blobs_, digest);
}

void DecodedParts::add(const std::string& message, const std::shared_ptr<const Mesh>& mesh) {
  meshes_[message] = mesh;
}

void DecodedParts::add(const wire::Digest& digest, const std::shared_ptr<const BlobBytes>& blob) {
  blobs_[digest] = blob;
}

void DecodedParts::forget_unused() {
  const auto unused = [](const auto& part) { return part.second.expired(); };
  std::erase_if(meshes_, unused);
  std::erase_if(blobs_, unused);
}

}  // namespace bandsaw
