#pragma once

// Band sums as bytes: what `bandsaw render --rows` writes, `bandsaw stitch` reads, and the
// coordinator keeps. A file is any number of records, one after the other; each says all that is
// needed to know what it belongs to.
//
// A record, little-endian, no padding:
//   "BSWBAND3"                                          8 bytes: magic and format version
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
//   cpu_s                                               f64
//   renderer                                            u64
//   sums                                                f64 x rows x width x 3
//   hash of all bytes before (render/hash64.h)          u64

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

/// What a record begins with: to find the next one after a damaged one.
inline constexpr std::array<char, 8> kBandRecordMagic = {'B', 'S', 'W', 'B', 'A', 'N', 'D', '3'};

struct BandRecord {
  std::string package_digest;  ///< 64 lower-case hexadecimal digits
  RenderSettings settings;
  BandPixels pixels;
  double cpu_s = 0;            ///< what it cost, summed over threads, >= 0; 0: not said
  std::uint64_t renderer = 0;  ///< names who rendered it, to tell one from another; 0: not said
};

/// The size of the record of a band, bytes.
std::uint64_t band_record_size(const Band& band, std::uint32_t width);

/// INVALID_ARGUMENT: the record contradicts itself (digest, band, number of sums, cost).
absl::StatusOr<std::vector<std::byte>> encode_band_record(const BandRecord& record);

struct DecodedBandRecord {
  BandRecord record;
  std::uint64_t size = 0;  ///< bytes it took: the next record begins there
};

/// The record at byte `offset` of `bytes`; every field is checked. Both errors begin with "byte N:
/// ", N counted in `bytes`. OUT_OF_RANGE: the bytes end before the record does (a file that was cut
/// off). DATA_LOSS: the bytes are not such a record.
absl::StatusOr<DecodedBandRecord> decode_band_record(absl::Span<const std::byte> bytes,
                                                     std::uint64_t offset = 0);

/// One digest a row of its sums' bits: equal for equal pixels.
std::vector<std::uint64_t> row_digests(const BandPixels& pixels);

}  // namespace bandsaw
