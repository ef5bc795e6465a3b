#pragma once

// The coordinator's folder: its layout, and a lock that lets only one coordinator use it.

#include <string>

#include "absl/status/statusor.h"
#include "coordinator/scheduler/api/ids.h"
#include "proto/wire/limits.h"
#include "renderlib/base/file.h"

namespace bandsaw::coordinator {

/// Holds the folder's lock as long as the object exists. Layout: README.md of this folder.
class DataFolder {
 public:
  /// Creates the folder (mode 0700) if it does not exist; its parent MUST exist.
  /// FAILED_PRECONDITION: another coordinator uses it (the message names its process id), or it was
  /// written by another version of the format. DATA_LOSS: it has a journal, but the file with its
  /// format is missing.
  static absl::StatusOr<DataFolder> open(const std::string& path);

  const std::string& path() const { return path_; }
  // The functions below return paths of files and folders in the data folder. `id`: of a job.
  std::string journal() const { return path_ + "/journal.sqlite"; }
  std::string reserve() const { return path_ + "/reserve"; }
  std::string blobs() const { return path_ + "/blobs"; }
  std::string jobs() const { return path_ + "/jobs"; }
  std::string job(JobId id) const;
  std::string bands(JobId id) const { return job(id) + "/bands"; }
  std::string result(JobId id) const { return job(id) + "/result"; }
  /// File with the mean of the first part of each pixel's samples (Finished::first).
  std::string first(JobId id) const { return job(id) + "/first"; }
  /// File with the number of samples of each pixel of an adaptive job (Finished::samples).
  std::string samples(JobId id) const { return job(id) + "/samples"; }
  /// File that says which worker rendered which rows (attribution_file.h).
  std::string attribution(JobId id) const { return job(id) + "/attribution"; }
  /// The same file, with the name that older versions gave to it.
  std::string old_attribution(JobId id) const { return job(id) + "/credits"; }

 private:
  DataFolder(std::string path, File lock) : path_(std::move(path)), lock_(std::move(lock)) {}
  std::string path_;
  File lock_;
};

/// Returns OK if the disk accepts data and has space for `bytes`, which is by default the size of
/// the largest band. Tests this with a file: reserves the space, writes a little, syncs, and
/// removes the file.
absl::Status probe_disk(const std::string& folder, std::uint64_t bytes = wire::kBandBytes);

/// Returns the bytes that this user may still write on the disk of a folder, or the system's error.
absl::StatusOr<std::uint64_t> free_bytes(const std::string& folder);

}  // namespace bandsaw::coordinator
