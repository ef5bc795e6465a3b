#include "renderlib/render/tile_mask.h"

#include <algorithm>
#include <utility>

#include "absl/strings/str_cat.h"

namespace bandsaw {
namespace {

std::uint32_t first_tile_row(const RowRange& rows) { return rows.first / kTileSide; }
std::uint32_t tile_rows(const RowRange& rows) {
  return (rows.last + kTileSide - 1) / kTileSide - first_tile_row(rows);
}

std::size_t bytes_of(std::uint32_t width, const RowRange& rows) {
  return (TileGrid{width, tile_rows(rows) * kTileSide}.half_tiles() + 7) / 8;
}

}  // namespace

HalfRow half_row(const TileGrid& grid, std::uint32_t column, std::uint32_t half, std::uint32_t y) {
  const std::uint32_t left = column * kTileSide;
  return {left + ((left + y + half) & 1), std::min(left + kTileSide, grid.width)};
}

TileMask::TileMask(std::uint32_t width, const RowRange& rows)
    : columns_(TileGrid{width, 1}.columns()),
      first_tile_row_(first_tile_row(rows)),
      bits_(bytes_of(width, rows), '\0') {}

absl::StatusOr<TileMask> TileMask::from_bits(std::string bits, std::uint32_t width,
                                             const RowRange& rows) {
  if (bits.empty()) {
    return TileMask();
  }
  TileMask mask(width, rows);
  if (bits.size() != mask.bits_.size()) {
    return absl::InvalidArgumentError(
        absl::StrCat("tiles: rows [", rows.first, ", ", rows.last, ") of width ", width, " need ",
                     mask.bits_.size(), " bytes or none, are ", bits.size()));
  }
  mask.bits_ = std::move(bits);
  return mask;
}

void TileMask::add(std::uint32_t x, std::uint32_t y) {
  const std::size_t bit = bit_of(x, y);
  bits_[bit / 8] = static_cast<char>(bits_[bit / 8] | 1 << (bit % 8));
}

std::uint64_t TileMask::pixels(std::uint32_t width, const RowRange& rows) const {
  if (whole()) {
    return std::uint64_t{width} * rows.count();
  }
  const TileGrid grid{width, rows.last};
  std::uint64_t sum = 0;
  for (std::uint32_t y = rows.first; y < rows.last; ++y) {
    for (std::uint32_t column = 0; column < columns_; ++column) {
      for (const std::uint32_t half : {0, 1}) {
        const HalfRow pixels = half_row(grid, column, half, y);
        sum += pixels.count() > 0 && has(pixels.first, y) ? pixels.count() : 0;
      }
    }
  }
  return sum;
}

TileMask TileMask::of(const RowRange& rows) const {
  if (whole()) {
    return {};
  }
  TileMask part;
  part.columns_ = columns_;
  part.first_tile_row_ = first_tile_row(rows);
  const std::size_t row_bits = std::size_t{2} * columns_;
  const std::size_t from = (part.first_tile_row_ - first_tile_row_) * row_bits;
  const std::size_t count = tile_rows(rows) * row_bits;
  part.bits_.assign((count + 7) / 8, '\0');
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t bit = from + i;
    if ((bits_[bit / 8] >> (bit % 8) & 1) != 0) {
      part.bits_[i / 8] = static_cast<char>(part.bits_[i / 8] | 1 << (i % 8));
    }
  }
  return part;
}

absl::Status check_left_out(const BandPixels& pixels, const TileMask& mask) {
  const RowRange& rows = pixels.band.rows;
  for (std::uint32_t y = rows.first; y < rows.last && !mask.whole(); ++y) {
    for (std::uint32_t x = 0; x < pixels.width; ++x) {
      const double* const sum = &pixels.sums[(std::size_t{y - rows.first} * pixels.width + x) * 3];
      if (!mask.has(x, y) && (sum[0] != 0 || sum[1] != 0 || sum[2] != 0)) {
        return absl::InvalidArgumentError(absl::StrCat(
            "pixel (", x, ", ", y, ") has samples and its tile does not take part in the pass"));
      }
    }
  }
  return absl::OkStatus();
}

}  // namespace bandsaw
