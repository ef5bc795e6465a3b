// Writes and reads the numbers of a record in the order of the format (band_file.h). The header and
// the hash of a record are checked before its sums are read.

#include "renderlib/render/band_file.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "absl/strings/str_cat.h"
#include "renderlib/base/status_macros.h"
#include "renderlib/render/hash64.h"

namespace bandsaw {
namespace {

constexpr std::size_t kMagicSize = kBandRecordMagic.size();
constexpr std::size_t kDigestSize = 64;
/// Size of everything before the sums, in the order of the format (band_file.h).
constexpr std::uint64_t kHeaderSize =
    kMagicSize + 8 + kDigestSize + 3 * 4 + 8 + 2 * 8 + 2 * 4 + 2 * 8 + 2 * 4 + 7 * 8 + 4;
constexpr std::uint64_t kHashSize = 8;

/// Appends numbers to bytes.
class Writer {
 public:
  explicit Writer(std::vector<std::byte>& bytes) : bytes_(bytes) {}
  void put(const void* data, std::size_t size) {
    const auto* begin = static_cast<const std::byte*>(data);
    bytes_.insert(bytes_.end(), begin, begin + size);
  }
  template <class T>
  void number(T value) {
    put(&value, sizeof value);
  }

 private:
  std::vector<std::byte>& bytes_;
};

/// Reads numbers from bytes whose size has been checked.
class Reader {
 public:
  explicit Reader(const std::byte* at) : at_(at) {}
  template <class T>
  void number(T& value) {
    std::memcpy(&value, at_, sizeof value);
    at_ += sizeof value;
  }
  std::string text(std::size_t size) {
    std::string out(size, '\0');
    std::memcpy(out.data(), at_, size);
    at_ += size;
    return out;
  }
  const std::byte* at() const { return at_; }

 private:
  const std::byte* at_;
};

bool is_digest(const std::string& text) {
  return text.size() == kDigestSize && std::all_of(text.begin(), text.end(), [](char c) {
           return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'f');
         });
}

std::uint64_t hash_of(absl::Span<const std::byte> bytes) {
  Hash64 hash;
  hash.add(bytes);
  return hash.value();
}

/// Checks everything except the sums.
absl::Status check(const BandRecord& record) {
  if (!is_digest(record.package_digest)) {
    return absl::InvalidArgumentError("package_digest: must be 64 lower-case hexadecimal digits");
  }
  const BandPixels& pixels = record.pixels;
  RETURN_IF_ERROR(validate(pixels.band, record.settings));
  if (pixels.width != record.settings.width) {
    return absl::InvalidArgumentError(absl::StrCat("width: the pixels have ", pixels.width,
                                                   ", the settings ", record.settings.width));
  }
  // The record does not tell how many samples each pixel took. (In adaptive sampling, different
  // tiles take different numbers of samples.) So the counters are checked against upper bounds
  // only.
  const Counters& counters = pixels.counters;
  const RowRange& rows = pixels.band.rows;
  const std::uint64_t most = kMaxSamples * rows.count() * pixels.width;
  const bool bad_place_inside = counters.bad_x < pixels.width && counters.bad_y >= rows.first &&
                                counters.bad_y < rows.last && counters.bad_sample < kMaxSamples;
  if (counters.bad_samples > most || (counters.bad_samples > 0 && !bad_place_inside)) {
    return absl::InvalidArgumentError("counters: the bad samples do not lie in the band");
  }
  if (counters.negative_samples > counters.bad_samples) {
    return absl::InvalidArgumentError("counters: more samples are negative than bad");
  }
  if (counters.truncated_paths > most) {
    return absl::InvalidArgumentError("counters: more paths are truncated than the band can have");
  }
  if (counters.techniques > Counters::kAllTechniques) {
    return absl::InvalidArgumentError("counters: unknown techniques");
  }
  if (!std::isfinite(record.cpu_s) || record.cpu_s < 0) {
    return absl::InvalidArgumentError("cpu_s: must be finite and >= 0");
  }
  return absl::OkStatus();
}

/// Reads the header after magic and size; the caller reads the sums.
Reader read_header(Reader reader, BandRecord& record) {
  record.package_digest = reader.text(kDigestSize);
  RenderSettings& settings = record.settings;
  reader.number(settings.width);
  reader.number(settings.height);
  std::uint16_t max_depth = 0;
  std::uint16_t integrator = 0;
  reader.number(max_depth);
  reader.number(integrator);
  settings.max_depth = max_depth;
  settings.integrator = static_cast<Integrator>(integrator);
  reader.number(settings.seed);
  BandPixels& pixels = record.pixels;
  pixels.width = settings.width;
  reader.number(pixels.band.samples.first);
  reader.number(pixels.band.samples.last);
  reader.number(pixels.band.rows.first);
  reader.number(pixels.band.rows.last);
  Counters& counters = pixels.counters;
  reader.number(counters.rays);
  reader.number(counters.bad_samples);
  reader.number(counters.bad_x);
  reader.number(counters.bad_y);
  reader.number(counters.bad_sample);
  reader.number(counters.negative_samples);
  reader.number(counters.truncated_paths);
  reader.number(counters.dropped_primitives);
  reader.number(counters.techniques);
  reader.number(counters.training_rays);
  reader.number(record.cpu_s);
  reader.number(record.process);
  return reader;
}

absl::Status damaged(std::uint64_t offset, absl::string_view what) {
  return absl::DataLossError(absl::StrCat("byte ", offset, ": ", what));
}

absl::Status cut_off(std::uint64_t offset, std::uint64_t wanted, std::uint64_t there) {
  return absl::OutOfRangeError(absl::StrCat("byte ", offset, ": the record is cut off: ", wanted,
                                            " bytes are needed, ", there, " are there"));
}

absl::Status read_sums(const std::byte* at, std::uint64_t offset, std::vector<double>& sums) {
  std::memcpy(sums.data(), at, sums.size() * sizeof(double));
  for (std::size_t i = 0; i < sums.size(); ++i) {
    if (!std::isfinite(sums[i]) || sums[i] < 0) {
      return damaged(offset + kHeaderSize + i * sizeof(double), "a sum is negative or not finite");
    }
  }
  return absl::OkStatus();
}

}  // namespace

std::uint64_t band_record_size(const Band& band, std::uint32_t width) {
  return kHeaderSize + std::uint64_t{band.rows.count()} * width * 3 * sizeof(double) + kHashSize;
}

absl::StatusOr<std::vector<std::byte>> encode_band_record(const BandRecord& record) {
  RETURN_IF_ERROR(check(record));
  const BandPixels& pixels = record.pixels;
  const std::uint64_t size = band_record_size(pixels.band, pixels.width);
  if (pixels.sums.size() != std::uint64_t{pixels.band.rows.count()} * pixels.width * 3) {
    return absl::InvalidArgumentError("sums: must be rows x width x 3");
  }
  std::vector<std::byte> bytes;
  bytes.reserve(size);
  Writer writer(bytes);
  writer.put(kBandRecordMagic.data(), kMagicSize);
  writer.number(size);
  writer.put(record.package_digest.data(), kDigestSize);
  const RenderSettings& settings = record.settings;
  writer.number(settings.width);
  writer.number(settings.height);
  static_assert(kMaxDepth <= 0xffff);
  writer.number(static_cast<std::uint16_t>(settings.max_depth));
  writer.number(static_cast<std::uint16_t>(settings.integrator));
  writer.number(settings.seed);
  writer.number(pixels.band.samples.first);
  writer.number(pixels.band.samples.last);
  writer.number(pixels.band.rows.first);
  writer.number(pixels.band.rows.last);
  writer.number(pixels.counters.rays);
  writer.number(pixels.counters.bad_samples);
  writer.number(pixels.counters.bad_x);
  writer.number(pixels.counters.bad_y);
  writer.number(pixels.counters.bad_sample);
  writer.number(pixels.counters.negative_samples);
  writer.number(pixels.counters.truncated_paths);
  writer.number(pixels.counters.dropped_primitives);
  writer.number(pixels.counters.techniques);
  writer.number(pixels.counters.training_rays);
  writer.number(record.cpu_s);
  writer.number(record.process);
  writer.put(pixels.sums.data(), pixels.sums.size() * sizeof(double));
  writer.number(hash_of(bytes));
  return bytes;
}

absl::StatusOr<DecodedBandRecord> decode_band_record(absl::Span<const std::byte> bytes,
                                                     std::uint64_t offset) {
  const std::uint64_t there = offset > bytes.size() ? 0 : bytes.size() - offset;
  if (there == 0) {
    return cut_off(offset, kHeaderSize + kHashSize, 0);
  }
  const std::byte* const begin = bytes.data() + (bytes.size() - there);
  if (std::memcmp(begin, kBandRecordMagic.data(), std::min<std::size_t>(kMagicSize, there)) != 0) {
    return damaged(offset,
                   absl::StrCat("no band record of format ",
                                absl::string_view(&kBandRecordMagic.back(), 1), " begins here"));
  }
  if (there < kHeaderSize + kHashSize) {
    return cut_off(offset, kHeaderSize + kHashSize, there);
  }
  DecodedBandRecord decoded;
  Reader reader(begin + kMagicSize);
  reader.number(decoded.size);
  reader = read_header(reader, decoded.record);
  BandPixels& pixels = decoded.record.pixels;
  if (absl::Status status = check(decoded.record); !status.ok()) {
    return damaged(offset, status.message());
  }
  if (decoded.size != band_record_size(pixels.band, pixels.width)) {
    return damaged(offset, "the record's size is not that of its band");
  }
  if (there < decoded.size) {
    return cut_off(offset, decoded.size, there);
  }
  std::uint64_t hash;
  std::memcpy(&hash, begin + decoded.size - kHashSize, kHashSize);
  if (hash != hash_of({begin, static_cast<std::size_t>(decoded.size - kHashSize)})) {
    return damaged(offset, "the hash of the record does not match the bytes before the hash");
  }
  pixels.sums.resize((decoded.size - kHeaderSize - kHashSize) / sizeof(double));
  RETURN_IF_ERROR(read_sums(reader.at(), offset, pixels.sums));
  return decoded;
}

std::vector<std::uint64_t> row_digests(const BandPixels& pixels) {
  const std::size_t row_size = std::size_t{pixels.width} * 3;
  std::vector<std::uint64_t> digests;
  for (std::size_t begin = 0; begin + row_size <= pixels.sums.size() && row_size > 0;
       begin += row_size) {
    Hash64 hash;
    for (std::size_t i = 0; i < row_size; ++i) {
      hash.add(pixels.sums[begin + i]);
    }
    digests.push_back(hash.value());
  }
  return digests;
}

}  // namespace bandsaw
