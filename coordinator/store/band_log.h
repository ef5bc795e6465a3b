#pragma once

// The bands of one job on disk: an append-only file of band records (renderlib/render/band_file.h).

#include <cstdint>
#include <string>

#include "absl/functional/function_ref.h"
#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "renderlib/base/file.h"
#include "renderlib/render/band_file.h"

namespace bandsaw::coordinator {

/// What reading a log found.
struct BandLogReport {
  std::uint64_t records = 0;        ///< whole ones, handed on
  std::uint64_t damaged_bytes = 0;  ///< of no record: skipped, and cut off where they are the end
};

class BandLog {
 public:
  /// Opens or makes the log `path` in `folder`, hands on every whole record with the byte it begins
  /// at, and cuts off what is left of an append that was interrupted. A damaged record is skipped
  /// and the reading goes on at the next one that is whole.
  static absl::StatusOr<BandLog> open(const std::string& folder, const std::string& path,
                                      absl::FunctionRef<void(BandRecord, std::uint64_t)> each,
                                      BandLogReport& report);

  /// The byte where the record begins. Not durable before sync. RESOURCE_EXHAUSTED: disk full; the
  /// log is as it was.
  absl::StatusOr<std::uint64_t> append(const BandRecord& record);
  /// One fdatasync for all appends since the last. On an error all of them are taken back: none of
  /// them is in the log.
  absl::Status sync();

  const std::string& path() const { return file_.path(); }

 private:
  BandLog(File file, std::uint64_t size) : file_(std::move(file)), synced_(size), size_(size) {}
  /// Back to a length that is known to be sound.
  absl::Status take_back(std::uint64_t size);

  File file_;
  std::uint64_t synced_ = 0;  ///< bytes on disk for sure
  std::uint64_t size_ = 0;    ///< bytes of whole records written
  bool torn_ = false;         ///< the file may be longer than size_: cut it before the next write
};

/// The record that begins at this byte of a log. NOT_FOUND: no such log. DATA_LOSS, OUT_OF_RANGE:
/// there is no whole one.
absl::StatusOr<BandRecord> read_band(const std::string& path, std::uint64_t offset);

}  // namespace bandsaw::coordinator
