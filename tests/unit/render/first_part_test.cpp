// The first part of an image is an image of about half of its samples. The denoiser needs the first
// part beside the whole image. The share of a pixel is the number of its samples in the first part,
// divided by the number of all its samples.

#include "renderlib/render/first_part.h"

#include <gtest/gtest.h>

#include "renderlib/render/film.h"
#include "renderlib/render/render_image.h"

namespace bandsaw {
namespace {

/// Returns the film of an image of two pixels, each with `samples` samples.
Film film_of(std::uint64_t samples) {
  absl::StatusOr<Film> film = Film::create(2, 1, "");
  EXPECT_TRUE(film.ok());
  for (const Band& band : bands_of(samples, {0, 1}, 2)) {
    const BandPixels pixels{
        .band = band, .width = 2, .sums = std::vector<double>(6, 1.0), .counters = {}};
    EXPECT_TRUE(film->add(pixels).ok());
  }
  return *std::move(film);
}

// first_part_shares() computes the shares from the number of samples alone. They must equal the
// shares of Film::first_part(), which adds up nodes of samples.
TEST(FirstPart, SharesAreThoseOfTheFilm) {
  for (std::uint64_t samples = 1; samples <= 200; ++samples) {
    const auto part = film_of(samples).first_part();
    ASSERT_EQ(part.has_value(), first_part_samples(samples) > 0) << samples;
    if (part) {
      EXPECT_EQ(part->share, first_part_shares(samples, 2)) << samples;
    }
  }
  EXPECT_EQ(film_of(4096).first_part()->share, first_part_shares(4096, 2));
  EXPECT_EQ(film_of(5000).first_part()->share, first_part_shares(5000, 2));
}

// The first part has 16 of the 32 samples of the first pixel. The 112 samples of the second pixel
// are four ranges of 32, 32, 32 and 16 samples. The first and the third range are in the first
// part.
TEST(FirstPart, EachPixelOfAnAdaptiveImageHasItsShare) {
  const Image counts{2, 1, {gray(32), gray(112)}};
  EXPECT_EQ(first_part_shares(counts), (std::vector<float>{0.5f, static_cast<float>(64.0 / 112)}));
}

}  // namespace
}  // namespace bandsaw
