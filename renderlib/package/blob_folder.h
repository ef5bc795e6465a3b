#pragma once

// Reads blobs (the parts of a scene package, named by their SHA-256) from files
// `<folder>/<digest in hexadecimal>`, which are written once and never changed.

#include <cstdint>
#include <string>
#include <utility>

#include "renderlib/base/file.h"
#include "renderlib/package/blob_source.h"

namespace bandsaw {

/// Returns the digest of the first `size` bytes of an open file; `path` is for errors. Returns
/// DATA_LOSS if the bytes cannot be read or the file is shorter. The file is not mapped, because
/// SIGBUS ends a process that reads a bad sector of a mapped file.
absl::StatusOr<wire::Digest> digest_of_file(int fd, std::uint64_t size, const std::string& path);

/// Returns the bytes of an open file, mapped into memory. After the call the file may be closed.
/// Errors are those of MappedFile.
absl::StatusOr<std::unique_ptr<BlobBytes>> map_blob(const File& file);

/// The blobs of a folder. Each call of get() hashes the file and maps it; nothing is cached.
/// Thread-safe.
class BlobFolder : public BlobSource {
 public:
  explicit BlobFolder(std::string folder) : folder_(std::move(folder)) {}
  /// Returns NOT_FOUND if the folder has no such file, and DATA_LOSS if the file is not a regular
  /// file, if it cannot be read, or if its bytes do not have the digest. Other errors are those of
  /// the system. All messages name the file.
  absl::StatusOr<std::unique_ptr<BlobBytes>> get(const wire::Digest& digest) override;
  std::string path_of(const wire::Digest& digest) const { return folder_ + "/" + digest.hex(); }

 private:
  std::string folder_;
};

}  // namespace bandsaw
