#pragma once

// First-order regression of an image's two halves on its guides (albedo, normal and depth), with
// weights from the opposite half (Bitterli et al. 2016, "Nonlinearly Weighted First-order
// Regression for Denoising Monte Carlo Renderings", section 4). The samples of each pixel are
// divided into two independent parts. A half is a whole image: the means of one of these parts.
//
// For every second pixel of every second row (a centre) and each half, a linear function of the
// position and the guides is fitted to the pixels of a window, by weighted least squares. A patch
// is the square of pixels around a pixel. The weight of a pixel falls with the distance between the
// pixel's patch and the centre's patch, which are compared in the other half (Rousselle et al.
// 2012, "Adaptive Rendering with Non-Local Means Filtering", section 4). It also falls with the
// difference between the guides of the pixel and of the centre. A pixel's value is the weighted
// mean of the functions of the centres around it.

#include <array>
#include <cstddef>
#include <vector>

#include "renderlib/base/pool.h"
#include "renderlib/denoise/split_plane.h"

namespace bandsaw {

inline constexpr std::size_t kGuides = 6;       ///< albedo r, g, b; normal x, y; depth
inline constexpr std::size_t kFirstNormal = 3;  ///< index of the first guide of the normal
inline constexpr std::size_t kDepthGuide = 5;   ///< index of the depth

/// Rows [first, last).
struct RowSpan {
  int first = 0;
  int last = 0;
  int count() const { return last - first; }
};

/// The input of fit(): rows of an image. Only some of the rows are wanted as result. In the margin
/// around the input (split_plane.h), all planes except `valid` hold mirrored pixels. Rows up to
/// kFitReach from the wanted ones MUST be those of the image, or mirrored at its edges.
struct FitInput {
  int width = 0;
  int height = 0;
  RowSpan wanted;
  /// Radiance of the two halves, by channel, in [0, 1e15].
  std::array<std::array<SplitPlane, 3>, 2> halves;
  std::array<SplitPlane, 2> variance;      ///< variance of a half: sum over channels, > 0
  std::array<SplitPlane, kGuides> guides;  ///< each in [0, 1]
  SplitPlane valid;  ///< 1 for pixels whose values may be used, otherwise 0; 0 in the margin
};

/// Settings of one filter. A pixel has little weight if one of its differences from the centre is
/// larger than the reach of this difference. At edges, the reaches of normal and depth are larger:
/// at least the range of the guide in the 3 x 3 pixels around the centre.
struct FitSettings {
  float color_reach = 1;      ///< difference of patches, in standard deviations
  float albedo_reach = 2;     ///< difference of the albedo
  float normal_reach = 0.3f;  ///< difference of the normal's components
  float depth_reach = 0.1f;   ///< difference of the depth, relative to the centre's
};

/// The filters that are computed at the same time, because they compare the same patches.
inline constexpr std::size_t kFilters = 2;
using FilterSettings = std::array<FitSettings, kFilters>;

/// A filtered value depends on rows up to this distance away. The sum is the largest distance of a
/// centre from the pixel, plus the radius of a window, plus the radius of a patch.
inline constexpr int kFitReach = 2 + 7 + 3;

/// The two halves of a filtered image: values of the wanted rows for each channel.
struct FitOutput {
  std::array<std::array<std::vector<float>, 3>, 2> halves;
};
using FitOutputs = std::array<FitOutput, kFilters>;

/// Returns the filtered halves of each filter. A filtered half depends linearly on the same half of
/// the input; the other half of the input determines the weights. Values are >= 0. The result has
/// the same bits for any number of threads and for all kernels. It does not depend on rows beyond
/// kFitReach from the wanted ones. The first row of `input` MUST be an even row of the image.
FitOutputs fit(const FitInput& input, const FilterSettings& settings, Pool& pool);

/// A kernel's fit() (renderlib/README.md, "Kernels").
using FitFunction = FitOutputs (*)(const FitInput& input, const FilterSettings& settings,
                                   Pool& pool);

}  // namespace bandsaw
