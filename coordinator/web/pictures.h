#pragma once

// Pictures of jobs for a browser: previews and finished images.

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <tuple>

#include "absl/status/statusor.h"
#include "coordinator/engine/engine.h"
#include "renderlib/base/mutex.h"
#include "renderlib/image/write_image.h"

namespace bandsaw::coordinator {

/// Formats the report of a finished job. `bandsaw serve` passes this function in, because the
/// format is defined among the commands.
using MakeReport = std::function<std::string(const JobView& job, const Image& image)>;

/// Thread-safe. Only one picture is made at a time, for all clients together, so that browsers
/// cannot take the machine's CPU from the farm. The functions that return a file fail with
/// RESOURCE_EXHAUSTED if images that are viewed or downloaded at the same time leave too little
/// memory.
class Pictures {
 public:
  using Bytes = std::shared_ptr<const std::string>;

  explicit Pictures(Engine& engine) : engine_(engine) {}

  /// Returns a file of the job's present image, which is at most a second old, or of the finished
  /// image if the job is done. The image has at most `most_side` pixels per side. NOT_FOUND: there
  /// is no such job, or no band (range of rows) of the job is stored.
  absl::StatusOr<Bytes> preview(JobId job, std::uint32_t most_side, ImageFormat format)
      EXCLUDES(making_);
  /// Returns the finished image. FAILED_PRECONDITION: the job is not done. NOT_FOUND: there is no
  /// such job, or its result has no image. DATA_LOSS: the stored image is missing or damaged.
  absl::StatusOr<Bytes> image(JobId job, ImageFormat format) EXCLUDES(making_);
  /// Returns the report of the finished image. Its errors are those of image().
  absl::StatusOr<Bytes> report(JobId job, const MakeReport& make) EXCLUDES(making_);

 private:
  using Key = std::tuple<JobId, std::uint32_t, ImageFormat>;  ///< job, most_side, format
  struct Made {
    Bytes file;
    std::uint64_t samples = 0;  ///< samples of the job when the file was made
    bool whole = false;         ///< true: the finished image
    double at = 0;              ///< time when the file was made, in seconds of a steady clock
    std::uint64_t used = 0;     ///< number of the last call that used the file
  };
  /// Keeps a picture, and drops the least recently used ones beyond a limit of bytes.
  void keep(const Key& key, Made made) REQUIRES(making_);

  Engine& engine_;
  Mutex making_;
  std::map<Key, Made> made_ GUARDED_BY(making_);
  std::size_t bytes_ GUARDED_BY(making_) = 0;  ///< size of all kept pictures
  std::uint64_t calls_ GUARDED_BY(making_) = 0;
};

}  // namespace bandsaw::coordinator
