// Builds a grid of numbers in bricks of 8 x 8 x 8 cells. Each brick is hashed, so that a brick that
// is equal to an earlier one is found and not stored again.

#include "renderlib/medium/brick_builder.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <utility>

#include "renderlib/base/split_mix.h"

namespace bandsaw {
namespace {

std::uint64_t hash_of(absl::Span<const float> numbers) {
  std::uint64_t hash = 0;
  for (const float number : numbers) {
    hash = split_mix(hash + kSplitMixIncrement + std::bit_cast<std::uint32_t>(number));
  }
  return hash;
}

template <class T>
SharedBytes bytes_of(std::vector<T> values) {
  auto owner = std::make_shared<const std::vector<T>>(std::move(values));
  const absl::Span<const std::byte> bytes(reinterpret_cast<const std::byte*>(owner->data()),
                                          owner->size() * sizeof(T));
  return SharedBytes(std::move(owner), bytes);
}

}  // namespace

BrickBuilder::BrickBuilder(const std::array<std::uint32_t, 3>& cells, std::uint32_t channels)
    : cells_(cells),
      bricks_(brick_counts(cells)),
      channels_(channels),
      index_(all_bricks(cells), kEmptyBrick),
      brick_(std::size_t{kBrickCells} * channels) {}

std::uint32_t BrickBuilder::place_of(absl::Span<const float> brick) {
  const std::uint64_t hash = hash_of(brick);
  const auto [first, last] = places_.equal_range(hash);
  for (auto known = first; known != last; ++known) {
    if (std::equal(brick.begin(), brick.end(),
                   values_.begin() + static_cast<std::ptrdiff_t>(known->second * brick.size()))) {
      return known->second;
    }
  }
  const auto place = static_cast<std::uint32_t>(values_.size() / brick.size());
  places_.emplace(hash, place);
  values_.insert(values_.end(), brick.begin(), brick.end());
  if (halves_) {
    for (const float number : brick) {
      float_to_half(number, &halves_);  // sets halves_ to false unless the number is a half
    }
  }
  return place;
}

void BrickBuilder::set(std::uint32_t x, std::uint32_t y, std::uint32_t z,
                       absl::Span<const float> numbers) {
  const std::array<std::uint32_t, 3> first = {x * kBrickSide, y * kBrickSide, z * kBrickSide};
  bool any = false;
  for (std::uint32_t i = 0; i < kBrickCells; ++i) {
    const bool inside = first[0] + i % 8 < cells_[0] && first[1] + i / 8 % 8 < cells_[1] &&
                        first[2] + i / 64 < cells_[2];
    for (std::uint32_t c = 0; c < channels_; ++c) {
      const std::size_t at = std::size_t{i} * channels_ + c;
      // A negative zero becomes zero, so that equal bricks have equal bits.
      brick_[at] = inside ? numbers[at] + 0.0f : 0.0f;
      any = any || brick_[at] != 0;
    }
  }
  const std::size_t at = (std::size_t{z} * bricks_[1] + y) * bricks_[0] + x;
  index_[at] = any ? place_of(brick_) : kEmptyBrick;
}

VolumeGrid BrickBuilder::build() && {
  VolumeGrid grid;
  grid.cells = cells_;
  grid.channels = channels_;
  grid.index = bytes_of(std::move(index_));
  places_.clear();
  if (!halves_) {
    values_.shrink_to_fit();
    grid.values = bytes_of(std::move(values_));
    return grid;
  }
  std::vector<std::uint16_t> halves(values_.size());
  std::transform(values_.begin(), values_.end(), halves.begin(),
                 [this](float number) { return float_to_half(number, &halves_); });
  values_ = {};
  grid.format = VolumeGrid::Format::kFloat16;
  grid.values = bytes_of(std::move(halves));
  return grid;
}

VolumeGrid dense_grid(const std::array<std::uint32_t, 3>& cells, std::uint32_t channels,
                      absl::FunctionRef<float(std::size_t)> number) {
  BrickBuilder builder(cells, channels);
  std::vector<float> brick(std::size_t{kBrickCells} * channels);
  const auto [nx, ny, nz] = brick_counts(cells);
  for (std::uint32_t bz = 0; bz < nz; ++bz) {
    for (std::uint32_t by = 0; by < ny; ++by) {
      for (std::uint32_t bx = 0; bx < nx; ++bx) {
        std::fill(brick.begin(), brick.end(), 0.0f);
        const std::uint32_t x = bx * kBrickSide;
        const std::size_t width = std::min(kBrickSide, cells[0] - x) * std::size_t{channels};
        for (std::uint32_t row = 0; row < kBrickSide * kBrickSide; ++row) {
          const std::uint32_t y = by * kBrickSide + row % kBrickSide;
          const std::uint32_t z = bz * kBrickSide + row / kBrickSide;
          if (y < cells[1] && z < cells[2]) {
            const std::size_t from =
                ((std::size_t{z} * cells[1] + y) * cells[0] + x) * std::size_t{channels};
            for (std::size_t i = 0; i < width; ++i) {
              brick[std::size_t{row} * kBrickSide * channels + i] = number(from + i);
            }
          }
        }
        builder.set(bx, by, bz, brick);
      }
    }
  }
  return std::move(builder).build();
}

}  // namespace bandsaw
