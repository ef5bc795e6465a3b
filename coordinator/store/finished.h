#pragma once

// The results of a finished job. The film's thread, which adds the bands of jobs (ranges of rows
// and samples, rendered by workers) to their images, hands the results to the store.

#include <optional>
#include <vector>

#include "coordinator/store/attribution_file.h"
#include "renderlib/image/image.h"

namespace bandsaw::coordinator {

struct Finished {
  Image image;
  /// Mean of the first part (about half) of each pixel's samples (Film::first_part), from which the
  /// denoiser estimates the noise of the image. Absent if some pixel has only one block of samples
  /// (8 samples), or if the integrator computes no radiance.
  std::optional<Image> first;
  /// Number of samples of each pixel, the same in all channels. Only for an adaptive job; in other
  /// jobs all pixels have the same number.
  std::optional<Image> samples;
  std::vector<RowsBy> attribution;  ///< which worker rendered which rows
};

}  // namespace bandsaw::coordinator
