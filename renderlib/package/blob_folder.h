#pragma once

// Reads blobs (the parts of a scene package, named by their SHA-256) from files
// `<folder>/<digest in hexadecimal>`, which are written once and never changed.

#include <string>
#include <utility>

#include "renderlib/package/blob_source.h"

namespace bandsaw {

/// Each call of get() maps the file and hashes it; nothing is cached. Thread-safe.
class BlobFolder : public BlobSource {
 public:
  explicit BlobFolder(std::string folder) : folder_(std::move(folder)) {}
  /// Returns NOT_FOUND or DATA_LOSS as in BlobSource, or the system's error, with the file's name.
  absl::StatusOr<std::unique_ptr<BlobBytes>> get(const wire::Digest& digest) override;
  std::string path_of(const wire::Digest& digest) const { return folder_ + "/" + digest.hex(); }

 private:
  std::string folder_;
};

}  // namespace bandsaw
