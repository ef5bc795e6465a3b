#pragma once

// A plane of floats whose even and odd columns are stored apart. The filter (fit.cpp) processes
// every second pixel. In this order eight such pixels are adjacent in memory and load as one
// vector.

#include <cstddef>

#include "renderlib/base/huge_vector.h"

namespace bandsaw {

class SplitPlane {
 public:
  /// Number of pixels that can be read on each side of the image. At the right and at the bottom,
  /// another kBeyond pixels can be read, because tiles may reach beyond the image.
  static constexpr int kMargin = 24;
  static constexpr int kBeyond = 64;

  SplitPlane() = default;
  /// All pixels are zero.
  SplitPlane(int width, int height)
      : stride_((width + 1) / 2 + kMargin + kBeyond / 2 + 8),
        rows_(height + 2 * kMargin + kBeyond),
        data_(2 * static_cast<std::size_t>(stride_) * static_cast<std::size_t>(rows_), 0.0f) {}

  /// Returns a pointer to the even (`parity` 0) or odd (1) pixels of row y: element i is pixel
  /// (2 i + parity, y). i may be negative, within the margin.
  const float* row(int parity, int y) const { return data_.data() + start(parity, y); }
  float* row(int parity, int y) { return data_.data() + start(parity, y); }
  float& at(int x, int y) { return row(x & 1, y)[x >> 1]; }
  float at(int x, int y) const { return row(x & 1, y)[x >> 1]; }

 private:
  std::ptrdiff_t start(int parity, int y) const {
    return (std::ptrdiff_t{y + kMargin} * 2 + parity) * stride_ + kMargin / 2;
  }
  std::ptrdiff_t stride_ = 0;
  std::ptrdiff_t rows_ = 0;
  HugeVector<float> data_;
};

}  // namespace bandsaw
