#pragma once

// Blocks, sample ranges and bands: the fixed binary summation tree of every pixel.
//
// A block is 8 consecutive, aligned samples of a pixel, added in order. A node is an aligned range
// of a power-of-two number of blocks, and its sum is the sum of its two halves. A total over N
// samples adds the sums of its maximal aligned nodes from left to right. The last block of a job
// may be truncated at the job's last sample. So any node can be rendered anywhere, and stopping,
// resuming and merging in any order give the same bits.

#include <cstdint>
#include <vector>

#include "absl/status/status.h"
#include "renderlib/render/settings.h"

namespace bandsaw {

inline constexpr std::uint64_t kBlockSamples = 8;

/// The samples [first, last) of a node. `first` is a multiple of 8. Counted in blocks (a truncated
/// last block counts as a whole one), the range is aligned and its length is a power of two.
struct SampleRange {
  std::uint64_t first = 0;
  std::uint64_t last = 0;

  std::uint64_t first_block() const { return first / kBlockSamples; }
  std::uint64_t blocks() const { return (last - first + kBlockSamples - 1) / kBlockSamples; }
  std::uint64_t samples() const { return last - first; }
  friend auto operator<=>(const SampleRange&, const SampleRange&) = default;
};

/// Returns true if the range is a node of the tree; false for empty ranges.
bool is_node(const SampleRange& range);

/// Returns the number of blocks of the longest node that begins at block number `block`, which MUST
/// be > 0.
constexpr std::uint64_t longest_at(std::uint64_t block) { return block & (~block + 1); }

/// Returns the maximal aligned nodes of samples [0, samples), from left to right.
std::vector<SampleRange> maximal_nodes(std::uint64_t samples);

/// The halves of a node of two or more blocks. Neither half is empty: if no sample were in the
/// right half, the range would have fewer blocks and be a smaller node.
struct Halves {
  SampleRange left;
  SampleRange right;
};
/// `node` MUST be a node of two or more blocks.
Halves split(const SampleRange& node);

/// Rows [first, last) of the whole image, counted from the top.
struct RowRange {
  std::uint32_t first = 0;
  std::uint32_t last = 0;
  std::uint32_t count() const { return last - first; }
  friend auto operator<=>(const RowRange&, const RowRange&) = default;
};

/// The unit of work that is sent to a worker.
struct Band {
  SampleRange samples;
  RowRange rows;
  friend auto operator<=>(const Band&, const Band&) = default;
};

/// Returns INVALID_ARGUMENT if the band is not part of an image with these settings.
absl::Status validate(const Band& band, const RenderSettings& settings);

/// Statistics of rendering.
struct Counters {
  std::uint64_t rays = 0;
  /// Number of samples that were NaN, infinite or negative. They are left out of the sums, and the
  /// mean of the other samples of their block replaces them. bad_x, bad_y and bad_sample locate the
  /// first bad sample in (row, x, sample) order.
  std::uint64_t bad_samples = 0;
  std::uint32_t bad_x = 0;
  std::uint32_t bad_y = 0;
  std::uint64_t bad_sample = 0;
  std::uint64_t negative_samples = 0;  ///< bad samples that are finite but negative
  /// Number of samples whose path was cut off at max_depth, so that its remaining light is missing.
  std::uint64_t truncated_paths = 0;
  /// Number of primitives that were removed because no ray can hit them
  /// (Scene::dropped_primitives). The same in all bands of a scene.
  std::uint64_t dropped_primitives = 0;
  /// The techniques that path tracing used besides light and BSDF sampling: a sum of flags,
  /// kPathGuiding to kIndirectMaps. The same in all bands of an image.
  std::uint32_t techniques = 0;
  static constexpr std::uint32_t kPathGuiding = 1;
  static constexpr std::uint32_t kPhotonMaps = 2;  ///< photon maps of caustics
  static constexpr std::uint32_t kPortals = 4;     ///< sampling of the background through openings
  static constexpr std::uint32_t kIndirectMaps = 8;  ///< photon maps of indirect light
  static constexpr std::uint32_t kAllTechniques = 15;
  /// Number of rays of the training of path guiding and of its pilots (short trials that decide
  /// whether guiding pays). The same in all bands of an image, so add() does not sum it.
  std::uint64_t training_rays = 0;

  /// Adds the counters of other samples of the same image.
  void add(const Counters& other);
  friend bool operator==(const Counters&, const Counters&) = default;
};

/// The pixels of a band: for each pixel, row by row, the sums of its samples' r, g, b.
struct BandPixels {
  Band band;
  std::uint32_t width = 0;
  std::vector<double> sums;  ///< rows x width x 3
  Counters counters;
};

}  // namespace bandsaw
