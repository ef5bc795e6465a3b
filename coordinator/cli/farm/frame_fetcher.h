#pragma once

// Fetches the images of the frames of a sequence (a job of many frames) as they are done, removes
// their noise if wanted, and writes their files. watch_frames() uses it.

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "coordinator/cli/farm/farm_client.h"
#include "coordinator/cli/farm/watch_job.h"
#include "coordinator/cli/image/contact_sheet.h"
#include "coordinator/cli/image/video.h"
#include "coordinator/cli/options/options.h"
#include "coordinator/cli/progress/progress_display.h"

namespace bandsaw::coordinator {

/// Uses a client of its own on the connection of `client`. The other arguments of the constructor
/// MUST outlive the object.
class FrameFetcher {
 public:
  /// `wanted`: the sequence, and what is made of its frames.
  FrameFetcher(const FarmClient& client, const WatchOptions& wanted, ProgressDisplay& display,
               const Console& console);

  /// Reports frames that failed. If files are made of the images, fetches the frames that were done
  /// since the last call. UNAVAILABLE: the farm cannot be reached; the next call fetches what is
  /// left. Other errors: a file could not be written, or an image could not be fetched or cleaned.
  absl::Status update();
  /// Fetches all frames that are done and not yet fetched. If the farm cannot be reached, waits for
  /// it up to a minute. CANCELLED: stop() was called. Other errors as update().
  absl::Status fetch_rest();
  /// Writes the contact sheet (one picture that shows all frames) and, if all frames are done, the
  /// video. Call it last. If the farm cannot be reached, waits for it as fetch_rest() does.
  /// CANCELLED: stop() was called. Other errors as update().
  absl::Status make_collections();
  /// Cancels the calls to the farm. Thread-safe.
  void stop() { client_->stop(); }

  /// Returns the names of all files that were written.
  const std::vector<std::string>& files() const { return files_; }

 private:
  /// Asks the farm which frames have changed, and updates done_ and not_fetched_.
  absl::Status take_changes();
  void report_failure(const FrameView& frame);
  /// Submits the jobs of the guides (images that the denoiser needs) of frames that are done.
  absl::Status start_guides_of_new_frames();
  /// Fetches the image of a frame, writes its files and calls add_to_collections(). `job`: the job
  /// that rendered the frame.
  absl::Status fetch(FrameNumber number, JobId job);
  /// Fetches the image of a frame, which `job` has rendered, and removes its noise if wanted.
  absl::StatusOr<JobPictures> pictures_of(FrameNumber number, JobId job);
  /// Writes the image files and the reports of a frame.
  absl::Status write(FrameNumber number, const JobPictures& pictures);
  /// Adds the frame to the contact sheet, and to the video if it is the video's next frame.
  absl::Status add_to_collections(FrameNumber number, const JobPictures& pictures);
  /// Adds the frames that the video does not have yet, and ends the video.
  absl::Status feed_video();
  /// Returns true if any file is made of the images.
  bool needs_images() const;

  const std::unique_ptr<FarmClient> client_;
  const JobId sequence_;
  const WatchOptions& wanted_;
  ProgressDisplay& display_;
  ProgressDisplay silent_;             ///< for the jobs of guides: prints nothing
  std::string epoch_;                  ///< run of the coordinator that after_ belongs to
  std::uint64_t after_ = 0;            ///< largest FrameView::changed so far; 0: no frame is known
  std::vector<FrameNumber> numbers_;   ///< numbers of all frames of the sequence
  std::map<FrameNumber, JobId> done_;  ///< the jobs of the frames that are done
  std::map<FrameNumber, JobId> not_fetched_;  ///< frames in `done_` whose files are not written yet
  std::set<JobId> guided_;  ///< jobs of frames for which the denoiser's guides are submitted
  std::set<std::pair<FrameNumber, std::string>> reported_;  ///< failures that were printed
  std::vector<std::string> files_;
  std::optional<ContactSheet> sheet_;
  std::optional<Video> video_;
  std::size_t in_video_ = 0;  ///< number of frames, from the first one, that the video has
};

}  // namespace bandsaw::coordinator
