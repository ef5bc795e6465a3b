#pragma once

// Decompression with bounds: gzip, zlib and raw deflate.

#include <cstdint>
#include <string>

#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"

namespace bandsaw {

enum class DeflateKind {
  kGzip,  ///< gzip or zlib; the header tells which
  kRaw,   ///< without a header, as in zip files
};

/// Returns the decompressed bytes. The error is INVALID_ARGUMENT if the data are damaged or
/// truncated, or if other bytes follow the data. (A gzip file may have several members, one after
/// the other.) The error is RESOURCE_EXHAUSTED if the result has more than `max_bytes`, or if there
/// are more than 4 GiB of compressed data. Messages have no file name.
absl::StatusOr<std::string> inflate(absl::string_view bytes, DeflateKind kind,
                                    std::uint64_t max_bytes);

/// Returns true if the bytes begin as a gzip file does.
bool is_gzip(absl::string_view bytes);

}  // namespace bandsaw
