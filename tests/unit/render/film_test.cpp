// The film adds the sums of bands (ranges of samples by ranges of rows) to an image: it gives the
// same bits in any order, and estimates the image's error. A band has the samples of one node,
// which is an aligned range of 2^k blocks of 8 samples. An id such as A6 in a test's name is that
// of a case in tests/hard_cases/cases.txt.

#include "renderlib/render/film.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "renderlib/render/render_image.h"
#include "tests/support/hard_case.h"
#include "tests/support/temp_dir.h"
#include "tests/unit/render/film_values.h"

namespace bandsaw {
namespace {

using ::testing::HasSubstr;

Film make_film(std::uint32_t width, std::uint32_t height, const std::string& folder = "") {
  auto film = Film::create(width, height, folder);
  EXPECT_TRUE(film.ok()) << film.status();
  return *std::move(film);
}

/// Returns the mean of the first `samples` values of film_values.h for row y and k = 3 x + channel.
/// The maximal nodes are the fewest nodes that tile the samples. Their sums are added from the
/// first node to the last.
float expected(std::uint32_t y, std::size_t k, std::uint64_t samples) {
  double total = 0;
  bool first = true;
  for (const SampleRange& node : maximal_nodes(samples)) {
    const double sum = node_sum(y, k, node);
    total = first ? sum : total + sum;
    first = false;
  }
  return static_cast<float>(total / static_cast<double>(samples));
}

/// Expects that the film has exactly the first `samples` samples of every pixel.
void expect_image(const Film& film, std::uint64_t samples) {
  const Film::Snapshot snapshot = film.snapshot();
  EXPECT_EQ(snapshot.least_samples, samples);
  EXPECT_EQ(snapshot.missing_rows, 0u);
  EXPECT_TRUE(film.complete(samples));
  EXPECT_FALSE(film.complete(samples + 1));
  for (std::uint32_t y = 0; y < film.height(); ++y) {
    for (std::uint32_t x = 0; x < film.width(); ++x) {
      const Rgb& pixel = snapshot.image.at(x, y);
      ASSERT_EQ(pixel.r, expected(y, 3 * x, samples)) << samples;
      ASSERT_EQ(pixel.g, expected(y, 3 * x + 1, samples));
      ASSERT_EQ(pixel.b, expected(y, 3 * x + 2, samples));
    }
  }
}

TEST(Film, A6_AnyPartitionInAnyOrderGivesTheSameBits) {
  Random random(1);
  for (std::uint64_t samples = 1; samples <= 700; samples += 1 + samples / 9) {
    const std::uint32_t width = 2;
    const std::uint32_t height = 3;
    Film film = make_film(width, height);
    std::vector<Band> bands;
    for (std::uint32_t y = 0; y < height; ++y) {
      for (const SampleRange& node : random_nodes(samples, random)) {
        bands.push_back({node, {y, y + 1}});
      }
    }
    for (std::size_t i = bands.size(); i > 1; --i) {
      std::swap(bands[i - 1], bands[random.below(static_cast<std::uint32_t>(i))]);
    }
    for (const Band& band : bands) {
      const absl::Status added = film.add(band_pixels(band, width));
      ASSERT_TRUE(added.ok()) << added;
    }
    expect_image(film, samples);
  }
  test::report_hard_case("A6", "same bits for any division into bands, added in any order");
}

TEST(Film, GivesTheSameImageOnDisk) {
  const test::TempDir folder;
  Film film = make_film(5, 4, folder.path());
  for (const Band& band : bands_of(100, {0, 4}, 5)) {
    ASSERT_TRUE(film.add(band_pixels(band, 5)).ok());
  }
  expect_image(film, 100);
}

TEST(Film, DuplicatesAreRefusedAndChangeNothing) {
  Film film = make_film(2, 4);
  ASSERT_TRUE(film.add(band_pixels({{0, 32}, {1, 2}}, 2)).ok());
  for (const SampleRange& range : {SampleRange{0, 32}, {0, 16}, {16, 32}, {16, 20}, {0, 64}}) {
    const absl::Status again = film.add(band_pixels({range, {0, 4}}, 2));
    EXPECT_EQ(again.code(), absl::StatusCode::kFailedPrecondition);
    EXPECT_THAT(std::string(again.message()), HasSubstr("row 1: samples [0, 32)"));
  }
  EXPECT_EQ(film.snapshot().missing_rows, 3u);
  ASSERT_TRUE(film.add(band_pixels({{0, 32}, {0, 1}}, 2)).ok());
  ASSERT_TRUE(film.add(band_pixels({{0, 32}, {2, 4}}, 2)).ok());
  expect_image(film, 32);
}

TEST(Film, BandsOfAnotherImageAreRefused) {
  Film film = make_film(2, 4);
  EXPECT_EQ(film.add(band_pixels({{0, 16}, {0, 1}}, 3)).code(), absl::StatusCode::kInvalidArgument);
  BandPixels pixels = band_pixels({{0, 16}, {0, 1}}, 2);
  pixels.band.rows = {4, 5};
  EXPECT_EQ(film.add(pixels).code(), absl::StatusCode::kInvalidArgument);
  pixels = band_pixels({{0, 16}, {0, 1}}, 2);
  pixels.sums.pop_back();
  EXPECT_EQ(film.add(pixels).code(), absl::StatusCode::kInvalidArgument);
  pixels = band_pixels({{0, 16}, {0, 1}}, 2);
  pixels.band.samples = {16, 48};
  EXPECT_EQ(film.add(pixels).code(), absl::StatusCode::kInvalidArgument);
}

TEST(Film, RowsWithoutTheFirstSampleAreMissing) {
  Film film = make_film(1, 3);
  ASSERT_TRUE(film.add(band_pixels({{16, 32}, {0, 3}}, 1)).ok());
  ASSERT_TRUE(film.add(band_pixels({{0, 16}, {2, 3}}, 1)).ok());
  const Film::Snapshot snapshot = film.snapshot();
  EXPECT_EQ(snapshot.missing_rows, 2u);
  EXPECT_EQ(snapshot.least_samples, 0u);
  EXPECT_EQ(snapshot.image.at(0, 0), Rgb{});
  EXPECT_EQ(snapshot.image.at(0, 2).r, expected(2, 0, 32));
}

TEST(Film, TheErrorIsKnownWhenEachRowHasTwoEqualHalves) {
  Film film = make_film(1, 2);
  const auto add = [&](SampleRange samples, RowRange rows) {
    ASSERT_TRUE(film.add(band_pixels({samples, rows}, 1)).ok());
  };
  add({0, 16}, {0, 2});
  EXPECT_FALSE(film.error());
  add({16, 32}, {0, 1});
  EXPECT_FALSE(film.error());
  add({16, 32}, {1, 2});
  EXPECT_TRUE(film.error());
  add({32, 48}, {0, 2});
  EXPECT_TRUE(film.error());
  add({48, 60}, {0, 2});
  EXPECT_TRUE(film.error());
  Film whole = make_film(1, 1);
  ASSERT_TRUE(whole.add(band_pixels({{0, 64}, {0, 1}}, 1)).ok());
  EXPECT_FALSE(whole.error()) << "a single node must give no error estimate";
}

// The first part of an image is the mean of about half of its samples. `share` is the number of a
// pixel's samples in the first part, divided by the number of all samples of the pixel.
TEST(Film, TheFirstPartIsAboutHalfOfTheSamples) {
  const std::vector<SampleRange> nodes = {{0, 32}, {32, 64}, {64, 96}, {96, 112}};
  Film film = make_film(2, 1);
  for (const SampleRange& node : nodes) {
    ASSERT_TRUE(film.add(band_pixels({node, {0, 1}}, 2)).ok());
    EXPECT_EQ(film.first_part().has_value(), node.first > 0);
  }
  // The first two nodes are in different parts. The third node goes to the first part, which is
  // then the larger part. So the fourth node goes to the second part.
  const auto part = film.first_part();
  ASSERT_TRUE(part);
  ASSERT_EQ(part->share.size(), 2u);
  EXPECT_EQ(part->share[1], static_cast<float>(64.0 / 112));
  const double sum = node_sum(0, 3, nodes[0]) + node_sum(0, 3, nodes[2]);
  EXPECT_EQ(part->mean.at(1, 0).r, static_cast<float>(sum / 64));
}

// 64 samples form two halves of the same size. 80, 96 and 112 samples have further nodes after
// these halves. 72 samples end with a single block of 8.
TEST(Film, TheErrorOfIndependentSamplesIsTheirStandardError) {
  // Samples uniform in [0, 2): mean 1, variance 1/3. The estimate is a root of a mean of 128 x 96 x
  // 3 squares, whose relative error is 1 / sqrt(2 * 36864) = 0.4 %; the tolerance of 2 % is five
  // times that.
  const std::uint32_t width = 128;
  const std::uint32_t height = 96;
  for (const std::uint64_t samples : {64, 80, 96, 112, 72}) {
    Film film = make_film(width, height);
    Random random(7);
    for (const Band& band : bands_of(samples, {0, height}, width)) {
      BandPixels pixels{.band = band, .width = width, .sums = {}, .counters = {}};
      for (std::size_t k = 0; k < std::size_t{width} * height * 3; ++k) {
        double sum = 0;
        for (std::uint64_t i = 0; i < band.samples.samples(); ++i) {
          sum += random.uniform(0, 2);
        }
        pixels.sums.push_back(sum);
      }
      ASSERT_TRUE(film.add(pixels).ok());
    }
    const std::optional<ErrorEstimate> error = film.error();
    ASSERT_TRUE(error);
    EXPECT_NEAR(error->mean, 1, 0.003);
    const double standard_error = std::sqrt(1.0 / 3 / static_cast<double>(samples));
    EXPECT_NEAR(error->relative_rmse / standard_error, 1, 0.02) << samples;
  }
}

TEST(Film, AMissingFolderIsAnErrorWhenAdding) {
  Film film = make_film(2, 2, "/nowhere/at/all");
  EXPECT_FALSE(film.add(band_pixels({{0, 16}, {0, 2}}, 2)).ok());
  EXPECT_EQ(film.snapshot().missing_rows, 2u);
}

}  // namespace
}  // namespace bandsaw
