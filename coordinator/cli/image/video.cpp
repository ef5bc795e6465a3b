// Starts ffmpeg at the first frame, and writes each frame as a PPM picture (8-bit RGB) to ffmpeg's
// standard input. The video has a temporary name until it is complete.

#include "coordinator/cli/image/video.h"

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <utility>
#include <vector>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/strings/str_split.h"
#include "renderlib/base/atomic_file.h"
#include "renderlib/base/status_macros.h"
#include "renderlib/image/write_image.h"

namespace bandsaw::coordinator {
namespace {

namespace fs = std::filesystem;

/// Returns true if a program of this name is on PATH.
bool is_installed(const std::string& name) {
  const char* path = std::getenv("PATH");
  const std::vector<std::string> folders =
      absl::StrSplit(path == nullptr ? "/usr/bin:/bin" : path, ':');
  for (const std::string& folder : folders) {
    std::error_code error;
    if (fs::is_regular_file(fs::path(folder) / name, error)) {
      return true;
    }
  }
  return false;
}

/// Returns the options of the encoder: VP9 for .webm, otherwise H.264. The quality (-crf) is nearly
/// lossless. Browsers play both formats.
std::vector<std::string> encoder_for(const std::string& path) {
  return absl::EndsWithIgnoreCase(path, ".webm")
             ? std::vector<std::string>{"-c:v", "libvpx-vp9", "-crf", "20", "-b:v", "0"}
             : std::vector<std::string>{"-c:v", "libx264", "-crf", "16"};
}

}  // namespace

absl::Status Video::check(const std::string& path) {
  RETURN_IF_ERROR(check_can_be_written(path));
  if (!is_installed("ffmpeg")) {
    return absl::FailedPreconditionError(
        "--video needs the program ffmpeg, which is not on PATH; install it, as with: apt-get "
        "install ffmpeg");
  }
  return absl::OkStatus();
}

Video::~Video() {
  ffmpeg_.reset();
  if (!part_.empty()) {
    std::remove(part_.c_str());
  }
}

absl::Status Video::start() {
  const fs::path path(path_);
  part_ = (path.parent_path() /
           absl::StrCat(".", path.stem().string(), ".part", path.extension().string()))
              .string();
  std::vector<std::string> arguments = {"ffmpeg",
                                        "-nostdin",
                                        "-v",
                                        "error",
                                        "-y",
                                        "-f",
                                        "image2pipe",
                                        "-c:v",
                                        "ppm",
                                        "-framerate",
                                        absl::StrFormat("%.6g", frames_per_second_),
                                        "-i",
                                        "pipe:0"};
  for (std::string& option : encoder_for(path_)) {
    arguments.push_back(std::move(option));
  }
  // Players need yuv420p, which stores colours for two by two pixels, so both sides must be even.
  // ffmpeg converts colours by BT.601 unless it is told to use BT.709. Tags tell the player which
  // of the two was used; without tags, players assume BT.709 for large videos and BT.601 for small
  // ones.
  for (const char* option :
       {"-vf", "pad=ceil(iw/2)*2:ceil(ih/2)*2,scale=out_color_matrix=bt709:out_range=tv",
        "-pix_fmt", "yuv420p", "-colorspace", "bt709", "-color_primaries", "bt709", "-color_trc",
        "bt709", "-color_range", "tv"}) {
    arguments.emplace_back(option);
  }
  // Without "file:", ffmpeg would read "a:" at the beginning of a name as a protocol.
  arguments.push_back("file:" + part_);
  ASSIGN_OR_RETURN(PipedChild child, PipedChild::start(arguments));
  ffmpeg_.emplace(std::move(child));
  return absl::OkStatus();
}

absl::Status Video::failed(const absl::Status& status) const {
  return status.ok() ? status
                     : absl::Status(status.code(),
                                    absl::StrCat(path_, ": ffmpeg failed: ", status.message()));
}

absl::Status Video::add(const Image& image, const Display& display) {
  if (!ffmpeg_) {
    RETURN_IF_ERROR(failed(start()));
  }
  ASSIGN_OR_RETURN(const std::vector<std::byte> bytes,
                   encode_image(image, ImageFormat::kPpm, display));
  return failed(ffmpeg_->write(bytes));
}

absl::Status Video::finish() {
  if (!ffmpeg_) {
    return absl::FailedPreconditionError(absl::StrCat(path_, ": a video needs at least one frame"));
  }
  RETURN_IF_ERROR(failed(ffmpeg_->finish()));
  RETURN_IF_ERROR(name_file(part_, path_));
  part_.clear();
  return absl::OkStatus();
}

}  // namespace bandsaw::coordinator
