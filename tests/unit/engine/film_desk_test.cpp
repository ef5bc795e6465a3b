#include "coordinator/engine/film_desk.h"

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

class FilmDeskTest : public testing::Test {
 protected:
  FilmDeskTest() {
    EXPECT_TRUE(make_folder(folder_.job(1)).ok());
    BandLogReport report;
    log_.emplace(*BandLog::open(
        folder_.job(1), folder_.bands(1), [](BandRecord, std::uint64_t) {}, report));
    desk_.add_job(1, settings_);
  }

  PutBand logged(const SampleRange& samples, const RowRange& rows, const TileSamples& tiles = {}) {
    Pool pool(1);
    const std::atomic<bool> stop{false};
    BandRecord record{.package_digest = std::string(64, 'a'), .settings = settings_, .pixels = {}};
    record.pixels = *render_band(
        *scene_, settings_, {samples, rows}, pool, stop, [](std::uint32_t) {}, tiles);
    PutBand put;
    put.tiles = tiles;
    put.offset = *log_->append(record);
    put.pixels = std::move(record.pixels);
    return put;
  }
  absl::Status add(const SampleRange& samples, const RowRange& rows,
                   std::vector<RowRange> new_rows = {}) {
    if (new_rows.empty()) {
      new_rows = {rows};
    }
    return desk_.add(1, logged(samples, rows), std::move(new_rows));
  }
  void damage(std::uint64_t at) {
    std::fstream bands(folder_.bands(1), std::ios::in | std::ios::out | std::ios::binary);
    bands.seekp(static_cast<std::streamoff>(at));
    bands.put('!');
  }
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
  std::vector<std::uint64_t> merged_;
  std::vector<double> errors_;
  std::vector<Image> images_;
  std::vector<RowsBy> credits_;
  std::optional<Image> samples_;
  int failed_ = 0;
  std::vector<input::BandsDamaged::DamagedBand> damaged_;
  FilmDesk desk_{folder_,
                 {.merged =
                      [this](input::PassMerged m) {
                        merged_.push_back(m.samples);
                        errors_.push_back(m.error ? m.error->relative_rmse : -1);
                      },
                  .image =
                      [this](JobId, Finished finished) {
                        images_.push_back(std::move(finished.image));
                        samples_ = std::move(finished.samples);
                        credits_ = std::move(finished.credits);
                      },
                  .failed = [this](JobId, absl::Status) { ++failed_; },
                  .damaged =
                      [this](JobId, std::vector<input::BandsDamaged::DamagedBand> bands) {
                        damaged_.insert(damaged_.end(), bands.begin(), bands.end());
                      }}};
};

TEST_F(FilmDeskTest, TellsEachPassOnceWhenItsLastRowsAreThere) {
  desk_.plan(1, 16);
  desk_.plan(1, 32);
  ASSERT_TRUE(add({16, 32}, {0, 8}).ok());
  ASSERT_TRUE(add({0, 16}, {0, 5}).ok());
  EXPECT_TRUE(merged_.empty());
  ASSERT_TRUE(add({0, 16}, {5, 8}).ok());
  EXPECT_EQ(merged_, (std::vector<std::uint64_t>{16, 32}));
  EXPECT_GT(errors_.back(), 0) << "two halves are there";
}

TEST_F(FilmDeskTest, WhatAMachineGaveCanBeTakenOutAgain) {
  desk_.plan(1, 16);
  desk_.plan(1, 32);
  PutBand wrong = logged({0, 16}, {0, 4});
  wrong.pixels.sums[5] += 1;
  wrong.renderer = 7;
  ASSERT_TRUE(desk_.add(1, std::move(wrong), {{0, 4}}).ok());
  ASSERT_TRUE(add({0, 16}, {4, 8}).ok());
  ASSERT_TRUE(add({16, 32}, {0, 8}).ok()) << "nodes that met are one sum in the film";
  EXPECT_EQ(merged_, (std::vector<std::uint64_t>{16, 32}));
  desk_.retract(1, 7);
  EXPECT_EQ(merged_.size(), 2u);
  ASSERT_TRUE(add({0, 16}, {0, 4}).ok());
  EXPECT_EQ(merged_, (std::vector<std::uint64_t>{16, 32, 16, 32}));
  desk_.want_image(1, 32);
  ASSERT_EQ(images_.size(), 1u);
  EXPECT_EQ(images_[0].pixels, local(32));
}

TEST_F(FilmDeskTest, WhatIsDamagedInTheLogIsLeftOutAndTold) {
  desk_.plan(1, 16);
  ASSERT_TRUE(add({0, 16}, {0, 4}).ok());
  PutBand sound = logged({0, 16}, {4, 8});
  damage(sound.offset + 300);
  sound.renderer = 5;
  ASSERT_TRUE(desk_.add(1, std::move(sound), {{4, 6}, {6, 8}}).ok());
  EXPECT_EQ(merged_, (std::vector<std::uint64_t>{16})) << "it was added from memory";
  desk_.retract(1, 7);
  EXPECT_EQ(failed_, 0);
  ASSERT_EQ(damaged_.size(), 2u);
  for (const auto& lost : damaged_) {
    EXPECT_EQ(lost.process, 5u);
    EXPECT_EQ(lost.band.rows.count(), 2u);
  }
  ASSERT_TRUE(add({0, 16}, {4, 8}).ok());
  EXPECT_EQ(merged_, (std::vector<std::uint64_t>{16, 16}));
  desk_.want_image(1, 16);
  ASSERT_EQ(images_.size(), 1u);
  EXPECT_EQ(images_[0].pixels, local(16));
}

TEST_F(FilmDeskTest, AnotherBandInThePlaceOfOneIsDamage) {
  ASSERT_TRUE(add({0, 16}, {0, 4}).ok());
  PutBand other = logged({0, 16}, {4, 8});
  PutBand wrong = logged({0, 16}, {4, 8});
  wrong.pixels.sums[7] += 1;  // sound in the log, but not what was added
  wrong.offset = other.offset;
  ASSERT_TRUE(desk_.add(1, std::move(wrong), {{4, 8}}).ok());
  desk_.retract(1, 7);
  ASSERT_EQ(damaged_.size(), 1u);
  EXPECT_EQ(damaged_[0].band.rows, (RowRange{4, 8}));
}

TEST_F(FilmDeskTest, AnImageOfADamagedLogIsAskedForAgain) {
  ASSERT_TRUE(add({0, 16}, {0, 8}).ok());
  ASSERT_TRUE(add({16, 32}, {0, 3}).ok());
  ASSERT_TRUE(remove_file(folder_.bands(1)).ok());
  desk_.want_image(1, 16);
  EXPECT_TRUE(images_.empty());
  ASSERT_EQ(damaged_.size(), 1u) << "what lies beyond is not needed any more";
  BandLogReport report;
  log_.emplace(*BandLog::open(
      folder_.job(1), folder_.bands(1), [](BandRecord, std::uint64_t) {}, report));
  ASSERT_TRUE(add({0, 16}, {0, 8}).ok());
  EXPECT_TRUE(images_.empty());
  desk_.want_image(1, 16);
  ASSERT_EQ(images_.size(), 1u);
  EXPECT_EQ(images_[0].pixels, local(16));
}

TEST_F(FilmDeskTest, WhatIsInTheLogIsReadWhenTheFilmHasRoom) {
  desk_.plan(1, 16);
  ASSERT_TRUE(add({0, 16}, {0, 4}).ok());
  desk_.add_later(1, logged({0, 16}, {4, 8}), {{4, 8}});
  EXPECT_TRUE(merged_.empty());
  desk_.retry();
  EXPECT_EQ(merged_, (std::vector<std::uint64_t>{16}));
  desk_.want_image(1, 16);
  ASSERT_EQ(images_.size(), 1u);
  EXPECT_EQ(images_[0].pixels, local(16));
}

TEST_F(FilmDeskTest, AddsOnlyTheRowsThatAreNew) {
  ASSERT_TRUE(add({0, 16}, {2, 5}).ok());
  ASSERT_TRUE(add({0, 16}, {0, 8}, {{0, 2}, {5, 8}}).ok());
  desk_.want_image(1, 16);
  ASSERT_EQ(images_.size(), 1u);
  EXPECT_EQ(images_[0].pixels, local(16));
}

TEST_F(FilmDeskTest, AnImageOfFewerSamplesThanSomeRowsHaveIsThatOfTheFewer) {
  ASSERT_TRUE(add({0, 16}, {0, 8}).ok());
  ASSERT_TRUE(add({16, 32}, {0, 3}).ok());
  ASSERT_TRUE(add({16, 32}, {2, 5}, {{3, 5}}).ok());
  desk_.want_image(1, 16);
  ASSERT_EQ(images_.size(), 1u);
  EXPECT_EQ(images_[0].pixels, local(16));
}

TEST_F(FilmDeskTest, AnImageWaitsForItsLastRows) {
  ASSERT_TRUE(add({0, 16}, {0, 7}).ok());
  desk_.want_image(1, 16);
  EXPECT_TRUE(images_.empty());
  ASSERT_TRUE(add({0, 16}, {7, 8}).ok());
  ASSERT_EQ(images_.size(), 1u);
  EXPECT_FALSE(samples_.has_value()) << "all pixels have as many";
  EXPECT_EQ(images_[0].pixels, local(16));
}

TEST_F(FilmDeskTest, AnAdaptiveJobLeavesEachPixelsNumberOfSamples) {
  desk_.add_job(1, settings_, true);
  TileSamples even(settings_.width, {0, 8});
  even.set(0, {16, 32});
  ASSERT_TRUE(add({0, 16}, {0, 8}).ok());
  ASSERT_TRUE(desk_.add(1, logged({16, 32}, {0, 8}, even), {{0, 8}}).ok());
  desk_.want_image(1, 32);
  ASSERT_TRUE(samples_.has_value());
  ASSERT_EQ(samples_->pixels.size(), 48u);
  for (std::uint32_t y = 0; y < 8; ++y) {
    for (std::uint32_t x = 0; x < 6; ++x) {
      EXPECT_EQ(samples_->pixels[y * 6 + x], gray((x + y) % 2 == 0 ? 32 : 16)) << x << " " << y;
    }
  }
}

TEST_F(FilmDeskTest, WhatAFullDiskRefusedIsAddedLater) {
  PutBand first = logged({0, 16}, {0, 4});
  PutBand second = logged({0, 16}, {4, 8});
  desk_.plan(1, 16);
  {
    const test::FullDisk full(0);
    EXPECT_EQ(desk_.add(1, std::move(first), {{0, 4}}).code(),
              absl::StatusCode::kResourceExhausted);
    EXPECT_FALSE(desk_.add(1, std::move(second), {{4, 8}}).ok());
    desk_.want_image(1, 16);
    EXPECT_GE(failed_, 2);
  }
  EXPECT_TRUE(merged_.empty());
  desk_.retry();
  EXPECT_EQ(merged_, (std::vector<std::uint64_t>{16, 16})) << "the pass, and the finished image";
  ASSERT_EQ(images_.size(), 1u);
  EXPECT_EQ(images_[0].pixels, local(16));
}

TEST_F(FilmDeskTest, ADroppedJobTakesNothingMore) {
  ASSERT_TRUE(add({0, 16}, {0, 8}).ok());
  desk_.drop(1);
  EXPECT_TRUE(add({16, 32}, {0, 8}).ok());
  desk_.want_image(1, 16);
  EXPECT_TRUE(images_.empty());
}

TEST(Slice, TakesTheRowsAsked) {
  BandPixels band{.band = {.samples = {0, 16}, .rows = {4, 7}},
                  .width = 1,
                  .sums = {1, 2, 3, 4, 5, 6, 7, 8, 9},
                  .counters = {}};
  const BandPixels middle = slice(band, {5, 6});
  EXPECT_EQ(middle.sums, (std::vector<double>{4, 5, 6}));
  EXPECT_EQ(middle.band.rows, (RowRange{5, 6}));
  EXPECT_EQ(middle.width, 1u);
}

TEST_F(FilmDeskTest, APreviewShowsWhatIsThereAndWhoMadeIt) {
  EXPECT_TRUE(absl::IsNotFound(desk_.preview(1, 1).status()));
  PutBand put = logged({0, 16}, {2, 5});
  put.worker = "anna";
  ASSERT_TRUE(desk_.add(1, std::move(put), {{2, 5}}).ok());
  const Image whole = *desk_.preview(1, 1);
  EXPECT_EQ(whole.height, 8u);
  EXPECT_EQ(whole.at(3, 1), Rgb());
  EXPECT_EQ(whole.at(3, 4), local(16)[4 * 6 + 3]);
  const Image thirds = *desk_.preview(1, 3);
  EXPECT_EQ(thirds.height, 3u);
  EXPECT_EQ(thirds.at(3, 1), whole.at(3, 3));
  const std::vector<RowsBy> by_anna = {{{2, 5}, "anna"}};
  EXPECT_EQ(desk_.rendered_by(1), by_anna);
  desk_.drop(1);
  EXPECT_TRUE(absl::IsNotFound(desk_.preview(1, 1).status()));
}

TEST_F(FilmDeskTest, WhoMadeAnImageIsToldWithItAndReadFromBesideItLater) {
  PutBand put = logged({0, 16}, {0, 8});
  put.worker = "anna";
  ASSERT_TRUE(desk_.add(1, std::move(put), {{0, 8}}).ok());
  desk_.want_image(1, 16);
  const std::vector<RowsBy> by_anna = {{{0, 8}, "anna"}};
  EXPECT_EQ(credits_, by_anna);
  desk_.drop(1);
  EXPECT_TRUE(desk_.rendered_by(1).empty());
  ASSERT_TRUE(write_credits(by_anna, folder_.credits(1)).ok());
  EXPECT_EQ(desk_.rendered_by(1), by_anna);
}

}  // namespace
}  // namespace bandsaw::coordinator
