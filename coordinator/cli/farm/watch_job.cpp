// The class Watch follows the job and displays its progress. Meanwhile a thread of the class
// FollowedImage shows the unfinished image. When the job is done, watch_job() fetches the image,
// removes its noise if requested, and writes it with its layers and reports.

#include "coordinator/cli/farm/watch_job.h"

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <memory>
#include <optional>
#include <utility>

#include "absl/strings/str_cat.h"
#include "coordinator/cli/base/text.h"
#include "coordinator/cli/base/ticker.h"
#include "coordinator/cli/farm/call_with_retries.h"
#include "coordinator/cli/farm/clean_job.h"
#include "coordinator/cli/farm/farm_client.h"
#include "coordinator/cli/farm/farm_errors.h"
#include "coordinator/cli/image/clean.h"
#include "coordinator/cli/image/output.h"
#include "coordinator/cli/image/report.h"
#include "coordinator/cli/image/report_file.h"
#include "coordinator/cli/progress/image_views.h"
#include "coordinator/engine/clock.h"
#include "coordinator/scheduler/api/job_spec.h"
#include "proto/link/join.h"
#include "renderlib/base/status_macros.h"

namespace bandsaw::coordinator {
namespace {

/// Until it is destroyed, periodically fetches the unfinished image of a job, over a client of its
/// own, and shows it in the terminal or a viewer. Does nothing if neither is requested.
class FollowedImage {
 public:
  FollowedImage(FarmClient& client, JobId job, ImageViews& views);
  ~FollowedImage();

 private:
  /// Fetches and shows the image if it is time.
  void look();

  ImageViews& views_;
  const JobId job_;
  const std::unique_ptr<FarmClient> client_;
  double next_ = 0;  ///< time of the next fetch, in seconds of a steady clock
  std::optional<Ticker> ticker_;
};

constexpr std::chrono::milliseconds kTick{100};  // interval between two calls of look()
constexpr double kInterval_s = 1;                // least time between two fetches
/// Fetching takes at most this share of the time, so large images are fetched less often.
constexpr double kMaxShare = 0.1;

FollowedImage::FollowedImage(FarmClient& client, JobId job, ImageViews& views)
    : views_(views), job_(job), client_(views.any() ? client.another() : nullptr) {
  if (client_ != nullptr) {
    ticker_.emplace(kTick, [this] { look(); });
  }
}

FollowedImage::~FollowedImage() {
  if (client_ != nullptr) {
    client_->stop();
  }
}

void FollowedImage::look() {
  const double begin = steady_seconds();
  if (begin < next_ || !views_.any()) {
    return;
  }
  // Errors are ignored. There may be no pixels yet, or the farm may be unreachable for a moment,
  // which Watch reports.
  if (const auto picture = client_->preview(job_, views_.most_side()); picture.ok()) {
    views_.show(picture->image, picture->display);
  }
  const double end = steady_seconds();
  next_ = end + std::max(kInterval_s, (end - begin) / kMaxShare);
}

/// Follows a job over the farm's Watch call, also after the connection was lost. `also` is called
/// with each status.
class Watch {
 public:
  Watch(FarmClient& client, JobId job, ProgressDisplay& display,
        const std::function<void(const Progress&)>& also)
      : client_(client), job_(job), display_(display), also_(also) {}

  // Returns the last status. UNAVAILABLE: the farm was unreachable for kMaxRetry_s. CANCELLED:
  // client.stop() was called. Other errors are the farm's, such as NOT_FOUND.
  absl::StatusOr<Progress> to_the_end() {
    for (;;) {
      const absl::Status status =
          client_.watch(job_, [this](const Progress& progress) { on_status(progress); });
      if (status.ok()) {
        return last_;
      }
      if (!absl::IsUnavailable(status) && !absl::IsDeadlineExceeded(status)) {
        return status;
      }
      RETURN_IF_ERROR(wait_for_farm(status));
    }
  }

 private:
  void on_status(const Progress& progress) {
    if (gone_since_) {
      display_.note("the farm is back");
      gone_since_.reset();
    }
    last_ = progress;
    display_.update(progress, steady_seconds());
    if (also_) {
      also_(progress);
    }
  }

  // Waits until the farm can be reached again; the errors are those of to_the_end(). `why`: the
  // error by which the connection was lost.
  absl::Status wait_for_farm(const absl::Status& why) {
    const double now = steady_seconds();
    if (!gone_since_) {
      gone_since_ = now;
      display_.note(absl::StrCat("lost the farm at ", client_.address(), " (", why.message(),
                                 "); trying again for ", kMaxRetry_s, " s"));
    }
    const double left = *gone_since_ + kMaxRetry_s - now;
    const auto milliseconds = std::chrono::milliseconds(static_cast<std::int64_t>(left * 1000));
    if (left <= 0 || !client_.wait_for_farm(milliseconds)) {
      return client_.stopped() ? absl::CancelledError("interrupted")
                               : absl::UnavailableError(absl::StrCat(
                                     "the farm at ", client_.address(), " did not come back"));
    }
    client_.pause(kUnreachablePause);
    return absl::OkStatus();
  }

  FarmClient& client_;
  JobId job_;
  ProgressDisplay& display_;
  const std::function<void(const Progress&)>& also_;
  Progress last_;
  std::optional<double> gone_since_;  // when the farm was lost; std::nullopt: not lost
};

// Prints an error that occurred after the farm had finished the image, and returns kFailed. The
// message has the command that fetches the image again. That command does not name the user's
// output files, because they may be the files that cannot be written.
ExitCode not_fetched(const absl::Status& status, WatchOptions options, const Console& console) {
  options.outputs.clear();
  return console.fail(
      ExitCode::kFailed,
      absl::StrCat(status.message(), "; the farm keeps the image. ", come_back(options, "FILE")));
}

// Returns true if --farm names a file, and not a join string or standard input.
bool is_file_name(const std::string& farm) {
  std::error_code error;
  return farm != "-" && !link::parse_join_string(farm).ok() && std::filesystem::exists(farm, error);
}

/// Returns the images that are written for the job: `result`, the additional layers that `beside`
/// makes and, with --denoise, the clean image. `beside` may be empty. The farm renders the layers
/// and the images that the denoiser needs. `views` (the terminal or a viewer) first show the image
/// as rendered, then the clean image.
absl::StatusOr<JobPictures> with_layers(FarmClient& client, FarmImage result, const Progress& last,
                                        const Wanted& wanted, ImageViews& views,
                                        ProgressDisplay& display, const BesideImage& beside) {
  JobPictures out{last, std::move(result), {}, std::nullopt};
  views.show(out.result.image, out.result.display);
  if (beside) {
    ASSIGN_OR_RETURN(out.layers, beside(last.job.samples_per_pixel, display));
  }
  if (wanted.denoise != Denoiser::kNone) {
    ASSIGN_OR_RETURN(out.clean, clean_job(client, last, out.result.image, wanted.denoise, display));
    views.show(out.clean->image, out.result.display);
  }
  return out;
}

}  // namespace

absl::Status write_pictures(const JobPictures& pictures, const Wanted& wanted) {
  const Image& image = pictures.result.image;
  const Display display = wanted.display.over(pictures.result.display);
  RETURN_IF_ERROR(pictures.clean ? write_clean_outputs(*pictures.clean, image, wanted.outputs,
                                                       display, pictures.layers)
                                 : write_outputs(image, wanted.outputs, display, pictures.layers));
  if (wanted.reports.empty()) {
    return absl::OkStatus();
  }
  Report report{pictures.job, pixels_sha256(image), wanted.outputs,
                cut_off_values(image, wanted.outputs, display)};
  if (pictures.clean) {
    report.clean = clean_report(*pictures.clean, wanted.denoise, wanted.outputs);
  }
  return write_reports(report_text(report), wanted.reports);
}

std::string come_back(const WatchOptions& options, const std::string& otherwise) {
  std::string out = absl::StrCat("Come back with: bandsaw watch ", options.job);
  const auto add = [&out](const char* name, const std::string& value) {
    if (!value.empty()) {
      absl::StrAppend(&out, " ", name, " ", shell_word(value));
    }
  };
  if (options.denoise != Denoiser::kNone) {
    out += options.denoise == Denoiser::kOidn ? " --denoise=oidn" : " --denoise";
  }
  add("-o", options.outputs.empty() ? otherwise : "");
  for (const std::string& output : options.outputs) {
    add("-o", output);
  }
  add("--report", options.report.file);
  out += options.display.half ? " --half" : "";
  if (options.display.exposure) {
    add("--exposure", absl::StrCat(*options.display.exposure));
  }
  if (options.display.tone) {
    add("--tone", *options.display.tone == Tone::kFilmic ? "filmic" : "none");
  }
  add("--video", options.after.video);
  if (!options.after.video.empty()) {
    add("--fps", absl::StrCat(options.after.video_fps));
  }
  add("--contact-sheet", options.after.contact_sheet);
  add("--then", options.after.command);
  add("--farm", is_file_name(options.farm.farm) ? options.farm.farm : "");
  return out;
}

ExitCode left_early(const absl::Status& status, JobId job, const std::string& how,
                    const std::string& otherwise, const Console& console) {
  const ExitCode code = exit_code_of(status);
  if (code == ExitCode::kInterrupted) {
    return console.fail(code, absl::StrCat("detached; job ", job, " continues. ", how));
  }
  if (code == ExitCode::kNoFarm) {
    return console.fail(code, absl::StrCat(status.message(), "; job ", job,
                                           " continues when the farm is started again. ", how));
  }
  return console.fail(code, otherwise);
}

absl::StatusOr<Progress> follow_job(FarmClient& client, JobId job, ProgressDisplay& display,
                                    const std::function<void(const Progress&)>& on_status) {
  return Watch(client, job, display, on_status).to_the_end();
}

ExitCode watch_job(FarmClient& client, const WatchOptions& options,
                   const std::vector<std::string>& reports, Process& process,
                   const BesideImage& beside) {
  const JobId job = options.job;
  const Wanted wanted{options.outputs, reports, options.display, options.tev, options.denoise};
  const auto left = [&](const absl::Status& status) {
    return left_early(status, job, come_back(options, "FILE"), std::string(status.message()),
                      process.console);
  };
  const Interrupts::Listener listener(process.interrupts, [&] { client.stop(); });
  ProgressDisplay display(process.console, options.verbosity);
  ImageViews views(display, wanted.display, wanted.tev, absl::StrCat("bandsaw job ", job));
  auto last = [&] {
    const FollowedImage followed(client, job, views);
    return follow_job(client, job, display);
  }();
  if (!last.ok()) {
    display.clear();
    return left(last.status());
  }
  if (last->job.state != JobState::kDone) {
    display.ended(*last);
    if (!options.verbosity.json) {
      for (const std::string& line : last->job.log) {
        process.console.complain(printable(absl::StrCat(last->job.log_of, " | ", line)));
      }
    }
    const std::string reason = last->job.reason.empty() ? "" : absl::StrCat(": ", last->job.reason);
    return process.console.fail(
        ExitCode::kFailed, absl::StrCat("job ", job, " ", state_name(last->job.state), reason));
  }
  if (!wanted.outputs.empty() || views.any()) {
    auto result = client.result(job);
    if (!result.ok()) {
      display.clear();
      return left(result.status());
    }
    const auto pictures =
        with_layers(client, *std::move(result), *last, wanted, views, display, beside);
    if (!pictures.ok()) {
      display.clear();
      return exit_code_of(pictures.status()) == ExitCode::kFailed
                 ? not_fetched(pictures.status(), options, process.console)
                 : left(pictures.status());
    }
    last->clean_error = pictures->clean ? pictures->clean->total.at_most() : -1;
    if (const auto status = write_pictures(*pictures, wanted); !status.ok()) {
      display.clear();
      return not_fetched(status, options, process.console);
    }
  }
  display.done(*last, wanted.outputs, reports);
  return ExitCode::kDone;
}

}  // namespace bandsaw::coordinator
