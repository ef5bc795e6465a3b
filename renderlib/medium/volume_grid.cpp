// Checks of a grid, and a reader that finds the brick of a cell and interpolates between cells.

#include "renderlib/medium/volume_grid.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

#include "absl/strings/str_cat.h"
#include "renderlib/base/status_macros.h"

namespace bandsaw {
namespace {

absl::Status invalid(absl::string_view field, absl::string_view why) {
  return absl::InvalidArgumentError(absl::StrCat(".", field, ": ", why));
}

template <class T>
T load(const std::byte* from, std::size_t index) {
  T value;
  std::memcpy(&value, from + index * sizeof(T), sizeof(T));
  return value;
}

absl::Status check_sizes(const VolumeGrid& grid) {
  for (const std::uint32_t side : grid.cells) {
    if (side < 1 || side > kMaxGridSide) {
      return invalid("cells", absl::StrCat("must be in [1, ", kMaxGridSide, "], is ", side));
    }
  }
  if (grid.channels != 1 && grid.channels != 3) {
    return invalid("channels", absl::StrCat("must be 1 or 3, is ", grid.channels));
  }
  if (!inverse(grid.to_medium)) {
    return invalid("to_medium", "must not be singular");
  }
  const std::uint64_t bricks = all_bricks(grid.cells);
  if (bricks > kMaxGridBricks) {
    return invalid("cells", absl::StrCat("must be at most ", kMaxGridBricks,
                                         " bricks of 8 x 8 x 8 cells, are ", bricks));
  }
  if (grid.index.size() != bricks * sizeof(std::uint32_t)) {
    return invalid("index",
                   absl::StrCat("must have ", bricks * sizeof(std::uint32_t), " bytes for ", bricks,
                                " bricks, has ", grid.index.size()));
  }
  const std::uint64_t each = brick_bytes(grid.channels, grid.format);
  if (grid.values.size() % each != 0) {
    return invalid("values", absl::StrCat("must be bricks of ", each, " bytes, has ",
                                          grid.values.size(), " bytes"));
  }
  return absl::OkStatus();
}

absl::Status check_index(const VolumeGrid& grid) {
  const std::uint64_t stored = grid.values.size() / brick_bytes(grid.channels, grid.format);
  const std::uint64_t bricks = all_bricks(grid.cells);
  for (std::uint64_t i = 0; i < bricks; ++i) {
    const auto at = load<std::uint32_t>(grid.index.data(), i);
    if (at != kEmptyBrick && at >= stored) {
      return invalid(absl::StrCat("index[", i, "]"),
                     absl::StrCat("must be below ", stored, ", is ", at));
    }
  }
  return absl::OkStatus();
}

/// Checks the range of all numbers and returns the largest.
absl::StatusOr<float> check_values(const VolumeGrid& grid) {
  const bool half = grid.format == VolumeGrid::Format::kFloat16;
  const std::size_t count = grid.values.size() / (half ? 2 : 4);
  std::uint32_t most = 0;
  for (std::size_t i = 0; i < count; ++i) {
    // If the sign bit is 0, the bits are ordered as the numbers are. Infinities, NaNs and numbers
    // with the sign bit have larger bits than all finite numbers without it.
    const std::uint32_t bits = half ? load<std::uint16_t>(grid.values.data(), i)
                                    : load<std::uint32_t>(grid.values.data(), i);
    if (bits >= (half ? 0x7c00u : 0x7f800000u)) {
      const float value =
          half ? half_to_float(static_cast<std::uint16_t>(bits)) : std::bit_cast<float>(bits);
      return invalid(absl::StrCat("values[", i, "]"),
                     absl::StrCat("must be finite and >= 0, is ", value));
    }
    most = std::max(most, bits);
  }
  return half ? half_to_float(static_cast<std::uint16_t>(most)) : std::bit_cast<float>(most);
}

/// Checks that the numbers of a brick are 0 outside of the box. `inside` is the number of the
/// brick's cells along each axis that are in the box.
absl::Status check_outside(const VolumeGrid& grid, const GridReader& reader, std::uint32_t brick,
                           const std::array<std::uint32_t, 3>& inside) {
  for (std::uint32_t i = 0; i < kBrickCells; ++i) {
    const bool in = i % 8 < inside[0] && i / 8 % 8 < inside[1] && i / 64 < inside[2];
    for (std::uint32_t c = 0; !in && c < grid.channels; ++c) {
      if (reader.stored(brick, i * grid.channels + c) != 0) {
        return invalid("values", absl::StrCat("must be 0 outside of the box, but brick ", brick,
                                              " has another value there"));
      }
    }
  }
  return absl::OkStatus();
}

/// Calls check_outside() for every stored brick that reaches beyond the box.
absl::Status check_all_outside(const VolumeGrid& grid) {
  const GridReader reader(grid);
  const auto [nx, ny, nz] = brick_counts(grid.cells);
  const auto inside = [&](std::size_t axis, std::uint32_t brick) {
    return std::min(kBrickSide, grid.cells[axis] - brick * kBrickSide);
  };
  for (std::uint32_t z = 0; z < nz; ++z) {
    for (std::uint32_t y = 0; y < ny; ++y) {
      for (std::uint32_t x = 0; x < nx; ++x) {
        const std::uint32_t brick = reader.brick(x, y, z);
        const std::array<std::uint32_t, 3> part = {inside(0, x), inside(1, y), inside(2, z)};
        if (brick != kEmptyBrick && part[0] * part[1] * part[2] < kBrickCells) {
          RETURN_IF_ERROR(check_outside(grid, reader, brick, part));
        }
      }
    }
  }
  return absl::OkStatus();
}

}  // namespace

absl::StatusOr<float> check_grid(const VolumeGrid& grid) {
  RETURN_IF_ERROR(check_sizes(grid));
  RETURN_IF_ERROR(check_index(grid));
  ASSIGN_OR_RETURN(const float most, check_values(grid));
  RETURN_IF_ERROR(check_all_outside(grid));
  return most;
}

// A half has 10 bits of fraction, 13 fewer than a float, and an exponent with a bias of 15 instead
// of 127: 0x38000000 is the difference, 112, at the place of a float's exponent. Below 2^-14 halves
// are multiples of 2^-24.
float half_to_float(std::uint16_t half) {
  const std::uint32_t sign = (half & 0x8000u) << 16;
  const std::uint32_t rest = half & 0x7fffu;
  if (rest >= 0x7c00) {
    return std::bit_cast<float>(sign | 0x7f800000u | (rest & 0x3ffu) << 13);
  }
  if (rest < 0x400) {
    const float small = static_cast<float>(rest) * 0x1p-24f;
    return sign != 0 ? -small : small;
  }
  return std::bit_cast<float>(sign | ((rest << 13) + 0x38000000u));
}

std::uint16_t float_to_half(float value, bool* exact) {
  const auto bits = std::bit_cast<std::uint32_t>(value);
  const auto sign = static_cast<std::uint16_t>(bits >> 16 & 0x8000u);
  const float size = std::abs(value);
  std::uint32_t half = 0;
  if (size < 0x1p-14f) {
    half = static_cast<std::uint32_t>(size * 0x1p24f);
  } else if (size < 65536) {
    half = ((bits & 0x7fffffffu) - 0x38000000u) >> 13;
  } else {
    half = 0x7c00;
  }
  const auto result = static_cast<std::uint16_t>(sign | half);
  *exact = *exact && half_to_float(result) == value;
  return result;
}

GridReader::GridReader(const VolumeGrid& grid)
    : cells_(grid.cells),
      bricks_(brick_counts(grid.cells)),
      channels_(grid.channels),
      half_(grid.format == VolumeGrid::Format::kFloat16),
      nearest_(grid.filter == VolumeGrid::Filter::kNearest),
      clamp_(grid.border == VolumeGrid::Border::kClamp),
      index_(grid.index.data()),
      values_(grid.values.data()) {}

std::uint32_t GridReader::brick(std::uint32_t x, std::uint32_t y, std::uint32_t z) const {
  return load<std::uint32_t>(index_,
                             (std::size_t{z} * bricks_[1] + y) * std::size_t{bricks_[0]} + x);
}

float GridReader::stored(std::uint32_t brick, std::uint32_t number) const {
  const std::size_t at = std::size_t{brick} * kBrickCells * channels_ + number;
  return half_ ? half_to_float(load<std::uint16_t>(values_, at)) : load<float>(values_, at);
}

float GridReader::cell(std::uint32_t x, std::uint32_t y, std::uint32_t z,
                       std::uint32_t channel) const {
  const std::uint32_t at = brick(x / kBrickSide, y / kBrickSide, z / kBrickSide);
  if (at == kEmptyBrick) {
    return 0;
  }
  const std::uint32_t in_brick =
      (z % kBrickSide * kBrickSide + y % kBrickSide) * kBrickSide + x % kBrickSide;
  return stored(at, in_brick * channels_ + channel);
}

namespace {

float number_of(float stored) { return stored; }
/// Returns the number of a half that is >= 0 and finite. The result is exact: the exponents of a
/// float and of a half have different biases, and the factor 2^112 corrects the difference.
float number_of(std::uint16_t half) {
  return std::bit_cast<float>(std::uint32_t{half} << 13) * 0x1p112f;
}

/// Loads the cells at the corners of a cube. The first corner is cell `first` of the brick at
/// `stored`.
template <class Stored, std::size_t kChannels>
void load_corners(const std::byte* stored, std::uint32_t channels, std::uint32_t first,
                  std::array<std::array<float, kChannels>, 8>& corner) {
  for (std::uint32_t i = 0; i < 8; ++i) {
    const std::uint32_t cell =
        first + (i & 1) + (i >> 1 & 1) * kBrickSide + (i >> 2) * kBrickSide * kBrickSide;
    for (std::uint32_t c = 0; c < kChannels; ++c) {
      corner[i][c] = number_of(load<Stored>(stored, cell * channels + c));
    }
  }
}

/// Interpolates linearly between the corners of a cube, which are given x fastest. `share` is the
/// place in the cube along each axis, in [0, 1].
template <std::size_t kChannels>
std::array<float, kChannels> mix_corners(const std::array<std::array<float, kChannels>, 8>& corner,
                                         const std::array<float, 3>& share) {
  std::array<float, kChannels> result{};
  for (std::size_t c = 0; c < kChannels; ++c) {
    const auto mix = [](float a, float b, float t) { return a + (b - a) * t; };
    const auto row = [&](std::size_t i) { return mix(corner[i][c], corner[i + 1][c], share[0]); };
    result[c] = mix(mix(row(0), row(2), share[1]), mix(row(4), row(6), share[1]), share[2]);
  }
  return result;
}

}  // namespace

template <std::uint32_t kChannels>
std::array<float, kChannels> GridReader::cell_or_zero(const std::array<std::int32_t, 3>& at) const {
  std::array<float, kChannels> result{};
  std::array<std::uint32_t, 3> in{};
  for (std::size_t k = 0; k < 3; ++k) {
    const auto last = static_cast<std::int32_t>(cells_[k]) - 1;
    const std::int32_t held = std::min(std::max(at[k], 0), last);
    if (held != at[k] && !clamp_) {
      return result;
    }
    in[k] = static_cast<std::uint32_t>(held);
  }
  for (std::uint32_t c = 0; c < kChannels; ++c) {
    result[c] = cell(in[0], in[1], in[2], c);
  }
  return result;
}

template <std::uint32_t kChannels>
std::array<float, kChannels> GridReader::interpolate(const Vec3& at) const {
  using Values = std::array<float, kChannels>;
  const std::array<double, 3> p = {at.x, at.y, at.z};
  std::array<std::int32_t, 3> low{};
  std::array<float, 3> share{};
  bool one_brick = true;
  for (std::size_t k = 0; k < 3; ++k) {
    if (!(p[k] >= 0 && p[k] <= cells_[k])) {
      return Values{};
    }
    // Truncation rounds down, because neither p[k] nor p[k] + 0.5 is negative.
    low[k] = nearest_ ? std::min(static_cast<std::int32_t>(p[k]),
                                 static_cast<std::int32_t>(cells_[k]) - 1)
                      : static_cast<std::int32_t>(p[k] + 0.5) - 1;
    share[k] = static_cast<float>(p[k] - 0.5 - low[k]);
    one_brick = one_brick && low[k] >= 0 && (low[k] & 7) != 7 &&
                (!clamp_ || low[k] + 1 < static_cast<std::int32_t>(cells_[k]));
  }
  if (nearest_) {
    return cell_or_zero<kChannels>(low);
  }
  // The eight corners of the cube between cell centres, x fastest.
  std::array<Values, 8> corner;
  if (one_brick) {
    const std::array<std::uint32_t, 3> l = {static_cast<std::uint32_t>(low[0]),
                                            static_cast<std::uint32_t>(low[1]),
                                            static_cast<std::uint32_t>(low[2])};
    const std::uint32_t place = brick(l[0] / kBrickSide, l[1] / kBrickSide, l[2] / kBrickSide);
    if (place == kEmptyBrick) {
      return Values{};
    }
    const std::uint32_t first =
        (l[2] % kBrickSide * kBrickSide + l[1] % kBrickSide) * kBrickSide + l[0] % kBrickSide;
    const std::byte* const stored =
        values_ + std::size_t{place} * kBrickCells * channels_ * (half_ ? 2 : 4);
    half_ ? load_corners<std::uint16_t>(stored, channels_, first, corner)
          : load_corners<float>(stored, channels_, first, corner);
  } else {
    for (std::int32_t i = 0; i < 8; ++i) {
      corner[static_cast<std::size_t>(i)] =
          cell_or_zero<kChannels>({low[0] + (i & 1), low[1] + (i >> 1 & 1), low[2] + (i >> 2)});
    }
  }
  return mix_corners(corner, share);
}

template std::array<float, 1> GridReader::interpolate<1>(const Vec3&) const;

Rgb GridReader::color(const Vec3& at) const {
  if (channels_ == 1) {
    return gray(value(at));
  }
  const std::array<float, 3> v = interpolate<3>(at);
  return {v[0], v[1], v[2]};
}

}  // namespace bandsaw
