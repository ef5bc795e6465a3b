#include "renderlib/package/encoded_parts.h"

#include <utility>

namespace bandsaw {

const std::string* EncodedParts::message_of(const Mesh& mesh) {
  const auto found = meshes_.find(&mesh);
  if (found == meshes_.end()) {
    return nullptr;
  }
  found->second.used = true;
  return &found->second.message;
}

const wire::Digest* EncodedParts::digest_of(const SharedBytes& bytes) {
  const auto found = bytes_.find(bytes.data());
  if (found == bytes_.end() || found->second.bytes.size() != bytes.size()) {
    return nullptr;
  }
  found->second.used = true;
  return &found->second.digest;
}

void EncodedParts::add(std::shared_ptr<const Mesh> mesh, std::string message) {
  const Mesh* key = mesh.get();
  meshes_[key] = {std::move(mesh), std::move(message)};
}

void EncodedParts::add(SharedBytes bytes, const wire::Digest& digest) {
  const std::byte* key = bytes.data();
  bytes_[key] = {std::move(bytes), digest};
}

void EncodedParts::end_package() {
  const auto forget_unused = [](auto& parts) {
    std::erase_if(parts, [](const auto& part) { return !part.second.used; });
    for (auto& part : parts) {
      part.second.used = false;
    }
  };
  forget_unused(meshes_);
  forget_unused(bytes_);
}

}  // namespace bandsaw
