#pragma once

// From images to the planes that are fitted.

#include "renderlib/denoise/denoise.h"
#include "renderlib/denoise/maps.h"

namespace bandsaw {

/// Returns the planes. In each half, a pixel that is brighter than all pixels up to two away in the
/// other half is scaled down to the brightest of them: a single bright path, which a filter would
/// spread over the pixels around.
FitInput prepare_fit(const DenoiseInput& input, Pool& pool);

/// Returns the value of the second part of a pixel's samples, for one channel.
inline float second_value(float mean, float first, float first_share) {
  return (mean - first_share * first) / (1 - first_share);
}

}  // namespace bandsaw
