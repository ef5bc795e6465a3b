// Each function makes one kind of line from the state of a render. Values that are unknown are left
// out.

#include "coordinator/cli/progress/progress_text.h"

#include <algorithm>
#include <cmath>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "coordinator/cli/base/text.h"

namespace bandsaw::coordinator {
namespace {

constexpr char kDot[] = " · ";
constexpr std::size_t kBarColumns = 20;

std::string percent_done(const JobView& job) {
  // Rounded down, so that 100 % means that nothing is left.
  const double fraction = std::clamp(job.fraction, 0.0, 1.0);
  return pad_left(absl::StrCat(static_cast<int>(std::floor(fraction * 100)), " %"), 5);
}

// Returns a bar of `width` columns, which is filled up to `fraction`, [0, 1]. A column is empty,
// half full ("╸") or full ("━").
std::string bar(double fraction, std::size_t width) {
  const auto halves = std::lround(std::clamp(fraction, 0.0, 1.0) * 2 * static_cast<double>(width));
  std::string out;
  for (long i = 0; i < halves / 2; ++i) {
    out += "━";
  }
  return pad_right(halves % 2 == 1 ? out + "╸" : out, width);
}

std::string rate(double per_second) { return si(per_second) + "/s"; }

// Returns the number with a noun: "1 frame", "2 frames".
std::string count(std::size_t n, const std::string& what) {
  return absl::StrCat(n, " ", what, n == 1 ? "" : "s");
}

// Returns the text of the error of the clean image, or of the image as rendered if the error of a
// clean image is unknown. Returns an empty text if both are unknown.
std::string error_text(const Progress& progress) {
  return progress.clean_error >= 0 ? "clean error " + percent(progress.clean_error)
         : progress.job.error >= 0 ? "error " + percent(progress.job.error)
                                   : "";
}

// Returns the figures of bar_line() and plain_line(), such as "error 1.6 %", "48 Msamples".
std::vector<std::string> measures(const Progress& progress) {
  const JobView& job = progress.job;
  std::vector<std::string> out;
  if (job.has_frames()) {
    out.push_back(frames_done_text(job.frames));
  } else if (const std::string error = error_text(progress); !error.empty()) {
    out.push_back(error);
  }
  out.push_back(si_with(static_cast<double>(job.samples_done), "samples"));
  if (job.samples_per_s > 0) {
    out.push_back(rate(job.samples_per_s));
  }
  if (job.state == JobState::kFinishing) {
    out.emplace_back("writing the result");
  } else if (job.remaining_s >= 0 && !is_final(job.state)) {
    out.push_back(clock_time(job.remaining_s) + " left");
  }
  return out;
}

// Returns the line of one worker. The worker's name is cut or padded to `name_columns` columns.
std::string worker_line(const JobWorkerView& worker, std::size_t name_columns) {
  const std::string threads = count(worker.threads, "thread") + (worker.threads == 1 ? " " : "");
  const bool has_rows = worker.rows.first < worker.rows.last;
  std::string doing = printable(worker.state);
  if (has_rows && (doing.empty() || doing == "rendering")) {
    doing = absl::StrCat("rows ", worker.rows.first, "–", worker.rows.last);
  }
  return absl::StrCat("   ", pad_right(fit(printable(worker.name), name_columns), name_columns),
                      " ", pad_left(threads, 10), "  ",
                      pad_left(worker.samples_per_s > 0 ? rate(worker.samples_per_s) : "", 7),
                      "   ", doing);
}

}  // namespace

std::string frames_done_text(const FrameCounts& frames) {
  const std::size_t failed = frames.of(FrameState::kFailed);
  return absl::StrCat(frames.of(FrameState::kDone), " of ", count(frames.all(), "frame"),
                      failed == 0 ? "" : absl::StrCat(kDot, failed, " failed"));
}

std::string header_line(const Progress& progress) {
  const JobSpec& spec = progress.job.spec;
  return absl::StrCat(
      progress.job.id > 0 ? absl::StrCat("job ", progress.job.id, kDot) : "", printable(spec.name),
      kDot, spec.settings.width, "×", spec.settings.height, kDot,
      progress.job.has_frames() ? absl::StrCat(count(progress.job.frames.all(), "frame"), kDot)
                                : "",
      "until ", stop_text(spec.stop));
}

std::string bar_line(const Progress& progress, std::size_t width) {
  const std::string before = percent_done(progress.job) + " ";
  const std::string after = " " + absl::StrJoin(measures(progress), kDot);
  const std::size_t taken = columns(before) + columns(after);
  const std::size_t available = width > taken ? width - taken : 0;
  return before + bar(progress.job.fraction, std::min(available, kBarColumns)) + after;
}

std::string plain_line(const Progress& progress) {
  std::vector<std::string> parts = measures(progress);
  if (progress.job.id > 0) {
    parts.push_back(count(progress.job.workers.size(), "worker"));
  }
  if (!progress.job.reason.empty()) {
    parts.push_back(printable(progress.job.reason));
  }
  return absl::StrCat(percent_done(progress.job), kDot, absl::StrJoin(parts, kDot));
}

std::vector<std::string> worker_lines(const Progress& progress, std::size_t most) {
  constexpr std::size_t kMinName = 8;
  constexpr std::size_t kMaxName = 24;
  const std::vector<JobWorkerView>& workers = progress.job.workers;
  std::vector<std::string> lines;
  if (!progress.job.reason.empty()) {
    lines.push_back("   " + printable(progress.job.reason));
  }
  std::size_t name_columns = kMinName;
  for (const JobWorkerView& worker : workers) {
    name_columns = std::clamp(columns(printable(worker.name)), name_columns, kMaxName);
  }
  for (std::size_t i = 0; i < workers.size() && lines.size() < most; ++i) {
    // The last line is needed for the number of workers that are omitted.
    const bool is_full = lines.size() + 1 == most && i + 1 < workers.size();
    lines.push_back(is_full ? absl::StrCat("   … and ", workers.size() - i, " more workers")
                            : worker_line(workers[i], name_columns));
    if (is_full) {
      break;
    }
  }
  return lines;
}

std::string final_line(const Progress& progress, const std::string& name,
                       const std::string& reports) {
  const JobView& job = progress.job;
  std::string line = name;
  if (job.has_frames()) {
    absl::StrAppend(&line, kDot, count(job.frames.all(), "frame"));
  }
  if (const std::string error = error_text(progress); !error.empty()) {
    absl::StrAppend(&line, kDot, error);
  }
  absl::StrAppend(&line, kDot, duration(job.elapsed_s), kDot);
  absl::StrAppend(&line, progress.threads > 0
                             ? count(static_cast<std::size_t>(progress.threads), "thread")
                             : count(job.workers_used, "worker"));
  return reports.empty() ? line : absl::StrCat(line, kDot, "report ", reports);
}

std::string cost_line(const Progress& progress) {
  const JobView& job = progress.job;
  const auto rays = static_cast<double>(job.counters.rays);
  std::string line = absl::StrCat(
      job.has_frames() ? ""
                       : absl::StrCat(count(job.samples_per_pixel, "sample"), " a pixel", kDot),
      si(rays), " rays");
  if (job.cpu_s > 0) {
    absl::StrAppend(&line, ", ", si(rays / job.cpu_s), "/CPU s", kDot, duration(job.cpu_s),
                    " of CPU");
  }
  if (job.curve.empty()) {
    return line;
  }
  const ErrorEstimate& error = job.curve.back().estimate;
  if (const auto needed = cpu_s_until(job.curve, 0.01)) {
    absl::StrAppend(&line, kDot, "1 % error after ", duration(*needed), " of CPU");
  }
  return absl::StrCat(line, kDot, "error up to ", percent(error.median),
                      " in half of the pixels, up to ", percent(error.percentile_95), " in 95 %");
}

std::string doubt_line(const Progress& progress) {
  const ErrorCurve& curve = progress.job.curve;
  if (curve.empty() || !curve.back().estimate.doubtful()) {
    return "";
  }
  return absl::StrCat("warning: ", percent(curve.back().estimate.worst_share),
                      " of the error is in the worst 0.1 % of the pixels: bright light that few "
                      "paths find; the true error is likely larger than reported");
}

std::vector<std::string> warning_lines(const Progress& progress) {
  std::vector<std::string> lines = {bad_samples_line(progress), doubt_line(progress)};
  std::erase(lines, "");
  return lines;
}

std::string left_out_line(const Progress& progress) {
  const JobView& job = progress.job;
  std::vector<std::string> parts;
  if (job.counters.truncated_paths > 0 && job.samples_done > 0) {
    const double share =
        static_cast<double>(job.counters.truncated_paths) / static_cast<double>(job.samples_done);
    parts.push_back(absl::StrCat(percent(share), " of the paths were cut off at depth ",
                                 job.spec.settings.max_depth));
  }
  if (job.counters.dropped_primitives > 0) {
    parts.push_back(absl::StrCat(count(job.counters.dropped_primitives, "primitive"),
                                 " without area left out"));
  }
  return absl::StrJoin(parts, kDot);
}

std::string bad_samples_line(const Progress& progress) {
  const std::uint64_t bad = progress.job.counters.bad_samples;
  if (bad == 0) {
    return "";
  }
  return absl::StrCat("warning: ", bad, bad == 1 ? " sample was" : " samples were",
                      " negative, infinite or NaN and left out of the image; the first: ",
                      printable(progress.bad_sample_at),
                      "; the scene or this program has a fault there");
}

}  // namespace bandsaw::coordinator
