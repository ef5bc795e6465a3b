// The commands `bandsaw missing`, which lists the frames of a job that are not done, and `bandsaw
// retry`, which renders failed frames again.

#include <map>

#include "absl/strings/str_cat.h"
#include "coordinator/cli/base/json.h"
#include "coordinator/cli/base/text.h"
#include "coordinator/cli/farm/farm_errors.h"
#include "coordinator/cli/farm/lists_text.h"
#include "coordinator/cli/options/commands.h"
#include "coordinator/scheduler/api/frame_numbers.h"
#include "renderlib/base/status_macros.h"

namespace bandsaw::coordinator {
namespace {

/// Returns a line for each state except "done" with the numbers of its frames, then a line for each
/// frame that has failed.
std::vector<std::string> missing_lines(const std::vector<FrameView>& frames) {
  std::map<FrameState, std::vector<FrameNumber>> in_state;
  std::vector<std::string> failures;
  for (const FrameView& frame : frames) {
    in_state[frame.state].push_back(frame.number);
    if (frame.state == FrameState::kFailed) {
      failures.push_back(
          absl::StrCat("frame ", frame.number, " failed: ", printable(frame.reason)));
    }
  }
  std::vector<std::string> lines;
  for (const auto& [state, numbers] : in_state) {
    if (state != FrameState::kDone) {
      lines.push_back(absl::StrCat(pad_right(frame_state_name(state), 10), frames_text(numbers)));
    }
  }
  lines.insert(lines.end(), failures.begin(), failures.end());
  return lines.empty() ? std::vector<std::string>{"no frame is missing"} : lines;
}

/// Returns a JSON object for each frame that is not done.
std::vector<std::string> missing_json(JobId job, const std::vector<FrameView>& frames) {
  std::vector<std::string> lines;
  for (const FrameView& frame : frames) {
    if (frame.state != FrameState::kDone) {
      lines.push_back(JsonObject()
                          .text("event", "missing")
                          .whole("job", job)
                          .number("frame", static_cast<double>(frame.number))
                          .text("state", frame_state_name(frame.state))
                          .whole("frame_job", frame.job)
                          .text("reason", frame.reason)
                          .str());
    }
  }
  return lines;
}

absl::Status list_missing(const MissingOptions& options, const Console& console) {
  ASSIGN_OR_RETURN(const auto client, connect_to_farm(options.farm));
  ASSIGN_OR_RETURN(const FarmClient::Frames frames, client->frames(options.job));
  for (const std::string& line : options.verbosity.json ? missing_json(options.job, frames.frames)
                                                        : missing_lines(frames.frames)) {
    console.line(line);
  }
  return absl::OkStatus();
}

absl::Status retry(const RetryOptions& options, const Console& console) {
  ASSIGN_OR_RETURN(const auto client, connect_to_farm(options.farm));
  ASSIGN_OR_RETURN(const Progress progress, client->retry_frames(options.job, options.frames));
  if (options.verbosity.json) {
    console.line(jobs_json({progress}).front());
  } else {
    const FrameCounts& frames = progress.job.frames;
    console.line(absl::StrCat("job ", options.job, " is ", state_name(progress.job.state), ": ",
                              frames.of(FrameState::kDone), " of ", frames.all(),
                              " frames are done, ", frames.of(FrameState::kFailed),
                              " have failed"));
  }
  return absl::OkStatus();
}

}  // namespace

ExitCode run(const MissingOptions& options, Process& process) {
  return finished(list_missing(options, process.console), process.console);
}

ExitCode run(const RetryOptions& options, Process& process) {
  return finished(retry(options, process.console), process.console);
}

}  // namespace bandsaw::coordinator
