// Formats what `bandsaw jobs`, `workers`, `why` and `logs` list: as tables for people, or as one
// JSON object per line for programs. In the tables, a row may go on after the last heading with
// the number of frames that are done (for a job of many frames) and with a reason.

#include "coordinator/cli/farm/lists_text.h"

#include <algorithm>
#include <cmath>

#include "absl/strings/str_cat.h"
#include "coordinator/cli/base/text.h"
#include "coordinator/cli/progress/progress_json.h"
#include "coordinator/cli/progress/progress_text.h"
#include "coordinator/scheduler/api/job_spec.h"
#include "renderlib/scene/guide_integrators.h"

namespace bandsaw::coordinator {
namespace {

const char* worker_kind(const farm::WorkerStatus& worker) {
  return worker.browser() ? "browser" : "native";
}

}  // namespace

std::vector<std::string> table(const std::vector<std::vector<std::string>>& rows) {
  std::vector<std::size_t> widths;
  for (const auto& row : rows) {
    widths.resize(std::max(widths.size(), row.size()));
    for (std::size_t i = 0; i < row.size(); ++i) {
      widths[i] = std::max(widths[i], columns(row[i]));
    }
  }
  std::vector<std::string> lines;
  for (const auto& row : rows) {
    std::string line;
    for (std::size_t i = 0; i < row.size(); ++i) {
      absl::StrAppend(&line, i > 0 ? "  " : "", pad_right(row[i], widths[i]));
    }
    line.erase(line.find_last_not_of(' ') + 1);
    lines.push_back(std::move(line));
  }
  return lines;
}

std::vector<std::string> jobs_table(const std::vector<Progress>& jobs) {
  std::vector<std::vector<std::string>> rows = {
      {"job", "scene", "state", "priority", "done", "size", "until", "error", "time"}};
  std::size_t guides = 0;
  for (const Progress& progress : jobs) {
    const JobView& job = progress.job;
    if (is_guide(job.spec.settings.integrator) && job.state == JobState::kDone) {
      ++guides;
      continue;
    }
    rows.push_back({
        absl::StrCat(job.id),
        printable(job.spec.name),
        state_name(job.state),
        absl::StrCat(job.priority),
        absl::StrCat(static_cast<int>(std::floor(std::clamp(job.fraction, 0.0, 1.0) * 100)), " %"),
        absl::StrCat(job.spec.settings.width, "×", job.spec.settings.height),
        stop_text(job.spec.stop),
        job.error >= 0 ? percent(job.error) : "",
        duration(job.elapsed_s),
    });
    if (job.has_frames()) {
      rows.back().push_back(frames_done_text(job.frames));
    }
    if (!job.reason.empty()) {
      rows.back().push_back(printable(job.reason));
    }
  }
  if (jobs.empty()) {
    return {"no jobs; start one with: bandsaw submit SCENE"};
  }
  std::vector<std::string> lines = table(rows);
  if (guides > 0) {
    lines.push_back(absl::StrCat("not listed: ", guides, " finished guide ",
                                 guides == 1 ? "image" : "images", " for the denoiser"));
  }
  return lines;
}

std::vector<std::string> jobs_json(const std::vector<Progress>& jobs) {
  std::vector<std::string> lines;
  for (const Progress& progress : jobs) {
    lines.push_back(progress_json(progress, "job").str());
  }
  return lines;
}

std::vector<std::string> why_json(JobId job, const std::vector<std::string>& reasons) {
  return {JsonObject().text("event", "why").whole("job", job).texts("reasons", reasons).str()};
}

std::string log_json(const std::string& worker, const std::vector<std::string>& lines) {
  return JsonObject().text("event", "log").text("worker", worker).texts("lines", lines).str();
}

std::vector<std::string> workers_table(const farm::ListWorkersReply& reply) {
  std::vector<std::vector<std::string>> rows = {
      {"worker", "kind", "state", "threads", "rate", "job", "connected", "address", "build"}};
  for (const farm::WorkerStatus& worker : reply.worker()) {
    rows.push_back({printable(worker.name()), worker_kind(worker), printable(worker.state()),
                    absl::StrCat(worker.threads()),
                    worker.samples_per_s() > 0 ? si(worker.samples_per_s()) + "/s" : "",
                    worker.job() > 0 ? absl::StrCat(worker.job()) : "",
                    duration(worker.connected_s()), printable(worker.address()),
                    printable(worker.build())});
    if (!worker.reason().empty()) {
      rows.back().push_back(printable(worker.reason()));
    }
  }
  return reply.worker().empty()
             ? std::vector<std::string>{"no workers; start one with: bandsaw-worker --join STRING"}
             : table(rows);
}

std::vector<std::string> workers_json(const farm::ListWorkersReply& reply) {
  std::vector<std::string> lines;
  for (const farm::WorkerStatus& worker : reply.worker()) {
    lines.push_back(JsonObject()
                        .text("event", "worker")
                        .text("name", worker.name())
                        .text("kind", worker_kind(worker))
                        .text("state", worker.state())
                        .text("reason", worker.reason())
                        .whole("threads", worker.threads())
                        .number("samples_per_s", worker.samples_per_s())
                        .whole("job", worker.job())
                        .text("address", worker.address())
                        .text("build", worker.build())
                        .number("connected_s", worker.connected_s())
                        .str());
  }
  return lines;
}

}  // namespace bandsaw::coordinator
