// Tests the log of a job's bands on disk. Truncation and damage lose only the records that they
// hit.

#include "coordinator/store/band_log.h"

#include <gtest/gtest.h>

#include "tests/support/full_disk.h"
#include "tests/support/temp_dir.h"
#include "tests/unit/store/test_files.h"

namespace bandsaw::coordinator {
namespace {

/// Returns a record of one row; the sums of its pixels depend on the row.
BandRecord sample_band(std::uint32_t row, std::uint32_t width = 4) {
  BandRecord record{.package_digest = std::string(64, 'c'),
                    .settings = {.width = width, .height = 8, .max_depth = 3, .seed = 9},
                    .pixels = {.band = {.samples = {0, 16}, .rows = {row, row + 1}},
                               .width = width,
                               .sums = {},
                               .counters = {.rays = row, .bad_samples = 0}}};
  for (std::uint32_t i = 0; i < 3 * width; ++i) {
    record.pixels.sums.push_back(row + i / 12.0);
  }
  return record;
}

class BandLogTest : public testing::Test {
 protected:
  /// Opens the log. Keeps the report of the opening and, for each record that is read, the row and
  /// the offset.
  absl::StatusOr<BandLog> open() {
    rows_.clear();
    offsets_.clear();
    report_ = {};
    const auto each = [this](BandRecord record, std::uint64_t offset) {
      offsets_.push_back(offset);
      const BandPixels& pixels = record.pixels;
      EXPECT_EQ(pixels.sums, sample_band(pixels.band.rows.first, pixels.width).pixels.sums);
      rows_.push_back(record.pixels.band.rows.first);
    };
    return BandLog::open(folder_.path(), path_, each, report_);
  }
  /// Writes a log of the rows [0, rows) and returns its bytes.
  std::string make(std::uint32_t rows) {
    absl::StatusOr<BandLog> log = open();
    for (std::uint32_t row = 0; row < rows; ++row) {
      EXPECT_TRUE(log->append(sample_band(row)).ok());
    }
    EXPECT_TRUE(log->sync().ok());
    return read_all(path_);
  }

  using Rows = std::vector<std::uint32_t>;
  test::TempDir folder_;
  std::string path_ = folder_ / "bands";
  Rows rows_;
  std::vector<std::uint64_t> offsets_;
  BandLogReport report_;
};

TEST_F(BandLogTest, ReadsAppendedRecordsInOrder) {
  make(3);
  ASSERT_TRUE(open().ok());
  EXPECT_EQ(rows_, (Rows{0, 1, 2}));
  EXPECT_EQ(report_.records, 3u);
  EXPECT_EQ(report_.damaged_bytes, 0u);
}

TEST_F(BandLogTest, ReturnsTheOffsetOfEachRecord) {
  const std::uint64_t one = make(1).size();
  absl::StatusOr<BandLog> log = open();
  EXPECT_EQ(*log->append(sample_band(1)), one);
  EXPECT_EQ(*log->append(sample_band(2)), 2 * one);
  ASSERT_TRUE(open().ok());
  EXPECT_EQ(offsets_, (std::vector<std::uint64_t>{0, one, 2 * one}));
}

TEST_F(BandLogTest, KeepsCompleteRecordsIfTruncatedAtAnyByte) {
  const std::string whole = make(3);
  const std::size_t one = whole.size() / 3;
  for (std::size_t cut = 0; cut < whole.size(); ++cut) {
    write_all(path_, whole.substr(0, cut));
    {
      absl::StatusOr<BandLog> log = open();
      ASSERT_TRUE(log.ok()) << log.status();
      ASSERT_EQ(rows_.size(), cut / one) << "cut at " << cut;
      EXPECT_EQ(report_.damaged_bytes, cut % one);
      ASSERT_TRUE(log->append(sample_band(7)).ok());
      ASSERT_TRUE(log->sync().ok());
    }
    ASSERT_TRUE(open().ok());
    ASSERT_EQ(rows_.size(), cut / one + 1);
    EXPECT_EQ(rows_.back(), 7u);
    EXPECT_EQ(report_.damaged_bytes, 0u);
  }
}

TEST_F(BandLogTest, AChangedByteLosesOnlyItsOwnRecord) {
  const std::string whole = make(3);
  const std::size_t one = whole.size() / 3;
  for (std::size_t i = one; i < 2 * one; ++i) {
    std::string changed = whole;
    changed[i] = static_cast<char>(changed[i] ^ 1);
    write_all(path_, changed);
    ASSERT_TRUE(open().ok());
    EXPECT_EQ(rows_, (Rows{0, 2})) << "byte " << i;
    EXPECT_EQ(report_.damaged_bytes, one);
  }
}

// A record with 4 pixels is read at once. One with 4,000 pixels has 96 kB of sums and is read
// twice: first its head, which contains the size of the record, then the whole record.
TEST_F(BandLogTest, ReadsRecordsOfAnySize) {
  {
    absl::StatusOr<BandLog> log = open();
    for (std::uint32_t row = 0; row < 4; ++row) {
      ASSERT_TRUE(log->append(sample_band(row, row % 2 == 0 ? 4 : 4'000)).ok());
    }
    ASSERT_TRUE(log->sync().ok());
  }
  ASSERT_TRUE(open().ok());
  EXPECT_EQ(rows_, (Rows{0, 1, 2, 3}));
  EXPECT_EQ(report_.damaged_bytes, 0u);
  std::string damaged = read_all(path_);
  char& byte = damaged[offsets_[1] + 50'000];
  byte = static_cast<char>(byte ^ 1);
  write_all(path_, damaged);
  const std::uint64_t size = offsets_[2] - offsets_[1];
  ASSERT_TRUE(open().ok());
  EXPECT_EQ(rows_, (Rows{0, 2, 3}));
  EXPECT_EQ(report_.damaged_bytes, size);
  write_all(path_, damaged.substr(0, damaged.size() - 1));
  ASSERT_TRUE(open().ok());
  EXPECT_EQ(rows_, (Rows{0, 2}));
  ASSERT_TRUE(open().ok());
  EXPECT_EQ(report_.damaged_bytes, size)
      << "the first opening must have removed the truncated record at the end";
}

// The search for the next record reads 1 MiB at a time. The next record may begin in the last bytes
// of such a piece.
TEST_F(BandLogTest, FindsTheRecordAfterManyDamagedBytes) {
  const std::string whole = make(2);
  const std::size_t one = whole.size() / 2;
  for (std::size_t bytes = (1 << 20) - 8; bytes <= (1 << 20) + 2; ++bytes) {
    write_all(path_, whole.substr(0, one) + std::string(bytes, 'x') + whole.substr(one));
    ASSERT_TRUE(open().ok());
    EXPECT_EQ(rows_, (Rows{0, 1})) << bytes;
    EXPECT_EQ(report_.damaged_bytes, bytes);
  }
}

TEST_F(BandLogTest, AFullDiskLeavesTheLogUnchanged) {
  const std::string whole = make(2);
  absl::StatusOr<BandLog> log = open();
  ASSERT_TRUE(log.ok());
  {
    const test::FullDisk full(whole.size() + 50);  // space for a part of the next record
    EXPECT_EQ(log->append(sample_band(2)).status().code(), absl::StatusCode::kResourceExhausted);
    EXPECT_EQ(log->append(sample_band(3)).status().code(), absl::StatusCode::kResourceExhausted);
  }
  EXPECT_EQ(read_all(path_), whole);
  ASSERT_TRUE(log->append(sample_band(4)).ok());
  ASSERT_TRUE(log->sync().ok());
  ASSERT_TRUE(open().ok());
  EXPECT_EQ(rows_, (Rows{0, 1, 4}));
}

}  // namespace
}  // namespace bandsaw::coordinator
