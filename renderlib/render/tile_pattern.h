#pragma once

// The pattern by which the pixels of a tile, a square of 16 x 16 pixels, form groups. Pixels of a
// group may share their paths (render/pixel_groups.h). Adaptive sampling (render/tile_samples.h)
// divides a tile into two halves: the groups with even numbers and the groups with odd numbers.

#include <cstdint>

namespace bandsaw {

inline constexpr std::uint32_t kTileSide = 16;      ///< pixels
inline constexpr std::uint32_t kGroupsOfTile = 32;  ///< groups of eight pixels

/// Returns the number of the group within its tile, below kGroupsOfTile, to which pixel (x, y) of
/// the image belongs. All tiles have one pattern, mirrored at random. The pattern was made by
/// simulated annealing for two aims. First, the pixels of a group are near each other, and nearer
/// vertically than horizontally. The reason is that floors and ceilings are seen from the side, so
/// that a vertical step of a pixel is a longer distance on them than a horizontal step. Second, of
/// all pairs of pixels at any one distance, at most 5.1 % are in the same group, so that the errors
/// of neighbours are nearly uncorrelated. Each row of a tile has eight pixels in even groups and
/// eight in odd ones.
std::uint32_t group_in_tile(std::uint32_t x, std::uint32_t y);

}  // namespace bandsaw
