#pragma once

// Blobs (pieces of scene data) whose upload was interrupted. For each of them, one file keeps the
// bytes received, so that the sender can resume. The bytes are not verified until the blob is
// complete and its digest is checked.
// Thread-safe; calls may block on the disk.

#include <cstdint>
#include <memory>
#include <set>
#include <string>

#include "absl/status/statusor.h"
#include "proto/wire/digest.h"
#include "renderlib/base/mutex.h"

namespace bandsaw::coordinator {

class PartialBlobs {
 public:
  /// Minimum size to keep; fewer bytes are quickly sent again.
  static constexpr std::uint64_t kMinBytes = 1 << 20;

  /// Creates the folder; removes everything in it that is not a partial blob.
  static absl::StatusOr<std::unique_ptr<PartialBlobs>> open(const std::string& folder);

  /// Returns the number of bytes from which an upload can resume; 0 while an upload is in progress.
  std::uint64_t size(const wire::Digest& digest) const EXCLUDES(mutex_);

  /// The right to write an incoming blob to a file. No other claim gets the same file while this
  /// claim exists.
  class Claim {
   public:
    Claim(PartialBlobs& all, std::string path, bool resumable)
        : all_(all), path_(std::move(path)), resumable_(resumable) {}
    Claim(const Claim&) = delete;
    Claim& operator=(const Claim&) = delete;
    /// If the file is resumable, makes the bytes left in it available as a partial blob.
    ~Claim();
    const std::string& path() const { return path_; }
    /// Returns true if an upload can be resumed from the bytes in the file, false if another claim
    /// already has the blob's own file.
    bool resumable() const { return resumable_; }

   private:
    PartialBlobs& all_;
    const std::string path_;
    const bool resumable_;
  };
  /// Claims the file of this blob. If this file is claimed already, claims another file, which is
  /// not resumable.
  std::unique_ptr<Claim> claim(const wire::Digest& digest) EXCLUDES(mutex_);

  /// Removes files that were not written to for `seconds`. `now`: seconds since 1970.
  void remove_unused(double now, double seconds) EXCLUDES(mutex_);

 private:
  explicit PartialBlobs(std::string folder) : folder_(std::move(folder)) {}
  std::string path_of(const wire::Digest& digest) const;
  void release(const Claim& claim) EXCLUDES(mutex_);
  /// Goes through the files from the newest to the oldest, and counts the files that it keeps and
  /// their bytes. Removes a file if keeping it would exceed wire::kPartialBlobs files or
  /// wire::kPartialBytes bytes.
  void trim() REQUIRES(mutex_);

  const std::string folder_;
  mutable Mutex mutex_;
  std::set<std::string> claimed_ GUARDED_BY(mutex_);  ///< paths of the files that are held
  /// Number of claimed files that were not resumable. Such a file is named by its number.
  std::uint64_t others_ GUARDED_BY(mutex_) = 0;
};

}  // namespace bandsaw::coordinator
