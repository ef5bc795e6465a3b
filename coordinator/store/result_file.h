#pragma once

// Writes and reads the files of a job's result: the finished image, the mean of the first part of
// its samples, and the number of samples of each pixel. A file has a header, then linear RGB
// float32, rows from the top. The format is specified in this folder's README.

#include <string>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "proto/wire/digest.h"
#include "renderlib/image/display.h"
#include "renderlib/image/image.h"

namespace bandsaw::coordinator {

/// Selects a part of a job's result: its image, the mean of the first part of each pixel's samples
/// (Film::first_part), or the number of samples of each pixel.
enum class FinishedPart { kImage, kFirst, kSamples };

/// A part of a result, with pixels in linear RGB float as in the file.
struct StoredResult {
  Image image;
  wire::Digest digest;   ///< digest of the pixels' bytes
  Display display = {};  ///< the scene's display settings; not in the file
};

/// Writes the file `path` atomically. `folder`: the folder that contains it. OK: the file is on
/// disk.
absl::Status write_result(const Image& image, const std::string& folder, const std::string& path);

/// Reads the file. NOT_FOUND: no such file. DATA_LOSS: damaged, with the reason.
absl::StatusOr<StoredResult> read_result(const std::string& path);

}  // namespace bandsaw::coordinator
