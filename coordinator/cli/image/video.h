#pragma once

// Makes a video of frames by ffmpeg, a child process.

#include <optional>
#include <string>

#include "absl/status/statusor.h"
#include "coordinator/cli/base/piped_child.h"
#include "renderlib/image/display.h"
#include "renderlib/image/image.h"

namespace bandsaw::coordinator {

class Video {
 public:
  /// FAILED_PRECONDITION: ffmpeg is not installed. Other errors: the file cannot be written.
  static absl::Status check(const std::string& path);

  /// `path`: a file whose name ends in .mp4, .mov, .mkv or .webm. REQUIRES: check was OK.
  Video(std::string path, double frames_per_second)
      : path_(std::move(path)), frames_per_second_(frames_per_second) {}
  /// Removes the file unless `finish` was called.
  ~Video();
  Video(const Video&) = delete;
  Video& operator=(const Video&) = delete;

  /// Appends a frame, as an 8-bit file shows it. The first one starts ffmpeg. All MUST have the
  /// same size. ABORTED: ffmpeg failed.
  absl::Status add(const Image& image, const Display& display);
  /// Ends the video and gives it its name.
  absl::Status finish();

 private:
  absl::Status start();
  absl::Status failed(const absl::Status& status) const;

  std::string path_;
  std::string part_;  ///< name until it is complete
  double frames_per_second_;
  std::optional<PipedChild> ffmpeg_;
};

}  // namespace bandsaw::coordinator
