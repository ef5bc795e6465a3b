#pragma once

// Pictures of jobs for a browser: previews that sharpen, and whole images.

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <utility>

#include "absl/status/statusor.h"
#include "coordinator/engine/engine.h"
#include "renderlib/base/mutex.h"
#include "renderlib/image/write_image.h"

namespace bandsaw::coordinator {

/// The text of a finished job's report; how is given from outside, because its words are the
/// command's.
using TellReport = std::function<std::string(const JobView& job, const Image& image)>;

/// Thread-safe. One picture is made at a time, whoever asks, so that browsers cannot take the
/// machine from the farm.
class Pictures {
 public:
  using Bytes = std::shared_ptr<const std::string>;

  explicit Pictures(Engine& engine) : engine_(engine) {}

  /// A PNG of at most about `most_side` pixels a side of what is there of the job: of at most a
  /// second ago, or of the finished image. NOT_FOUND: no such job, or nothing of it is there. Here
  /// and below, RESOURCE_EXHAUSTED: as of picture_of (coordinator/rpc/picture.h).
  absl::StatusOr<Bytes> preview(JobId job, std::uint32_t most_side) EXCLUDES(making_);
  /// The finished image. Errors as Engine::result.
  absl::StatusOr<Bytes> image(JobId job, ImageFormat format) EXCLUDES(making_);
  /// What is said of it: `tell`'s text. Errors as Engine::result.
  absl::StatusOr<Bytes> report(JobId job, const TellReport& tell) EXCLUDES(making_);

 private:
  using Key = std::pair<JobId, std::uint32_t>;  ///< job, most_side
  struct Made {
    Bytes png;
    std::uint64_t samples = 0;  ///< of the job when it was made
    bool whole = false;         ///< of the finished image
    double at = 0;              ///< when, in seconds of a steady clock
    std::uint64_t used = 0;     ///< counts calls
  };
  void keep(const Key& key, Made made) REQUIRES(making_);

  Engine& engine_;
  Mutex making_;
  std::map<Key, Made> made_ GUARDED_BY(making_);
  std::size_t bytes_ GUARDED_BY(making_) = 0;  ///< of all that are made
  std::uint64_t calls_ GUARDED_BY(making_) = 0;
};

}  // namespace bandsaw::coordinator
