#pragma once

// What a job leaves when it is done.

#include <optional>
#include <vector>

#include "coordinator/store/credits_file.h"
#include "renderlib/image/image.h"

namespace bandsaw::coordinator {

struct Finished {
  Image image;
  /// How many samples each pixel has, in all channels; of an adaptive job alone, as in all others
  /// all have as many.
  std::optional<Image> samples;
  std::vector<RowsBy> credits;  ///< who rendered which rows
};

}  // namespace bandsaw::coordinator
