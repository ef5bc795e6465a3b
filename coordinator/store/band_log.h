#pragma once

// The band log of one job: an append-only file of band records. A record has the result of one band
// (a range of rows and samples): the sums of its pixels, as a worker rendered them
// (renderlib/render/band_file.h).

#include <cstdint>
#include <string>

#include "absl/functional/function_ref.h"
#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "renderlib/base/file.h"
#include "renderlib/render/band_file.h"

namespace bandsaw::coordinator {

/// Result of reading a log.
struct BandLogReport {
  std::uint64_t records = 0;  ///< complete records, passed to the callback
  /// Number of bytes that belong to no complete record. They are skipped. If they are at the end of
  /// the log, they are truncated, unless the disk could not read some bytes of the log.
  std::uint64_t damaged_bytes = 0;
};

class BandLog {
 public:
  /// Opens or creates the log `path` in `folder`, calls `each` with every complete record and its
  /// byte offset, and truncates the remains of an interrupted append. A record that is damaged, or
  /// that the disk cannot read, is skipped; reading continues at the next complete one. Nothing is
  /// truncated if the disk could not read some bytes.
  static absl::StatusOr<BandLog> open(const std::string& folder, const std::string& path,
                                      absl::FunctionRef<void(BandRecord, std::uint64_t)> each,
                                      BandLogReport& report);

  /// Appends a record and returns its byte offset. Not durable before sync(). RESOURCE_EXHAUSTED:
  /// the disk is full; the log is unchanged.
  absl::StatusOr<std::uint64_t> append(const BandRecord& record);
  /// Makes all appends since the last call durable, with one fdatasync. If it fails, all of them
  /// are removed from the log.
  absl::Status sync();

  const std::string& path() const { return file_.path(); }

 private:
  BandLog(File file, std::uint64_t size) : file_(std::move(file)), synced_(size), size_(size) {}
  /// Truncates the log to a length that is known to be valid.
  absl::Status take_back(std::uint64_t size);

  File file_;
  std::uint64_t synced_ = 0;  ///< bytes known to be on disk
  std::uint64_t size_ = 0;    ///< bytes of complete records written
  bool torn_ = false;  ///< the file may be longer than size_; truncate it before the next write
};

/// Reads the record at this byte offset of a log. NOT_FOUND: no such log. DATA_LOSS, OUT_OF_RANGE:
/// no complete record begins at this offset.
absl::StatusOr<BandRecord> read_band(const std::string& path, std::uint64_t offset);

}  // namespace bandsaw::coordinator
