// The file systems through which Assimp opens files: AssimpFiles and PlainGltfFiles. They give
// Assimp the bytes of a file in memory. AssimpFiles finds files by SceneFolder, so Assimp cannot
// open a file outside of the scene's folder.

#include "renderlib/import/model/assimp_files.h"

#include <assimp/IOStream.hpp>

#include <algorithm>
#include <cstring>
#include <memory>

#include "absl/strings/match.h"
#include "absl/strings/strip.h"
#include "renderlib/base/file.h"

namespace bandsaw {
namespace {

// A stream that reads from bytes in memory. Assimp seeks often, which is fast here, and the file
// need not stay open.
class BytesStream : public Assimp::IOStream {
 public:
  /// `bytes` MUST outlive this object.
  explicit BytesStream(absl::string_view bytes) : bytes_(bytes) {}
  explicit BytesStream(std::string bytes) : owned_(std::move(bytes)), bytes_(owned_) {}

  std::size_t Read(void* to, std::size_t size, std::size_t count) override {
    if (size == 0) {
      return 0;
    }
    const std::size_t whole = std::min(count, (bytes_.size() - at_) / size);
    std::memcpy(to, bytes_.data() + at_, whole * size);
    at_ += whole * size;
    return whole;
  }
  std::size_t Write(const void*, std::size_t, std::size_t) override { return 0; }
  aiReturn Seek(std::size_t offset, aiOrigin origin) override {
    const std::size_t base = origin == aiOrigin_SET   ? 0
                             : origin == aiOrigin_CUR ? at_
                                                      : bytes_.size();
    // Assimp passes a negative offset as a wrapped unsigned number, and the sum wraps back.
    const std::size_t target = base + offset;
    if (target > bytes_.size()) {
      return aiReturn_FAILURE;
    }
    at_ = target;
    return aiReturn_SUCCESS;
  }
  std::size_t Tell() const override { return at_; }
  std::size_t FileSize() const override { return bytes_.size(); }
  void Flush() override {}

 private:
  std::string owned_;
  absl::string_view bytes_;
  std::size_t at_ = 0;
};

}  // namespace

absl::StatusOr<std::string> AssimpFiles::find(const std::string& file) const {
  // Assimp prepends the model's folder to names, and opens the model itself by its whole path.
  absl::string_view name = file;
  if (absl::StartsWith(name, model_folder_)) {
    name.remove_prefix(model_folder_.size());
    while (absl::ConsumePrefix(&name, "/")) {
    }
  }
  return folder_.resolve(std::string(name), model_folder_);
}

bool AssimpFiles::Exists(const char* file) const {
  if (is_in_memory(file)) {
    return true;
  }
  const auto path = find(file);
  if (absl::IsPermissionDenied(path.status())) {
    refused_.outside.emplace_back(path.status().message());
  }
  return path.ok();
}

Assimp::IOStream* AssimpFiles::Open(const char* file, const char* mode) {
  if (is_in_memory(file) && std::strchr(mode, 'w') == nullptr) {
    return std::make_unique<BytesStream>(*model_.bytes).release();
  }
  const auto path = find(file);
  if (absl::IsPermissionDenied(path.status())) {
    refused_.outside.emplace_back(path.status().message());
  }
  auto bytes = path.ok() && std::strchr(mode, 'w') == nullptr
                   ? read_whole_file(*path, kMaxModelFileBytes)
                   : absl::NotFoundError("");
  if (!bytes.ok()) {
    refused_.missing.push_back(name_of(file));
    return nullptr;
  }
  if (absl::EndsWithIgnoreCase(*path, ".mtl")) {
    add_mtl_options(*bytes, mtl_);
  }
  return std::make_unique<BytesStream>(*std::move(bytes)).release();
}

void AssimpFiles::Close(Assimp::IOStream* stream) {
  const std::unique_ptr<Assimp::IOStream> closed(stream);
}

Assimp::IOStream* PlainGltfFiles::Open(const char* file, const char* mode) {
  if (std::strchr(mode, 'w') != nullptr) {
    return nullptr;
  }
  const bool is_document = absl::EndsWith(file, kDocument);
  return std::make_unique<BytesStream>(is_document ? json_ : buffer_).release();
}

void PlainGltfFiles::Close(Assimp::IOStream* stream) {
  const std::unique_ptr<Assimp::IOStream> closed(stream);
}

}  // namespace bandsaw
