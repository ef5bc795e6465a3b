// Files of band records. A record has the sums of the pixels of a band, the settings with which the
// band was rendered, and the CPU time. Records are read back as they were written, and every damage
// is detected.

#include "renderlib/render/band_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <iterator>
#include <limits>
#include <string>

namespace bandsaw {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

/// Returns a valid record of the samples [32, 60) of the rows [4, 6). It has two bad samples.
BandRecord record() {
  BandRecord record{.package_digest = std::string(60, 'a') + "09bf",
                    .settings = {.width = 3,
                                 .height = 9,
                                 .max_depth = 5,
                                 .seed = 77,
                                 .integrator = Integrator::kDepth},
                    .pixels = {.band = {{32, 60}, {4, 6}}, .width = 3, .sums = {}, .counters = {}}};
  for (int i = 0; i < 2 * 3 * 3; ++i) {
    record.pixels.sums.push_back(i * 0.1);
  }
  record.pixels.counters = {.rays = 1234,
                            .bad_samples = 2,
                            .bad_x = 1,
                            .bad_y = 5,
                            .bad_sample = 40,
                            .negative_samples = 1,
                            .truncated_paths = 168,
                            .dropped_primitives = 1ull << 40,
                            .techniques = 7,
                            .training_rays = 1ull << 41};
  record.cpu_s = 0.3;
  record.process = 0xFEDCBA9876543210u;
  return record;
}

std::vector<std::byte> encoded() {
  auto bytes = encode_band_record(record());
  EXPECT_TRUE(bytes.ok()) << bytes.status();
  return *std::move(bytes);
}

void expect_equal(const BandRecord& a, const BandRecord& b) {
  EXPECT_EQ(a.package_digest, b.package_digest);
  EXPECT_EQ(a.settings, b.settings);
  EXPECT_EQ(a.pixels.band, b.pixels.band);
  EXPECT_EQ(a.pixels.width, b.pixels.width);
  EXPECT_EQ(a.pixels.sums, b.pixels.sums);
  EXPECT_EQ(a.pixels.counters, b.pixels.counters);
  EXPECT_EQ(a.cpu_s, b.cpu_s);
  EXPECT_EQ(a.process, b.process);
}

TEST(BandFile, RecordsRoundTripWithAKnownSize) {
  const std::vector<std::byte> bytes = encoded();
  EXPECT_EQ(bytes.size(), band_record_size(record().pixels.band, 3));
  const auto decoded = decode_band_record(bytes);
  ASSERT_TRUE(decoded.ok()) << decoded.status();
  EXPECT_EQ(decoded->size, bytes.size());
  expect_equal(decoded->record, record());
}

// With a seed of an older format, the fuzzer would hardly ever get past the first bytes.
TEST(BandFile, TheSeedOfTheFuzzerIsARecordOfThisFormat) {
  std::ifstream file(BANDSAW_SOURCE "/tests/fuzz/corpus/band_file/record", std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  const auto decoded = decode_band_record(
      absl::MakeSpan(reinterpret_cast<const std::byte*>(text.data()), text.size()));
  ASSERT_TRUE(decoded.ok()) << decoded.status();
  EXPECT_EQ(decoded->size, text.size());
}

TEST(BandFile, RecordsFollowEachOther) {
  std::vector<std::byte> file = encoded();
  const std::vector<std::byte> second = encoded();
  file.insert(file.end(), second.begin(), second.end());
  const auto decoded = decode_band_record(file, second.size());
  ASSERT_TRUE(decoded.ok()) << decoded.status();
  expect_equal(decoded->record, record());
}

TEST(BandFile, TruncationsReportWhereTheRecordBegins) {
  const std::vector<std::byte> whole = encoded();
  std::vector<std::byte> file(11, std::byte{0});
  file.insert(file.end(), whole.begin(), whole.end());
  for (std::size_t size = 11; size < file.size(); ++size) {
    const auto decoded = decode_band_record(absl::MakeSpan(file.data(), size), 11);
    ASSERT_EQ(decoded.status().code(), absl::StatusCode::kOutOfRange) << size;
    ASSERT_THAT(std::string(decoded.status().message()), StartsWith("byte 11: "));
  }
  EXPECT_FALSE(decode_band_record({}).ok());
  EXPECT_FALSE(decode_band_record(file, file.size() + 5).ok());
}

// A record begins with magic bytes. The last of them is the digit of the record's format.
TEST(BandFile, ARecordOfAnotherFormatIsRefusedNamingTheReadableFormat) {
  std::vector<std::byte> older = encoded();
  older[kBandRecordMagic.size() - 1] = std::byte{'3'};
  EXPECT_THAT(std::string(decode_band_record(older).status().message()),
              HasSubstr(std::string("no band record of format ") + kBandRecordMagic.back()));
}

TEST(BandFile, EveryFlippedBitIsDetected) {
  const std::vector<std::byte> whole = encoded();
  for (std::size_t at = 0; at < whole.size(); ++at) {
    for (int bit = 0; bit < 8; ++bit) {
      std::vector<std::byte> damaged = whole;
      damaged[at] ^= std::byte{1} << bit;
      const auto decoded = decode_band_record(damaged);
      ASSERT_FALSE(decoded.ok()) << "byte " << at << " bit " << bit;
      ASSERT_THAT(std::string(decoded.status().message()), StartsWith("byte 0"));
    }
  }
}

// In adaptive sampling, each half tile (half of the pixels of a tile of 16 x 16) takes its own
// range of samples. This range may lie outside of the band's range of samples, and may be longer
// than it. So a bad sample may have a number beyond the band's range, and more paths may be
// truncated than the band's range would allow.
TEST(BandFile, CountersOfAnAdaptiveBandMayExceedTheRangeOfItsSamples) {
  BandRecord adaptive = record();
  adaptive.pixels.counters.bad_sample = adaptive.pixels.band.samples.last + 100;
  adaptive.pixels.counters.truncated_paths = 1000;
  EXPECT_TRUE(encode_band_record(adaptive).ok()) << encode_band_record(adaptive).status();
}

TEST(BandFile, InconsistentRecordsAreNotWritten) {
  const auto refused = [](auto change) {
    BandRecord changed = record();
    change(changed);
    return encode_band_record(changed).status().code() == absl::StatusCode::kInvalidArgument;
  };
  EXPECT_TRUE(refused([](BandRecord& r) { r.package_digest = "A"; }));
  EXPECT_TRUE(refused([](BandRecord& r) { r.package_digest[3] = 'A'; }));
  EXPECT_TRUE(refused([](BandRecord& r) { r.pixels.width = 4; }));
  EXPECT_TRUE(refused([](BandRecord& r) { r.pixels.sums.pop_back(); }));
  EXPECT_TRUE(refused([](BandRecord& r) { r.pixels.band.rows.last = 10; }));
  EXPECT_TRUE(refused([](BandRecord& r) { r.pixels.band.samples.first = 16; }));
  EXPECT_TRUE(refused([](BandRecord& r) { r.pixels.counters.bad_y = 6; }));
  EXPECT_TRUE(refused([](BandRecord& r) { r.pixels.counters.negative_samples = 3; }));
  EXPECT_TRUE(refused([](BandRecord& r) { r.pixels.counters.truncated_paths = 1ull << 40; }));
  EXPECT_TRUE(refused([](BandRecord& r) { r.settings.max_depth = 0; }));
  EXPECT_TRUE(refused([](BandRecord& r) { r.cpu_s = std::nan(""); }));
  EXPECT_TRUE(refused([](BandRecord& r) { r.cpu_s = -1; }));
}

TEST(BandFile, ImpossibleSumsAreNotRead) {
  for (const double bad : {-1.0, std::nan(""), std::numeric_limits<double>::infinity()}) {
    BandRecord changed = record();
    changed.pixels.sums[7] = bad;
    const auto bytes = encode_band_record(changed);
    ASSERT_TRUE(bytes.ok());
    EXPECT_EQ(decode_band_record(*bytes).status().code(), absl::StatusCode::kDataLoss);
  }
}

TEST(BandFile, RowDigestsIdentifyTheDifferingRow) {
  BandPixels pixels = record().pixels;
  const std::vector<std::uint64_t> before = row_digests(pixels);
  ASSERT_EQ(before.size(), 2u);
  EXPECT_NE(before[0], before[1]);
  pixels.sums[9] = std::nextafter(pixels.sums[9], 1.0);
  const std::vector<std::uint64_t> after = row_digests(pixels);
  EXPECT_EQ(before[0], after[0]);
  EXPECT_NE(before[1], after[1]);
}

}  // namespace
}  // namespace bandsaw
