#pragma once

// Files of bands. A band is a range of samples for some rows of an image, and a record holds the
// sums of these samples for each pixel. `bandsaw render --rows` writes such files, `bandsaw stitch`
// reads them, and the coordinator stores them. A file is a sequence of self-describing records.
//
// A record, little-endian, no padding:
//   "BSWBAND4"                                          8 bytes: magic and format version
//   size of the whole record                            u64
//   package digest                                      64 lower-case hexadecimal digits
//   width, height                                       u32 each
//   max_depth, integrator                               u16 each
//   seed                                                u64
//   first sample, last sample (past the end)            u64 each
//   first row, last row (past the end)                  u32 each
//   rays, bad_samples                                   u64 each
//   bad_x, bad_y                                        u32 each
//   bad_sample                                          u64
//   negative_samples, truncated_paths                   u64 each
//   dropped_primitives                                  u64
//   techniques, training_rays                           u32, u64
//   cpu_s                                               f64
//   id of the worker process                            u64
//   sums                                                f64 x rows x width x 3
//   hash of all bytes above (render/hash64.h)           u64
//
// The fields from rays to training_rays are the Counters of the band (band.h).

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "absl/types/span.h"
#include "renderlib/render/band.h"
#include "renderlib/render/settings.h"

namespace bandsaw {

/// The first bytes of a record. The last of them is the format version. A reader that meets a
/// damaged record searches for these bytes to find the next record.
inline constexpr std::array<char, 8> kBandRecordMagic = {'B', 'S', 'W', 'B', 'A', 'N', 'D', '4'};

/// The content of a record.
struct BandRecord {
  std::string package_digest;  ///< 64 lower-case hexadecimal digits
  RenderSettings settings;
  BandPixels pixels;
  double cpu_s = 0;           ///< CPU time, summed over threads, >= 0; 0: unknown
  std::uint64_t process = 0;  ///< identifies the process that rendered the band; 0: unknown
};

/// Returns the size of a band's record in bytes.
std::uint64_t band_record_size(const Band& band, std::uint32_t width);

/// Serialises a record. Returns INVALID_ARGUMENT if the record is inconsistent (digest, band,
/// number of sums, counters, CPU time).
absl::StatusOr<std::vector<std::byte>> encode_band_record(const BandRecord& record);

struct DecodedBandRecord {
  BandRecord record;
  std::uint64_t size = 0;  ///< size in bytes; the next record begins after it
};

/// Parses the record at byte `offset` of `bytes` and checks every field. Messages begin with "byte
/// N: ", where N counts from the start of `bytes`. Returns OUT_OF_RANGE if the bytes end before the
/// record does (a truncated file). Returns DATA_LOSS if the bytes are not a record of this format,
/// or if the record is damaged.
absl::StatusOr<DecodedBandRecord> decode_band_record(absl::Span<const std::byte> bytes,
                                                     std::uint64_t offset = 0);

/// Returns a digest for each row, computed from the bits of the row's sums. Rows with equal sums
/// have equal digests. The coordinator compares them when a second machine renders the same rows
/// (an audit).
std::vector<std::uint64_t> row_digests(const BandPixels& pixels);

}  // namespace bandsaw
