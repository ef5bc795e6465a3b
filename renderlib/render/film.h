#pragma once

// The accumulators of an image: takes bands in any order, holds every row's sums as nodes of the
// summation tree (render/band.h), merges siblings as they meet, and gives the image.
//
// Where half tiles take samples of their own in a pass (render/tile_samples.h), a pixel's sum is
// the tree of those, and its mean is over them.

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "renderlib/image/image.h"
#include "renderlib/render/adaptive_plan.h"
#include "renderlib/render/band.h"
#include "renderlib/render/error_estimate.h"
#include "renderlib/render/tile_samples.h"

namespace bandsaw {

class Film {
 public:
  /// Which pixels may have other samples than their neighbours: rows, or half tiles.
  enum class Grain { kRows, kHalfTiles };

  /// Memory grows as rows arrive: 24 bytes a pixel for each node that is not merged yet; at the end
  /// two halves. `spill_folder`: where to put the (unlinked) files the sums are mapped from; empty:
  /// plain memory. RESOURCE_EXHAUSTED: no memory or disk.
  static absl::StatusOr<Film> create(std::uint32_t width, std::uint32_t height,
                                     std::string spill_folder, Grain grain = Grain::kRows);
  Film(Film&&) noexcept;
  Film& operator=(Film&&) noexcept;
  ~Film();

  /// Adds rows that are not covered yet. FAILED_PRECONDITION: a row's samples, or some of them, are
  /// there already; then nothing was changed. RESOURCE_EXHAUSTED: no memory or disk. `tiles`: of
  /// the band, who took which samples; whole for a film of rows.
  absl::Status add(const BandPixels& pixels, const TileSamples& tiles = {});

  /// Whether samples [0, samples) of every row's passes are there, or were left out.
  bool complete(std::uint64_t samples) const;

  /// The image so far: mean of each pixel's first n samples, n the largest count whose maximal
  /// nodes are all there, as the fixed tree adds them, rounded to float once. Rows with none are
  /// `missing`, black.
  struct Snapshot {
    Image image;
    std::uint64_t least_samples = 0;  ///< of passes, over the rows
    std::uint32_t missing_rows = 0;
  };
  /// Of every row_step-th row (> 0): an image of so many rows; the counts are over those, too.
  Snapshot snapshot(std::uint32_t row_step = 1) const;

  /// Of the samples that a snapshot shows. Nothing until every row has two halves of equal size.
  std::optional<ErrorEstimate> error() const;

  /// The same of each half tile, of a film of half tiles: what plan_tiles reads. Empty where
  /// error() is nothing.
  std::vector<HalfTileErrors> tile_errors() const;

  /// How many samples of each pixel a snapshot shows.
  Image counts() const;

  std::uint32_t width() const;
  std::uint32_t height() const;

 private:
  struct Rows;
  explicit Film(std::unique_ptr<Rows> rows);
  std::unique_ptr<Rows> rows_;
};

}  // namespace bandsaw
