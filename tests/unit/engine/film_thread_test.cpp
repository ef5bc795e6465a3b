// The film's thread. A film holds the sums of the samples of a job's image. The thread adds stored
// bands to the films of jobs, and makes previews, error estimates and results. The band log is the
// file with all bands of a job. A film can be built again from the log, for example without the
// bands of a worker that returned wrong pixels. Damage of the log is found only when a film is
// built again. A pass renders a range of samples in all rows. FilmThread::plan(job, samples)
// announces a pass that ends at this number of samples.

#include "coordinator/engine/film_thread.h"

#include <gtest/gtest.h>

#include <atomic>
#include <fstream>

#include "coordinator/store/band_log.h"
#include "renderlib/render/render_band.h"
#include "renderlib/render/render_image.h"
#include "tests/support/full_disk.h"
#include "tests/support/scenes.h"
#include "tests/support/temp_dir.h"

namespace bandsaw::coordinator {
namespace {

/// Records what the film reports.
class RecordedScheduler : public SchedulerInbox {
 public:
  void band_stored(IncomingBand, std::vector<std::uint64_t>) override {}
  void band_failed(IncomingBand, const absl::Status&) override {}
  void result_written(JobId, const absl::Status&) override {}
  void disk_is_back() override {}
  void forget(std::vector<JobId>) override {}
  void pass_merged(input::PassMerged pass) override {
    merged.push_back(pass.samples);
    errors.push_back(pass.error ? pass.error->relative_rmse : -1);
  }
  void storage_failed(JobId, const absl::Status&) override { ++failed; }
  void bands_damaged(input::BandsDamaged lost) override {
    damaged.insert(damaged.end(), lost.bands.begin(), lost.bands.end());
  }

  std::vector<std::uint64_t> merged;
  std::vector<double> errors;
  int failed = 0;
  std::vector<input::BandsDamaged::DamagedBand> damaged;
};

/// Records the finished images.
class RecordedStore : public StoreInbox {
 public:
  void add_job(JobId, const JobSpec&) override {}
  void append(IncomingBand) override {}
  void compare(IncomingBand) override {}
  void write_result(JobId, Finished finished) override {
    images.push_back(std::move(finished.image));
    samples = std::move(finished.samples);
    attribution = std::move(finished.attribution);
  }
  void reopen(JobId) override { ++reopened; }
  void drop_bands(JobId) override {}
  void drop_job(JobId) override {}
  void collect(std::vector<KeptJob>) override {}
  void test_disk_until_writable() override { ++disk_tests; }

  std::vector<Image> images;
  std::optional<Image> samples;
  std::vector<RowsBy> attribution;
  int reopened = 0;
  int disk_tests = 0;
};

class FilmThreadTest : public testing::Test {
 protected:
  FilmThreadTest() {
    EXPECT_TRUE(make_folder(folder_.job(1)).ok());
    BandLogReport report;
    log_.emplace(*BandLog::open(
        folder_.job(1), folder_.bands(1), [](BandRecord, std::uint64_t) {}, report));
    thread_.add_job(1, settings_);
  }

  /// Renders a band, appends it to the band log, and returns it as the store does.
  IncomingBand logged(const SampleRange& samples, const RowRange& rows,
                      const TileSamples& tiles = {}) {
    Pool pool(1);
    const std::atomic<bool> stop{false};
    BandRecord record{.package_digest = std::string(64, 'a'), .settings = settings_, .pixels = {}};
    record.pixels = *render_band(
        *scene_, settings_, {samples, rows}, pool, stop, [](std::uint32_t) {}, tiles);
    IncomingBand incoming;
    incoming.tiles = tiles;
    incoming.offset = *log_->append(record);
    incoming.pixels = std::move(record.pixels);
    return incoming;
  }
  /// Renders, logs and adds a band. `new_rows`: rows that the film does not have; empty: all.
  absl::Status add(const SampleRange& samples, const RowRange& rows,
                   std::vector<RowRange> new_rows = {}) {
    if (new_rows.empty()) {
      new_rows = {rows};
    }
    return thread_.add(1, logged(samples, rows), std::move(new_rows));
  }
  /// Overwrites a byte of the band log.
  void damage(std::uint64_t at) {
    std::fstream bands(folder_.bands(1), std::ios::in | std::ios::out | std::ios::binary);
    bands.seekp(static_cast<std::streamoff>(at));
    bands.put('!');
  }
  /// Returns the pixels of a local render with `samples` samples per pixel.
  std::vector<Rgb> local(std::uint64_t samples) {
    Pool pool(1);
    const std::atomic<bool> stop{false};
    return render_image(
               *scene_, settings_, samples, pool, stop, [](std::uint64_t) {}, "")
        ->film.snapshot()
        .image.pixels;
  }

  test::TempDir temp_;
  const DataFolder folder_ = *DataFolder::open(temp_ / "data");
  const std::shared_ptr<const Scene> scene_ = test::cornell_box().build();
  const RenderSettings settings_{.width = 6, .height = 8, .max_depth = 3, .seed = 1};
  std::optional<BandLog> log_;
  RecordedScheduler scheduler_;
  RecordedStore store_;
  FilmThread thread_{folder_, scheduler_, store_};
};

TEST_F(FilmThreadTest, ReportsEachPassOnceWhenItIsComplete) {
  thread_.plan(1, 16);
  thread_.plan(1, 32);
  ASSERT_TRUE(add({16, 32}, {0, 8}).ok());
  ASSERT_TRUE(add({0, 16}, {0, 5}).ok());
  EXPECT_TRUE(scheduler_.merged.empty());
  ASSERT_TRUE(add({0, 16}, {5, 8}).ok());
  EXPECT_EQ(scheduler_.merged, (std::vector<std::uint64_t>{16, 32}));
  EXPECT_GT(scheduler_.errors.back(), 0)
      << "the error must be known once the film has two halves of the samples";
}

TEST_F(FilmThreadTest, BandsOfAWorkerCanBeRetracted) {
  thread_.plan(1, 16);
  thread_.plan(1, 32);
  IncomingBand wrong = logged({0, 16}, {0, 4});
  wrong.pixels.sums[5] += 1;
  wrong.process = 7;
  ASSERT_TRUE(thread_.add(1, std::move(wrong), {{0, 4}}).ok());
  ASSERT_TRUE(add({0, 16}, {4, 8}).ok());
  // With this band, the film has one sum of the samples [0, 32) for each row. The wrong band cannot
  // be subtracted from these sums, so retract() must build the film again.
  ASSERT_TRUE(add({16, 32}, {0, 8}).ok());
  EXPECT_EQ(scheduler_.merged, (std::vector<std::uint64_t>{16, 32}));
  thread_.retract(1, 7);
  EXPECT_EQ(scheduler_.merged.size(), 2u);
  ASSERT_TRUE(add({0, 16}, {0, 4}).ok());
  EXPECT_EQ(scheduler_.merged, (std::vector<std::uint64_t>{16, 32, 16, 32}));
  thread_.request_image(1, 32);
  ASSERT_EQ(store_.images.size(), 1u);
  EXPECT_EQ(store_.images[0].pixels, local(32));
}

TEST_F(FilmThreadTest, DamagedBandsAreLeftOutAndReported) {
  thread_.plan(1, 16);
  ASSERT_TRUE(add({0, 16}, {0, 4}).ok());
  IncomingBand sound = logged({0, 16}, {4, 8});
  damage(sound.offset + 300);  // in the pixels of this record
  sound.process = 5;
  ASSERT_TRUE(thread_.add(1, std::move(sound), {{4, 6}, {6, 8}}).ok());
  EXPECT_EQ(scheduler_.merged, (std::vector<std::uint64_t>{16}))
      << "the band must be added from memory";
  thread_.retract(1, 7);  // no band is of process 7, but the film is built again from the log
  EXPECT_EQ(scheduler_.failed, 0);
  ASSERT_EQ(scheduler_.damaged.size(), 2u);
  for (const auto& lost : scheduler_.damaged) {
    EXPECT_EQ(lost.process, 5u);
    EXPECT_EQ(lost.band.rows.count(), 2u);
  }
  ASSERT_TRUE(add({0, 16}, {4, 8}).ok());
  EXPECT_EQ(scheduler_.merged, (std::vector<std::uint64_t>{16, 16}));
  thread_.request_image(1, 16);
  ASSERT_EQ(store_.images.size(), 1u);
  EXPECT_EQ(store_.images[0].pixels, local(16));
}

TEST_F(FilmThreadTest, AnotherBandAtTheSameOffsetIsDamage) {
  ASSERT_TRUE(add({0, 16}, {0, 4}).ok());
  IncomingBand other = logged({0, 16}, {4, 8});
  IncomingBand wrong = logged({0, 16}, {4, 8});
  wrong.pixels.sums[7] += 1;  // the record in the log is valid, but has other pixels
  wrong.offset = other.offset;
  ASSERT_TRUE(thread_.add(1, std::move(wrong), {{4, 8}}).ok());
  thread_.retract(1, 7);
  ASSERT_EQ(scheduler_.damaged.size(), 1u);
  EXPECT_EQ(scheduler_.damaged[0].band.rows, (RowRange{4, 8}));
}

// The first request finds that the log is missing. The lost band is then added again, and a second
// request makes the image.
TEST_F(FilmThreadTest, AnImageOfADamagedLogIsMadeOnTheNextRequest) {
  ASSERT_TRUE(add({0, 16}, {0, 8}).ok());
  ASSERT_TRUE(add({16, 32}, {0, 3}).ok());
  ASSERT_TRUE(remove_file(folder_.bands(1)).ok());
  thread_.request_image(1, 16);
  EXPECT_TRUE(store_.images.empty());
  ASSERT_EQ(scheduler_.damaged.size(), 1u)
      << "only the band with samples of the image must be reported";
  BandLogReport report;
  log_.emplace(*BandLog::open(
      folder_.job(1), folder_.bands(1), [](BandRecord, std::uint64_t) {}, report));
  ASSERT_TRUE(add({0, 16}, {0, 8}).ok());
  EXPECT_TRUE(store_.images.empty());
  thread_.request_image(1, 16);
  ASSERT_EQ(store_.images.size(), 1u);
  EXPECT_EQ(store_.images[0].pixels, local(16));
}

// While a film cannot take bands, add_later() remembers the rows of each band. Then retry() reads
// the bands from the log and adds the rows.
TEST_F(FilmThreadTest, RetryAddsTheRowsOfAddLaterFromTheLog) {
  thread_.plan(1, 16);
  ASSERT_TRUE(add({0, 16}, {0, 4}).ok());
  thread_.add_later(1, logged({0, 16}, {4, 8}), {{4, 8}});
  EXPECT_TRUE(scheduler_.merged.empty());
  thread_.retry();
  EXPECT_EQ(scheduler_.merged, (std::vector<std::uint64_t>{16}));
  thread_.request_image(1, 16);
  ASSERT_EQ(store_.images.size(), 1u);
  EXPECT_EQ(store_.images[0].pixels, local(16));
}

TEST_F(FilmThreadTest, AddsOnlyTheRowsThatAreNew) {
  ASSERT_TRUE(add({0, 16}, {2, 5}).ok());
  ASSERT_TRUE(add({0, 16}, {0, 8}, {{0, 2}, {5, 8}}).ok());
  thread_.request_image(1, 16);
  ASSERT_EQ(store_.images.size(), 1u);
  EXPECT_EQ(store_.images[0].pixels, local(16));
}

TEST_F(FilmThreadTest, AnImageOf16SamplesLeavesOutLaterSamples) {
  ASSERT_TRUE(add({0, 16}, {0, 8}).ok());
  ASSERT_TRUE(add({16, 32}, {0, 3}).ok());
  ASSERT_TRUE(add({16, 32}, {2, 5}, {{3, 5}}).ok());
  thread_.request_image(1, 16);
  ASSERT_EQ(store_.images.size(), 1u);
  EXPECT_EQ(store_.images[0].pixels, local(16));
}

TEST_F(FilmThreadTest, AnImageWaitsForItsLastRows) {
  ASSERT_TRUE(add({0, 16}, {0, 7}).ok());
  thread_.request_image(1, 16);
  EXPECT_TRUE(store_.images.empty());
  ASSERT_TRUE(add({0, 16}, {7, 8}).ok());
  ASSERT_EQ(store_.images.size(), 1u);
  EXPECT_FALSE(store_.samples.has_value())
      << "no numbers of samples are needed, because all pixels have the same number";
  EXPECT_EQ(store_.images[0].pixels, local(16));
}

TEST_F(FilmThreadTest, TheResultOfAnAdaptiveJobHasTheNumberOfSamplesOfEachPixel) {
  thread_.add_job(1, settings_, /*adaptive=*/true);
  // The image is one tile. In the second pass, only the even half of the tile takes samples. These
  // are the pixels for which half_of() returns 0.
  TileSamples even_half(settings_.width, {0, 8});
  even_half.set(0, {16, 32});
  ASSERT_TRUE(add({0, 16}, {0, 8}).ok());
  ASSERT_TRUE(thread_.add(1, logged({16, 32}, {0, 8}, even_half), {{0, 8}}).ok());
  thread_.request_image(1, 32);
  ASSERT_TRUE(store_.samples.has_value());
  ASSERT_EQ(store_.samples->pixels.size(), 48u);
  for (std::uint32_t y = 0; y < 8; ++y) {
    for (std::uint32_t x = 0; x < 6; ++x) {
      EXPECT_EQ(store_.samples->pixels[y * 6 + x], gray(half_of(x, y) == 0 ? 32 : 16))
          << x << " " << y;
    }
  }
}

TEST_F(FilmThreadTest, BandsRefusedByAFullDiskAreAddedLater) {
  IncomingBand first = logged({0, 16}, {0, 4});
  IncomingBand second = logged({0, 16}, {4, 8});
  thread_.plan(1, 16);
  {
    const test::FullDisk full(/*bytes=*/0);
    EXPECT_EQ(thread_.add(1, std::move(first), {{0, 4}}).code(),
              absl::StatusCode::kResourceExhausted);
    EXPECT_FALSE(thread_.add(1, std::move(second), {{4, 8}}).ok());
    thread_.request_image(1, 16);
    EXPECT_GE(scheduler_.failed, 2);
    EXPECT_EQ(store_.disk_tests, scheduler_.failed) << "the store must be asked to test the disk";
  }
  EXPECT_TRUE(scheduler_.merged.empty());
  thread_.retry();
  EXPECT_EQ(scheduler_.merged, (std::vector<std::uint64_t>{16, 16}))
      << "the pass must be reported twice: when it is complete and with the finished image";
  ASSERT_EQ(store_.images.size(), 1u);
  EXPECT_EQ(store_.images[0].pixels, local(16));
}

TEST_F(FilmThreadTest, ADroppedJobIgnoresBands) {
  ASSERT_TRUE(add({0, 16}, {0, 8}).ok());
  thread_.drop(1);
  EXPECT_TRUE(add({16, 32}, {0, 8}).ok());
  thread_.request_image(1, 16);
  EXPECT_TRUE(store_.images.empty());
}

TEST(Slice, ReturnsTheGivenRows) {
  BandPixels band{.band = {.samples = {0, 16}, .rows = {4, 7}},
                  .width = 1,
                  .sums = {1, 2, 3, 4, 5, 6, 7, 8, 9},
                  .counters = {}};
  const BandPixels middle = slice(band, {5, 6});
  EXPECT_EQ(middle.sums, (std::vector<double>{4, 5, 6}));
  EXPECT_EQ(middle.band.rows, (RowRange{5, 6}));
  EXPECT_EQ(middle.width, 1u);
}

TEST_F(FilmThreadTest, APreviewShowsPresentRowsAndTheirWorkers) {
  EXPECT_TRUE(absl::IsNotFound(thread_.preview(1, 1).status()));
  IncomingBand incoming = logged({0, 16}, {2, 5});
  incoming.worker = "anna";
  ASSERT_TRUE(thread_.add(1, std::move(incoming), {{2, 5}}).ok());
  const Image whole = *thread_.preview(1, 1);
  EXPECT_EQ(whole.height, 8u);
  EXPECT_EQ(whole.at(3, 1), Rgb());
  EXPECT_EQ(whole.at(3, 4), local(16)[4 * 6 + 3]);
  // Every third row: rows 0, 3 and 6.
  const Image every_third_row = *thread_.preview(1, 3);
  EXPECT_EQ(every_third_row.height, 3u);
  EXPECT_EQ(every_third_row.at(3, 1), whole.at(3, 3));
  const std::vector<RowsBy> by_anna = {{{2, 5}, "anna"}};
  EXPECT_EQ(thread_.rendered_by(1), by_anna);
  thread_.drop(1);
  EXPECT_TRUE(absl::IsNotFound(thread_.preview(1, 1).status()));
}

TEST_F(FilmThreadTest, AfterADropTheAttributionIsReadFromTheFileBesideTheImage) {
  IncomingBand incoming = logged({0, 16}, {0, 8});
  incoming.worker = "anna";
  ASSERT_TRUE(thread_.add(1, std::move(incoming), {{0, 8}}).ok());
  thread_.request_image(1, 16);
  const std::vector<RowsBy> by_anna = {{{0, 8}, "anna"}};
  EXPECT_EQ(store_.attribution, by_anna);
  thread_.drop(1);
  EXPECT_TRUE(thread_.rendered_by(1).empty());
  ASSERT_TRUE(write_attribution(by_anna, folder_.old_attribution(1)).ok());
  EXPECT_EQ(thread_.rendered_by(1), by_anna);
  const std::vector<RowsBy> by_ben = {{{0, 8}, "ben"}};
  ASSERT_TRUE(write_attribution(by_ben, folder_.attribution(1)).ok());
  EXPECT_EQ(thread_.rendered_by(1), by_ben);
}

}  // namespace
}  // namespace bandsaw::coordinator
