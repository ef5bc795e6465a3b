#pragma once

// Prepares images for fit() (fit.h): planes of their two halves (the means of two parts of the
// samples), of the variances and of the guides (albedo, normal and depth).

#include "renderlib/denoise/denoise.h"
#include "renderlib/denoise/maps.h"

namespace bandsaw {

/// Means over the whole image.
struct ImageMeans {
  float brightness = 0;  ///< mean of all channels of the pixels whose values are in [0, 1e15]
  float depth = 1;       ///< mean depth of the pixels that show a surface
};
ImageMeans means_of(const DenoiseInput& input);

/// A clean pixel depends on rows up to this distance away.
inline constexpr int kDenoiseReach = 24;

/// Returns the planes of `rows` of the image; `rows.first` is even. In each half, single bright
/// pixels are scaled down to the brightness that pixels up to two away have in the other half. Such
/// a pixel shows a single bright path, which a filter would spread over its neighbours. A pixel
/// that is bright in both halves and has no such neighbours stays as it was rendered. Up to 5 rows
/// at each end differ from those of the whole image, because they lack neighbours.
FitInput prepare_fit(const DenoiseInput& input, const ImageMeans& means, const RowSpan& rows,
                     Pool& pool);

/// Returns the value of the second part of a pixel's samples, for one channel.
inline float second_value(float mean, float first, float first_share) {
  return (mean - first_share * first) / (1 - first_share);
}

}  // namespace bandsaw
