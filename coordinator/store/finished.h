#pragma once

// The results of a finished job.

#include <optional>
#include <vector>

#include "coordinator/store/attribution_file.h"
#include "renderlib/image/image.h"

namespace bandsaw::coordinator {

struct Finished {
  Image image;
  /// Number of samples of each pixel, the same in all channels. Only for an adaptive job; in other
  /// jobs all pixels have the same number.
  std::optional<Image> samples;
  std::vector<RowsBy> attribution;  ///< which worker rendered which rows
};

}  // namespace bandsaw::coordinator
