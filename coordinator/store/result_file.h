#pragma once

// A finished image, or its pixels' numbers of samples, on disk: a header, then linear RGB float32,
// rows from the top. The form is in this folder's README.

#include <string>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "proto/wire/digest.h"
#include "renderlib/image/display.h"
#include "renderlib/image/image.h"

namespace bandsaw::coordinator {

/// Which of a job's pictures: its image, or how many samples each pixel has.
enum class FinishedPart { kImage, kSamples };

/// A finished image as it is kept: linear RGB float.
struct StoredResult {
  Image image;
  wire::Digest digest;   ///< of the pixels' bytes
  Display display = {};  ///< as the scene wants it shown; not in the file
};

/// Whole or not at all: OK means on disk in `folder` as `path`.
absl::Status write_result(const Image& image, const std::string& folder, const std::string& path);

/// NOT_FOUND: no such file. DATA_LOSS: damaged, saying how.
absl::StatusOr<StoredResult> read_result(const std::string& path);

}  // namespace bandsaw::coordinator
