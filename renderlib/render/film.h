#pragma once

// The accumulation buffer of an image. It accepts bands (some rows, some samples) in any order and
// produces the image. A pixel's samples are added as in a binary tree, the summation tree
// (render/band.h). A node of this tree is the sum over an aligned range of 2^k blocks of 8 samples.
// The film stores the nodes of every row that have arrived, and merges siblings when both are
// present.
//
// In adaptive sampling, half tiles (half of the pixels of a tile) take their own samples in a pass
// (render/tile_samples.h). Then a pixel's sum is that of the samples that the pixel has taken,
// added along the tree, and the pixel's value is the mean of these samples.

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
  /// Units whose pixels always have the same samples: rows, or half tiles (for adaptive sampling).
  enum class Grain { kRows, kHalfTiles };

  /// Creates an empty film. Memory grows as rows arrive, by 24 bytes per pixel for each node that
  /// is not merged. The two halves that the error estimate needs always stay separate.
  /// `spill_folder` is the folder of the (unlinked) files that back the sums; empty: anonymous
  /// memory. Returns INVALID_ARGUMENT if the size is out of range (validate(RenderSettings)).
  static absl::StatusOr<Film> create(std::uint32_t width, std::uint32_t height,
                                     std::string spill_folder, Grain grain = Grain::kRows);
  Film(Film&&) noexcept;
  Film& operator=(Film&&) noexcept;
  ~Film();

  /// Adds a band. The samples of the band are then covered in the rows of the band. Returns
  /// FAILED_PRECONDITION, without changing anything, if some samples of a row are covered already;
  /// INVALID_ARGUMENT if the band does not fit the film; RESOURCE_EXHAUSTED if memory or disk is
  /// full. `tiles` says which samples the half tiles of the band took. For a film of rows it MUST
  /// be TileSamples::whole(): all pixels took the samples of the band.
  absl::Status add(const BandPixels& pixels, const TileSamples& tiles = {});

  /// Returns true if the samples [0, samples) are covered in every row, that is, if bands with
  /// these samples have been added. In adaptive sampling, a half tile may have taken other samples
  /// in these bands, or none.
  bool complete(std::uint64_t samples) const;

  /// The image of the samples that are present. A pixel is the mean of its first n samples, where n
  /// is the largest number for which all of the samples [0, n) are present. The samples are summed
  /// as the summation tree prescribes, and the mean is rounded to float once. Rows without samples
  /// are black and counted in `missing_rows`.
  struct Snapshot {
    Image image;
    /// The largest n for which the samples [0, n) are covered in all rows (see complete()).
    std::uint64_t least_samples = 0;
    std::uint32_t missing_rows = 0;
  };
  /// Returns an image of every row_step-th row (row_step > 0). `least_samples` and `missing_rows`
  /// are for these rows only.
  Snapshot snapshot(std::uint32_t row_step = 1) const;

  /// Returns an estimate of the error of the samples that a snapshot shows. The estimate needs the
  /// first two nodes of each pixel, [0, n) and [n, 2n), separately. Returns std::nullopt until all
  /// pixels have both nodes.
  std::optional<ErrorEstimate> error() const;

  /// One of two independent parts of the samples that a snapshot shows. The part contains about
  /// half of each pixel's samples, among them the pixel's first node of the summation tree.
  struct FirstPart {
    Image mean;
    std::vector<float> share;  ///< share in each pixel's samples, (0, 1)
  };
  /// Returns std::nullopt until every pixel has two nodes, that is, more than one block of 8
  /// samples. In a complete film, the part has first_part_samples() samples of each pixel
  /// (render/first_part.h).
  std::optional<FirstPart> first_part() const;

  /// Returns the errors of each half tile, for a film of half tiles: the input of plan_tiles. Empty
  /// if error() is std::nullopt.
  std::vector<HalfTileErrors> tile_errors() const;

  /// Returns the number of samples of each pixel that a snapshot shows, in all three channels.
  Image counts() const;

  std::uint32_t width() const;
  std::uint32_t height() const;

 private:
  struct Rows;
  explicit Film(std::unique_ptr<Rows> rows);
  std::unique_ptr<Rows> rows_;
};

}  // namespace bandsaw
