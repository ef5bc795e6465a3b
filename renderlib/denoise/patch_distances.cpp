// A centre is a pixel at which the regression fits a function to the pixels of a window around it
// (fit.h). A patch is the square of pixels around a pixel. For each centre of a tile and each pixel
// of the centre's window, this file computes how much the patches around the two differ in one half
// of the samples (fit_parts.h). Differences of pixels are computed once for each offset (dx, dy)
// within the window, and then summed up over patches. Even and odd columns are stored apart,
// because centres are two pixels apart.

#include "renderlib/denoise/fit_parts.h"

namespace bandsaw {

PatchDistances::PatchDistances(const FitInput& input, std::size_t half)
    : input_(input), half_(half), all_(kFitSide * kFitSide * kTileRows * kTileColumns) {}

void PatchDistances::compute(int x, int y) {
  for (int dy = -kFitRadius; dy <= kFitRadius; ++dy) {
    for (int dx = -kFitRadius; dx <= kFitRadius; ++dx) {
      const int offset = (dy + kFitRadius) * kFitSide + dx + kFitRadius;
      compare(x, y, dx, dy);
      sum_patches(&all_[static_cast<std::size_t>(offset) * kTileRows * kTileColumns]);
    }
  }
}

/// Compares the pixels of the tile, and those up to a patch's radius around it, with the pixels at
/// the offset (dx, dy) from them. The distance of two pixels is their squared difference minus its
/// expectation for equal pixels, which is the sum of their variances, divided by this sum
/// (Rousselle et al. 2012, "Adaptive Rendering with Non-Local Means Filtering", section 4).
void PatchDistances::compare(int x, int y, int dx, int dy) {
  const auto& color = input_.halves[half_];
  const SplitPlane& variance = input_.variance[half_];
  const Float8 most(32.0f);  // limits each pixel, so that no pixel decides for a whole patch
  const int first = x / 2 - kBefore;
  for (int row = 0; row < kRows; ++row) {
    const int from = y + row - kFitPatch;
    for (int parity = 0; parity < 2; ++parity) {
      const int other = (parity + dx) & 1;
      const int shifted = first + ((parity + dx) >> 1);
      for (int i = 0; i < kColumns; i += kFitLanes) {
        Float8 squares(0.0f);
        for (const SplitPlane& channel : color) {
          const Float8 difference = Float8::load(channel.row(parity, from) + first + i) -
                                    Float8::load(channel.row(other, from + dy) + shifted + i);
          squares = squares + difference * difference;
        }
        const Float8 noise = Float8::load(variance.row(parity, from) + first + i) +
                             Float8::load(variance.row(other, from + dy) + shifted + i);
        min((squares - noise) / noise, most).store(&differences_[parity][row][i]);
      }
    }
  }
}

void PatchDistances::sum_patches(float* to) const {
  constexpr int kPatchSide = 2 * kFitPatch + 1;
  const Float8 scale(1.0f / (kPatchSide * kPatchSide));
  for (int row = 0; row < kTileRows; ++row) {
    float sums[2][kColumns];
    for (int parity = 0; parity < 2; ++parity) {
      for (int i = 0; i < kColumns; i += kFitLanes) {
        Float8 sum = Float8::load(&differences_[parity][2 * row][i]);
        for (int k = 1; k < kPatchSide; ++k) {
          sum = sum + Float8::load(&differences_[parity][2 * row + k][i]);
        }
        sum.store(&sums[parity][i]);
      }
    }
    for (int i = 0; i < kTileColumns; i += kFitLanes) {
      // Around an even column, a patch has three even and four odd columns.
      const float* const even = &sums[0][i + kBefore];
      const float* const odd = &sums[1][i + kBefore];
      const Float8 evens = (Float8::load(even - 1) + Float8::load(even)) + Float8::load(even + 1);
      const Float8 odds = (Float8::load(odd - 2) + Float8::load(odd - 1)) +
                          (Float8::load(odd) + Float8::load(odd + 1));
      ((evens + odds) * scale).store(to + row * kTileColumns + i);
    }
  }
}

}  // namespace bandsaw
