#pragma once

// Internal to fit(): the sizes of windows and tiles, distances between patches, and least squares.
// A centre is a pixel at which a function is fitted, one of every two by two pixels (fit.h). A
// patch is the square around a pixel by which pixels are compared. The samples are divided into two
// parts, and a half is the image of one part. Even and odd columns of pixels are stored apart
// (split_plane.h): parity 0 means the even columns, and parity 1 the odd columns.

#include <cstddef>
#include <vector>

#include "renderlib/base/simd.h"
#include "renderlib/denoise/fit.h"

namespace bandsaw {

inline constexpr int kFitLanes = 8;   ///< centres that are processed together
inline constexpr int kFitRadius = 7;  ///< radius of a window, pixels
inline constexpr int kFitSide = 2 * kFitRadius + 1;
inline constexpr int kFitPatch = 3;      ///< radius of a patch, pixels
inline constexpr int kTileColumns = 32;  ///< centres in a row of a tile
inline constexpr int kTileRows = 8;      ///< rows of centres in a tile

/// Returns (1 - x / 4)^4, about exp(-x), for x in [0, 4]; 1 for smaller x and 0 for larger x.
inline Float8 falling(const Float8& x) {
  const Float8 one(1.0f);
  const Float8 y = max(min(one - x * Float8(0.25f), one), Float8(0.0f));
  const Float8 square = y * y;
  return square * square;
}

/// Distances, in one half of the samples, between the patches of a tile's centres and the patches
/// of the pixels of their windows.
class PatchDistances {
 public:
  /// `input` MUST outlive this object. `half` is 0 or 1.
  PatchDistances(const FitInput& input, std::size_t half);

  /// Computes the distances of the tile whose first centre is pixel (x, y); both are even.
  void compute(int x, int y);
  /// Returns the distances for eight adjacent centres of the tile. The first of these centres is at
  /// `column` of `row`. The distance compares the patch around a centre with the patch around the
  /// pixel at (dx, dy) from this centre. It is the mean over the patch of (d^2 - v) / v, where d is
  /// the difference of two pixels and v the variance of d. It is 0 on average for patches of the
  /// same radiance.
  const float* to(int dx, int dy, int row, int column) const {
    const int offset = (dy + kFitRadius) * kFitSide + dx + kFitRadius;
    return &all_[static_cast<std::size_t>((offset * kTileRows + row) * kTileColumns + column)];
  }

 private:
  static constexpr int kRows = 2 * kTileRows + 2 * kFitPatch;  ///< rows of pixels
  static constexpr int kBefore = 2;  ///< columns of each parity before the tile's first
  static constexpr int kColumns = kTileColumns + kFitLanes;  ///< columns of each parity

  /// Sets differences_ for one offset (dx, dy) in the tile whose first centre is pixel (x, y).
  void compare(int x, int y, int dx, int dy);
  /// Writes the distances of the patches of all centres of the tile for one offset.
  void sum_patches(float* to) const;

  const FitInput& input_;
  std::size_t half_;
  std::vector<float> all_;                 ///< the distances, in the order of to()
  float differences_[2][kRows][kColumns];  ///< differences of pixels, by parity of column
};

inline constexpr std::size_t kTerms = 3 + kGuides;  ///< 1, x, y, guides

/// Normal equations of eight centres, in one half of the samples.
struct NormalEquations {
  NormalEquations();
  /// Adds one pixel of the window of each of the eight centres.
  void add(const Float8& weight, const Float8 (&terms)[kTerms], const Float8 (&value)[3]);
  /// Adds a small multiple of the sum of the weights to the diagonal, except for the first term, so
  /// that the equations can be solved.
  void add_ridge();
  /// Replaces `values` by the coefficients, for each term and channel.
  void solve();

  Float8 products[kTerms * (kTerms + 1) / 2];  ///< upper triangle, row by row
  Float8 values[kTerms][3];
};

}  // namespace bandsaw
