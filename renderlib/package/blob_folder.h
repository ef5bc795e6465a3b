#pragma once

// Blobs as files: `<folder>/<digest in hexadecimal>`, written once and never changed.

#include <string>
#include <utility>

#include "renderlib/package/blob_source.h"

namespace bandsaw {

/// Each get maps the file and hashes it; nothing is kept. Safe from any number of threads.
class BlobFolder : public BlobSource {
 public:
  explicit BlobFolder(std::string folder) : folder_(std::move(folder)) {}
  /// NOT_FOUND, DATA_LOSS as BlobSource says, or the system's reason, naming the file.
  absl::StatusOr<std::unique_ptr<BlobBytes>> get(const wire::Digest& digest) override;
  std::string path_of(const wire::Digest& digest) const { return folder_ + "/" + digest.hex(); }

 private:
  std::string folder_;
};

}  // namespace bandsaw
