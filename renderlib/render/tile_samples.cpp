// TileSamples stores a list with a range of samples for each half tile, row by row of tiles. A half
// tile is half of the pixels of a tile, and the unit of adaptive sampling. An empty list stands for
// uniform sampling.

#include "renderlib/render/tile_samples.h"

#include <algorithm>

#include "absl/strings/str_cat.h"

namespace bandsaw {
namespace {

std::uint32_t first_tile_row(const RowRange& rows) { return rows.first / kTileSide; }
std::uint32_t tile_rows(const RowRange& rows) {
  return (rows.last + kTileSide - 1) / kTileSide - first_tile_row(rows);
}

/// Returns the samples that a half tile takes in a band. In the whole pass with samples `pass`, the
/// half tile takes the samples `taken`. The band has the samples `within`, which are one of several
/// equal parts of the pass; the result is the corresponding part of `taken`. All three arguments
/// are nodes (aligned ranges of 2^k blocks of 8 samples, band.h). If `taken` has fewer blocks than
/// there are parts, each block stands for several parts. Then the result for the first of these
/// parts is the block, and the result for each further part is empty.
SampleRange part_of(const SampleRange& taken, const SampleRange& pass, const SampleRange& within) {
  const std::uint64_t parts = pass.blocks() / within.blocks();
  const std::uint64_t part = (within.first_block() - pass.first_block()) / within.blocks();
  const std::uint64_t blocks = taken.blocks();
  if (blocks < parts && part % (parts / blocks) != 0) {
    return {};
  }
  const std::uint64_t first = taken.first + part * blocks / parts * kBlockSamples;
  const std::uint64_t last = first + std::max<std::uint64_t>(1, blocks / parts) * kBlockSamples;
  return {first, std::min(last, taken.last)};
}

}  // namespace

HalfRow half_row(const TileGrid& grid, std::uint32_t column, std::uint32_t half, std::uint32_t y) {
  HalfRow row;
  const std::uint32_t left = column * kTileSide;
  for (std::uint32_t x = left; x < std::min(left + kTileSide, grid.width); ++x) {
    if (half_of(x, y) == half) {
      row.add(x);
    }
  }
  return row;
}

TileSamples::TileSamples(std::uint32_t width, const RowRange& rows)
    : columns_(TileGrid{width, 1}.columns()),
      first_tile_row_(first_tile_row(rows)),
      taken_(TileGrid{width, tile_rows(rows) * kTileSide}.half_tiles()) {}

absl::StatusOr<TileSamples> TileSamples::from_numbers(absl::Span<const std::uint32_t> numbers,
                                                      std::uint32_t width, const RowRange& rows) {
  if (numbers.empty()) {
    return TileSamples();
  }
  TileSamples tiles(width, rows);
  if (numbers.size() != 2 * tiles.taken_.size()) {
    return absl::InvalidArgumentError(
        absl::StrCat("tiles: rows [", rows.first, ", ", rows.last, ") of width ", width, " need ",
                     2 * tiles.taken_.size(), " numbers or none, are ", numbers.size()));
  }
  for (std::size_t i = 0; i < tiles.taken_.size(); ++i) {
    const SampleRange samples{numbers[2 * i], std::uint64_t{numbers[2 * i]} + numbers[2 * i + 1]};
    if (samples.samples() > 0 && (!is_node(samples) || samples.last > kMaxSamples)) {
      return absl::InvalidArgumentError(
          absl::StrCat("tiles: half tile ", i, " takes samples [", samples.first, ", ",
                       samples.last, "); must be empty, or an aligned range of 2^k blocks of ",
                       kBlockSamples, " samples below ", kMaxSamples));
    }
    tiles.set(i, samples);
  }
  return tiles;
}

std::uint64_t TileSamples::count(std::uint32_t width, const Band& band) const {
  if (whole()) {
    return band.samples.samples() * width * band.rows.count();
  }
  const TileGrid grid{width, band.rows.last};
  std::uint64_t sum = 0;
  for (std::uint32_t y = band.rows.first; y < band.rows.last; ++y) {
    for (std::uint32_t column = 0; column < columns_; ++column) {
      for (const std::uint32_t half : {0, 1}) {
        if (const HalfRow pixels = half_row(grid, column, half, y); pixels.count() > 0) {
          sum += pixels.count() * of_pixel(pixels[0], y, band.samples).samples();
        }
      }
    }
  }
  return sum;
}

TileSamples TileSamples::of(const RowRange& rows) const {
  if (whole()) {
    return {};
  }
  TileSamples part;
  part.columns_ = columns_;
  part.first_tile_row_ = first_tile_row(rows);
  const std::size_t in_row = std::size_t{2} * columns_;
  const auto first = taken_.begin() +
                     static_cast<std::ptrdiff_t>((part.first_tile_row_ - first_tile_row_) * in_row);
  part.taken_.assign(first, first + static_cast<std::ptrdiff_t>(tile_rows(rows) * in_row));
  return part;
}

TileSamples TileSamples::of(const SampleRange& pass, const Band& band) const {
  TileSamples part = of(band.rows);
  if (pass == band.samples) {
    return part;
  }
  for (std::size_t i = 0; i < part.taken_.size(); ++i) {
    if (const Taken taken = part.taken_[i]; taken.first != taken.last) {
      part.set(i, part_of(range(taken), pass, band.samples));
    }
  }
  return part;
}

std::vector<std::uint32_t> TileSamples::numbers() const {
  std::vector<std::uint32_t> numbers;
  numbers.reserve(2 * taken_.size());
  for (const Taken& taken : taken_) {
    numbers.insert(numbers.end(), {taken.first, taken.last - taken.first});
  }
  return numbers;
}

absl::Status check_left_out(const BandPixels& pixels, const TileSamples& tiles) {
  const RowRange& rows = pixels.band.rows;
  for (std::uint32_t y = rows.first; y < rows.last && !tiles.whole(); ++y) {
    for (std::uint32_t x = 0; x < pixels.width; ++x) {
      const double* const sum = &pixels.sums[(std::size_t{y - rows.first} * pixels.width + x) * 3];
      if (tiles.of_pixel(x, y, pixels.band.samples).samples() == 0 &&
          (sum[0] != 0 || sum[1] != 0 || sum[2] != 0)) {
        return absl::InvalidArgumentError(
            absl::StrCat("pixel (", x, ", ", y, ") has samples, but its half tile takes none"));
      }
    }
  }
  return absl::OkStatus();
}

absl::Status check_counters(const BandPixels& pixels, const TileSamples& tiles) {
  const Counters& counters = pixels.counters;
  const RowRange& rows = pixels.band.rows;
  const std::uint64_t samples = tiles.count(pixels.width, pixels.band);
  if (counters.bad_samples > samples || counters.truncated_paths > samples ||
      counters.negative_samples > counters.bad_samples) {
    return absl::InvalidArgumentError(absl::StrCat(
        "the band has ", samples, " samples; it must not count ", counters.bad_samples, " bad, ",
        counters.negative_samples, " negative, ", counters.truncated_paths, " truncated ones"));
  }
  if (counters.techniques > Counters::kAllTechniques) {
    return absl::InvalidArgumentError(
        absl::StrCat("the band used techniques ", counters.techniques, ", which are not known"));
  }
  if (counters.bad_samples == 0) {
    return absl::OkStatus();
  }
  const bool inside =
      counters.bad_x < pixels.width && counters.bad_y >= rows.first && counters.bad_y < rows.last;
  const SampleRange taken =
      inside ? tiles.of_pixel(counters.bad_x, counters.bad_y, pixels.band.samples) : SampleRange{};
  if (!inside || counters.bad_sample < taken.first || counters.bad_sample >= taken.last) {
    return absl::InvalidArgumentError(
        absl::StrCat("sample ", counters.bad_sample, " of pixel (", counters.bad_x, ", ",
                     counters.bad_y, ") is counted as bad and does not lie in the band"));
  }
  return absl::OkStatus();
}

}  // namespace bandsaw
