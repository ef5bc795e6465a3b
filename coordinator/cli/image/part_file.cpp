// A part of an image is a file with a header (exposure and tone of the scene) and records of bands
// (some rows with the sums of their samples). A file without a header has the default exposure and
// tone.

#include "coordinator/cli/image/part_file.h"

#include <array>
#include <cstring>
#include <limits>
#include <span>

#include "absl/strings/str_cat.h"
#include "renderlib/base/atomic_file.h"
#include "renderlib/base/file.h"
#include "renderlib/base/status_macros.h"
#include "renderlib/render/hash64.h"

namespace bandsaw::coordinator {
namespace {

constexpr std::array<char, 8> kMagic = {'B', 'S', 'W', 'P', 'A', 'R', 'T', '1'};

/// The header of a part; the band records follow it. Its bytes in memory are those of the file.
struct Beginning {
  std::array<char, 8> magic = kMagic;
  double exposure = 0;
  std::uint64_t tone = 0;
  std::uint64_t hash = 0;

  /// Returns the hash of the exposure and the tone.
  std::uint64_t hash_of_rest() const {
    Hash64 sum;
    sum.add(exposure);
    sum.add(tone);
    return sum.value();
  }
};
static_assert(sizeof(Beginning) == 32, "the header has no padding");

/// Returns the display settings in the header and sets `offset` to the end of the header. If there
/// is no header, returns the defaults and leaves `offset` unchanged. DATA_LOSS: the header is
/// damaged.
absl::StatusOr<Display> display_of(absl::Span<const std::byte> bytes, std::uint64_t& offset) {
  Beginning from;
  if (bytes.size() < sizeof from || std::memcmp(bytes.data(), kMagic.data(), kMagic.size()) != 0) {
    return Display();
  }
  std::memcpy(&from, bytes.data(), sizeof from);
  if (from.hash != from.hash_of_rest() || from.tone > static_cast<std::uint64_t>(kLastTone)) {
    return absl::DataLossError("its first bytes are damaged");
  }
  offset = sizeof from;
  return Display{from.exposure, static_cast<Tone>(from.tone), /*half=*/false};
}

}  // namespace

absl::Status write_part(const std::string& path, const std::vector<BandRecord>& records,
                        const Display& display) {
  Beginning beginning;
  beginning.exposure = display.exposure;
  beginning.tone = static_cast<std::uint64_t>(display.tone);
  beginning.hash = beginning.hash_of_rest();
  std::vector<std::byte> bytes(sizeof beginning);
  std::memcpy(bytes.data(), &beginning, sizeof beginning);
  for (const BandRecord& record : records) {
    ASSIGN_OR_RETURN(const std::vector<std::byte> encoded, encode_band_record(record));
    bytes.insert(bytes.end(), encoded.begin(), encoded.end());
  }
  return write_file_atomically(path, bytes);
}

absl::StatusOr<Display> read_part(const std::string& path,
                                  const std::function<absl::Status(const BandRecord&)>& record) {
  ASSIGN_OR_RETURN(const std::string whole,
                   read_whole_file(path, std::numeric_limits<std::uint64_t>::max()));
  const absl::Span<const std::byte> bytes = std::as_bytes(std::span(whole));
  if (bytes.empty()) {
    return absl::DataLossError(absl::StrCat(path, ": is empty, not a part of an image"));
  }
  std::uint64_t offset = 0;
  const auto display = display_of(bytes, offset);
  if (!display.ok()) {
    return absl::DataLossError(absl::StrCat(path, ": ", display.status().message()));
  }
  if (offset == bytes.size()) {
    return absl::DataLossError(absl::StrCat(path, ": is cut off: it holds no rows"));
  }
  while (offset < bytes.size()) {
    const auto decoded = decode_band_record(bytes, offset);
    if (!decoded.ok()) {
      return absl::DataLossError(
          absl::StrCat(path, ": not a whole part of an image: ", decoded.status().message()));
    }
    RETURN_IF_ERROR(record(decoded->record));
    offset += decoded->size;
  }
  return display;
}

}  // namespace bandsaw::coordinator
