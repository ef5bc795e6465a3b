#pragma once

// Makes a video of the frames of a sequence with ffmpeg, for --video of `submit` and `watch`.
// ffmpeg runs as a child process.

#include <optional>
#include <string>

#include "absl/status/statusor.h"
#include "coordinator/cli/base/piped_child.h"
#include "renderlib/image/display.h"
#include "renderlib/image/image.h"

namespace bandsaw::coordinator {

class Video {
 public:
  /// Checks that a video can be made. FAILED_PRECONDITION: ffmpeg is not installed. Other errors:
  /// the file cannot be written.
  static absl::Status check(const std::string& path);

  /// `path`: a file whose name ends in .mp4, .mov, .mkv or .webm. REQUIRES: check() was OK, and
  /// this process ignores SIGPIPE (outlive_reader() in cli/base/console.h), so that add() returns
  /// an error if ffmpeg has ended.
  Video(std::string path, double frames_per_second)
      : path_(std::move(path)), frames_per_second_(frames_per_second) {}
  /// If finish() was not called or failed, ends ffmpeg and removes the incomplete file.
  ~Video();
  Video(const Video&) = delete;
  Video& operator=(const Video&) = delete;

  /// Appends a frame, as bright as in an 8-bit image file: `display` is applied. The first frame
  /// starts ffmpeg. All frames MUST have the same size. ABORTED: ffmpeg failed.
  absl::Status add(const Image& image, const Display& display);
  /// Ends the video, syncs its temporary file and gives the file its final name, `path`.
  /// FAILED_PRECONDITION: there is no frame. ABORTED: ffmpeg failed. Other errors: those of
  /// name_file (renderlib/base/atomic_file.h).
  absl::Status finish();

 private:
  /// Starts ffmpeg.
  absl::Status start();
  /// Returns `status` with a message that names the file and ffmpeg.
  absl::Status failed(const absl::Status& status) const;

  std::string path_;
  std::string part_;  ///< name of the file while it is incomplete; empty: there is none
  double frames_per_second_;
  std::optional<PipedChild> ffmpeg_;
};

}  // namespace bandsaw::coordinator
