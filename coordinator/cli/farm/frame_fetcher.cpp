// update() asks for the frames that changed, fetches those that are done, and adds each to the
// files, the contact sheet and the video. Frames may be done in any order, but a video needs them
// in ascending order.

#include "coordinator/cli/farm/frame_fetcher.h"

#include <algorithm>
#include <utility>

#include "absl/strings/str_cat.h"
#include "coordinator/cli/base/text.h"
#include "coordinator/cli/farm/call_with_retries.h"
#include "coordinator/cli/farm/clean_job.h"
#include "coordinator/cli/image/report_file.h"
#include "coordinator/cli/options/output_names.h"
#include "renderlib/base/status_macros.h"
#include "renderlib/image/write_image.h"

namespace bandsaw::coordinator {

FrameFetcher::FrameFetcher(const FarmClient& client, const WatchOptions& wanted,
                           ProgressDisplay& display, const Console& console)
    : client_(client.another()),
      sequence_(wanted.job),
      wanted_(wanted),
      display_(display),
      silent_(console, {.quiet = true}) {
  if (!wanted.after.video.empty()) {
    video_.emplace(wanted.after.video, wanted.after.video_fps);
  }
}

bool FrameFetcher::needs_images() const {
  return !wanted_.outputs.empty() || video_ || !wanted_.after.contact_sheet.empty();
}

absl::Status FrameFetcher::update() {
  RETURN_IF_ERROR(take_changes());
  while (!not_fetched_.empty()) {
    if (wanted_.denoise != Denoiser::kNone) {
      RETURN_IF_ERROR(start_guides_of_new_frames());
    }
    const auto [number, job] = *not_fetched_.begin();
    RETURN_IF_ERROR(fetch(number, job));
    not_fetched_.erase(number);
  }
  return absl::OkStatus();
}

/// Submits the jobs of the guides (images that the denoiser needs) of all frames that are done, so
/// that the farm renders them while this machine filters. Asks for changes first, because filtering
/// takes long and further frames may be done since the last request.
absl::Status FrameFetcher::start_guides_of_new_frames() {
  RETURN_IF_ERROR(take_changes());
  for (const auto& [number, job] : not_fetched_) {
    if (!guided_.contains(job)) {
      ASSIGN_OR_RETURN(const Progress progress, client_->job(job));
      RETURN_IF_ERROR(start_guides(*client_, progress));
      guided_.insert(job);
    }
  }
  return absl::OkStatus();
}

absl::Status FrameFetcher::take_changes() {
  ASSIGN_OR_RETURN(FarmClient::Frames changed, client_->frames(sequence_, after_));
  // After a restart of the coordinator, after_ has no meaning. So all frames are requested.
  if (changed.epoch != epoch_) {
    if (after_ > 0) {
      ASSIGN_OR_RETURN(changed, client_->frames(sequence_, 0));
    }
    epoch_ = changed.epoch;
    after_ = 0;
    numbers_.clear();
    for (const FrameView& frame : changed.frames) {
      numbers_.push_back(frame.number);
    }
  }
  for (const FrameView& frame : changed.frames) {
    after_ = std::max(after_, frame.changed);
    if (frame.state == FrameState::kDone) {
      // A frame that was rendered again has another job, and is fetched again.
      JobId& job = done_[frame.number];
      if (std::exchange(job, frame.job) != frame.job && needs_images()) {
        not_fetched_[frame.number] = frame.job;
      }
    } else if (!frame.reason.empty()) {
      report_failure(frame);
    }
  }
  return absl::OkStatus();
}

/// Reports each failure of a frame once.
void FrameFetcher::report_failure(const FrameView& frame) {
  const bool gave_up = frame.state == FrameState::kFailed;
  const std::string what = absl::StrCat(
      gave_up ? " failed: " : " is tried again, because it failed: ", printable(frame.reason));
  if (reported_.emplace(frame.number, what).second) {
    display_.note(absl::StrCat("frame ", frame.number, what));
  }
}

absl::Status FrameFetcher::fetch(FrameNumber number, JobId job) {
  ASSIGN_OR_RETURN(const JobPictures pictures, pictures_of(number, job));
  if (!wanted_.outputs.empty()) {
    RETURN_IF_ERROR(write(number, pictures));
  }
  return add_to_collections(number, pictures);
}

absl::StatusOr<JobPictures> FrameFetcher::pictures_of(FrameNumber number, JobId job) {
  const auto of_frame = [number](const absl::Status& status) {
    return absl::Status(status.code(), absl::StrCat("frame ", number, ": ", status.message()));
  };
  absl::StatusOr<FarmImage> image = client_->result(job);
  if (!image.ok()) {
    return of_frame(image.status());
  }
  ASSIGN_OR_RETURN(Progress progress, client_->job(job));
  JobPictures pictures{std::move(progress), *std::move(image), {}, std::nullopt};
  if (wanted_.denoise != Denoiser::kNone) {
    absl::StatusOr<Denoised> clean =
        clean_job(*client_, pictures.job, pictures.result.image, wanted_.denoise, silent_);
    if (!clean.ok()) {
      return of_frame(clean.status());
    }
    pictures.clean = *std::move(clean);
  }
  return pictures;
}

absl::Status FrameFetcher::write(FrameNumber number, const JobPictures& pictures) {
  std::vector<std::string> outputs;
  for (const std::string& output : wanted_.outputs) {
    outputs.push_back(name_of_frame(output, number));
  }
  const ReportOption named{name_of_frame(wanted_.report.file, number)};
  ASSIGN_OR_RETURN(const std::vector<std::string> reports, report_files(named, outputs));
  RETURN_IF_ERROR(
      write_pictures(pictures, {outputs, reports, wanted_.display, "", wanted_.denoise}));
  display_.frame_written(sequence_, number, outputs, reports);
  files_.insert(files_.end(), outputs.begin(), outputs.end());
  files_.insert(files_.end(), reports.begin(), reports.end());
  return absl::OkStatus();
}

absl::Status FrameFetcher::add_to_collections(FrameNumber number, const JobPictures& pictures) {
  const Image& image = pictures.best();
  const Display display = wanted_.display.over(pictures.result.display);
  if (!wanted_.after.contact_sheet.empty()) {
    if (!sheet_) {
      sheet_.emplace(numbers_, image.width, image.height);
    }
    sheet_->add(number, image, display);
  }
  if (video_ && in_video_ < numbers_.size() && numbers_[in_video_] == number) {
    RETURN_IF_ERROR(video_->add(image, display));
    ++in_video_;
  }
  return absl::OkStatus();
}

absl::Status FrameFetcher::fetch_rest() {
  const absl::Status status = call_with_retries(*client_, [this] { return update(); });
  return client_->stopped() ? absl::CancelledError("interrupted") : status;
}

/// Adds the frames that the video does not have yet, and ends the video. While a frame was missing,
/// frames with larger numbers could not be added, because a video needs its frames in order. So
/// they are fetched and cleaned a second time here.
absl::Status FrameFetcher::feed_video() {
  while (in_video_ < numbers_.size()) {
    const FrameNumber number = numbers_[in_video_];
    const absl::StatusOr<JobPictures> pictures =
        call_with_retries(*client_, [&] { return pictures_of(number, done_.at(number)); });
    if (client_->stopped()) {
      return absl::CancelledError("interrupted");
    }
    RETURN_IF_ERROR(pictures.status());
    RETURN_IF_ERROR(video_->add(pictures->best(), wanted_.display.over(pictures->result.display)));
    ++in_video_;
  }
  return video_->finish();
}

absl::Status FrameFetcher::make_collections() {
  if (sheet_) {
    const std::string& path = wanted_.after.contact_sheet;
    RETURN_IF_ERROR(write_image(sheet_->picture(), path));
    files_.push_back(path);
  }
  if (video_ && done_.size() < numbers_.size()) {
    display_.note(absl::StrCat(wanted_.after.video, " is not made: ",
                               numbers_.size() - done_.size(), " frames are missing"));
  } else if (video_) {
    RETURN_IF_ERROR(feed_video());
    files_.push_back(wanted_.after.video);
  }
  return absl::OkStatus();
}

}  // namespace bandsaw::coordinator
