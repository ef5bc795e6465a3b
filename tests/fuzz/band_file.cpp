// Fuzz target (fuzz.h): the records of a job's file of rendered bands, as the coordinator reads
// them from disk. A band is a range of rows and samples.

#include "renderlib/render/band_file.h"

#include <cstring>
#include <vector>

#include "renderlib/base/check.h"
#include "renderlib/render/hash64.h"
#include "tests/fuzz/fuzz.h"

namespace {

/// Reads one record after another, until the reader refuses one or the bytes end. Each accepted
/// record must give the same bytes when it is written again.
void read_all(absl::Span<const std::byte> bytes) {
  std::uint64_t offset = 0;
  while (offset < bytes.size()) {
    const auto decoded = bandsaw::decode_band_record(bytes, offset);
    if (!decoded.ok()) {
      return;
    }
    const auto encoded = bandsaw::encode_band_record(decoded->record);
    BANDSAW_CHECK(encoded.ok(), "a record that was read can be written");
    BANDSAW_CHECK(absl::MakeConstSpan(*encoded) == bytes.subspan(offset, decoded->size),
                  "the written record has the bytes that were read");
    offset += decoded->size;
  }
}

}  // namespace

void bandsaw::fuzz::run(absl::Span<const std::uint8_t> input) {
  std::vector<std::byte> bytes;
  for (const std::uint8_t byte : input) {
    bytes.push_back(static_cast<std::byte>(byte));
  }
  read_all(bytes);
  // A random mutation practically never has the correct hash at its end, so the input is read again
  // with the correct hash. Then the code after the check of the hash is tested too.
  if (bytes.size() > sizeof(std::uint64_t)) {
    const std::size_t body = bytes.size() - sizeof(std::uint64_t);
    Hash64 hash;
    hash.add(absl::MakeConstSpan(bytes).subspan(0, body));
    const std::uint64_t value = hash.value();
    std::memcpy(bytes.data() + body, &value, sizeof(value));
    read_all(bytes);
  }
}
