#pragma once

// Blocks, ranges of samples, bands: the fixed binary tree that every pixel's sum is.
//
// A block is 16 consecutive samples of a pixel, aligned, added in order. A node is an aligned
// power-of-two number of blocks: the sum of its two halves. A total over N samples adds its maximal
// aligned nodes from left to right. The last block of a job may be cut off at its last sample. So
// any node can be rendered anywhere, and stopping, resuming and merging in any order give the same
// bits.

#include <cstdint>
#include <vector>

#include "absl/status/status.h"
#include "renderlib/render/settings.h"

namespace bandsaw {

inline constexpr std::uint64_t kBlockSamples = 16;

/// The samples [first, last) of a node: first is a multiple of 16; in blocks, the range is aligned
/// and a power of two long once a cut-off last block is counted whole.
struct SampleRange {
  std::uint64_t first = 0;
  std::uint64_t last = 0;

  std::uint64_t first_block() const { return first / kBlockSamples; }
  std::uint64_t blocks() const { return (last - first + kBlockSamples - 1) / kBlockSamples; }
  std::uint64_t samples() const { return last - first; }
  friend auto operator<=>(const SampleRange&, const SampleRange&) = default;
};

/// Whether the range is a node of the tree.
bool is_node(const SampleRange& range);

/// How many blocks the longest node has that begins at this block, > 0.
constexpr std::uint64_t longest_at(std::uint64_t block) { return block & (~block + 1); }

/// The maximal aligned nodes of samples [0, samples), from left to right.
std::vector<SampleRange> maximal_nodes(std::uint64_t samples);

/// The halves of a node of two or more blocks. A half that begins at or after the cut-off does not
/// occur: such a node has one block fewer levels.
struct Halves {
  SampleRange left;
  SampleRange right;
};
Halves split(const SampleRange& node);

/// Rows [first, last) of the whole image, from the top.
struct RowRange {
  std::uint32_t first = 0;
  std::uint32_t last = 0;
  std::uint32_t count() const { return last - first; }
  friend auto operator<=>(const RowRange&, const RowRange&) = default;
};

/// The unit that is sent to a worker.
struct Band {
  SampleRange samples;
  RowRange rows;
  friend auto operator<=>(const Band&, const Band&) = default;
};

/// INVALID_ARGUMENT when the band is not one of an image of these settings.
absl::Status validate(const Band& band, const RenderSettings& settings);

/// What rendering cost and met.
struct Counters {
  std::uint64_t rays = 0;
  /// Samples that were NaN, infinite or negative and were left out of the sums, where the mean of
  /// the others of their block stands for them; the first of them in (row, x, sample) order.
  std::uint64_t bad_samples = 0;
  std::uint32_t bad_x = 0;
  std::uint32_t bad_y = 0;
  std::uint64_t bad_sample = 0;
  std::uint64_t negative_samples = 0;  ///< of bad_samples: those that are finite
  /// Samples whose path was cut off at max_depth: what it would have brought is missing.
  std::uint64_t truncated_paths = 0;
  /// Of the scene (Scene::dropped_primitives): the same in all bands.
  std::uint64_t dropped_primitives = 0;

  void add(const Counters& other);
  friend bool operator==(const Counters&, const Counters&) = default;
};

/// The pixels of a band: for each, row by row, the sum of its samples' r, g, b.
struct BandPixels {
  Band band;
  std::uint32_t width = 0;
  std::vector<double> sums;  ///< rows x width x 3
  Counters counters;
};

}  // namespace bandsaw
