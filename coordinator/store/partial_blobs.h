#pragma once

// Blobs whose upload was cut: as many of their bytes as came, a file each, for a sender who goes on
// from there. Nothing is known of these bytes until the whole has its digest. Thread-safe; calls
// may block on the disk.

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
  /// What is worth keeping: less is sent again as soon.
  static constexpr std::uint64_t kLeastBytes = 1 << 20;

  /// Makes the folder; what is in it and is no partial blob is removed.
  static absl::StatusOr<std::unique_ptr<PartialBlobs>> open(const std::string& folder);

  /// How many bytes of it are there to go on from; 0 while somebody sends it.
  std::uint64_t size(const wire::Digest& digest) const EXCLUDES(mutex_);

  /// A file for a blob that comes in. While it is held no other claim gets this file.
  class Claim {
   public:
    Claim(PartialBlobs& all, std::string path, bool resumable)
        : all_(all), path_(std::move(path)), resumable_(resumable) {}
    Claim(const Claim&) = delete;
    Claim& operator=(const Claim&) = delete;
    /// What was left there counts as a partial blob from now on.
    ~Claim();
    const std::string& path() const { return path_; }
    /// Whether what is left there is found again: not where another claim has the blob's own file.
    bool resumable() const { return resumable_; }

   private:
    PartialBlobs& all_;
    const std::string path_;
    const bool resumable_;
  };
  std::unique_ptr<Claim> claim(const wire::Digest& digest) EXCLUDES(mutex_);

  /// Removes what was not written to for so long. `now`: seconds since 1970.
  void remove_unused(double now, double seconds) EXCLUDES(mutex_);

 private:
  explicit PartialBlobs(std::string folder) : folder_(std::move(folder)) {}
  std::string path_of(const wire::Digest& digest) const;
  void release(const Claim& claim) EXCLUDES(mutex_);
  /// Removes the oldest beyond wire::kPartialBlobs and wire::kPartialBytes.
  void trim() REQUIRES(mutex_);

  const std::string folder_;
  mutable Mutex mutex_;
  std::set<std::string> claimed_ GUARDED_BY(mutex_);  ///< paths
  std::uint64_t others_ GUARDED_BY(mutex_) = 0;
};

}  // namespace bandsaw::coordinator
