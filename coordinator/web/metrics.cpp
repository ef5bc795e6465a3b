// Writes metrics of the farm in Prometheus's text format, with one line for each value.

#include "coordinator/web/metrics.h"

#include <map>
#include <utility>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_replace.h"
#include "coordinator/scheduler/api/job_spec.h"

namespace bandsaw::coordinator {
namespace {

std::string label(const char* name, const std::string& value) {
  return absl::StrCat(name, "=\"",
                      absl::StrReplaceAll(value, {{"\\", "\\\\"}, {"\"", "\\\""}, {"\n", "\\n"}}),
                      "\"");
}

std::string kind_label(bool browser) { return label("kind", browser ? "browser" : "native"); }

std::string labels_of(const WorkerView& worker) {
  return absl::StrCat(label("worker", worker.name), ",", kind_label(worker.browser));
}

/// Builds the text: each metric with its help, and the lines of its values.
class Text {
 public:
  /// Begins a metric. Calls of line() add its values.
  void gauge(const char* name, const char* help) {
    name_ = name;
    absl::StrAppend(&text_, "# HELP ", name, " ", help, "\n# TYPE ", name, " gauge\n");
  }
  void line(const std::string& labels, double value) {
    absl::StrAppend(&text_, name_, labels.empty() ? "" : absl::StrCat("{", labels, "}"), " ", value,
                    "\n");
  }
  std::string text() && { return std::move(text_); }

 private:
  const char* name_ = "";
  std::string text_;
};

/// Writes the number of jobs in each state, and the number of workers of each state and kind. Also
/// writes the counts that are 0.
void add_counts(Text& out, const std::vector<JobView>& jobs,
                const std::vector<WorkerView>& workers) {
  std::map<std::string, int> jobs_by_state;
  for (const JobState state : {JobState::kRunning, JobState::kPaused, JobState::kFinishing,
                               JobState::kDone, JobState::kFailed, JobState::kCancelled}) {
    jobs_by_state[state_name(state)] = 0;
  }
  for (const JobView& job : jobs) {
    ++jobs_by_state[state_name(job.state)];
  }
  std::map<std::string, int> workers_by_state;
  for (const char* state : {"idle", "rendering", "draining", "lost", "refused", "quarantined"}) {
    for (const bool browser : {false, true}) {
      workers_by_state[absl::StrCat(label("state", state), ",", kind_label(browser))] = 0;
    }
  }
  for (const WorkerView& worker : workers) {
    ++workers_by_state[absl::StrCat(label("state", worker.state), ",", kind_label(worker.browser))];
  }
  out.gauge("bandsaw_jobs", "Jobs that are known, by state.");
  for (const auto& [state, count] : jobs_by_state) {
    out.line(label("state", state), count);
  }
  out.gauge("bandsaw_workers", "Workers, by state and kind.");
  for (const auto& [labels, count] : workers_by_state) {
    out.line(labels, count);
  }
}

/// Writes the metric `name`, with one line for each job that is not over. A job whose value is
/// unknown (negative) has no line.
template <class Value>
void add_jobs(Text& out, const char* name, const char* help, const std::vector<JobView>& jobs,
              Value value) {
  out.gauge(name, help);
  for (const JobView& job : jobs) {
    if (!is_final(job.state) && value(job) >= 0) {
      out.line(absl::StrCat(label("job", absl::StrCat(job.id)), ",", label("name", job.spec.name)),
               value(job));
    }
  }
}

}  // namespace

std::string metrics(const std::vector<JobView>& jobs, const std::vector<WorkerView>& workers,
                    std::uint64_t free_bytes, const std::string& version) {
  Text out;
  out.gauge("bandsaw_build_info", "The coordinator's version.");
  out.line(label("version", version), 1);
  out.gauge("bandsaw_free_bytes", "Free bytes on the disk of the coordinator's data folder.");
  out.line("", static_cast<double>(free_bytes));
  add_counts(out, jobs, workers);
  out.gauge("bandsaw_worker_samples_per_second", "A worker's pace, as last measured.");
  for (const WorkerView& worker : workers) {
    out.line(labels_of(worker), worker.samples_per_s);
  }
  out.gauge("bandsaw_worker_threads", "A worker's threads.");
  for (const WorkerView& worker : workers) {
    out.line(labels_of(worker), worker.threads);
  }
  add_jobs(out, "bandsaw_job_fraction", "How much of a job is done, 0 to 1.", jobs,
           [](const JobView& job) { return job.fraction; });
  add_jobs(out, "bandsaw_job_error", "Estimated relative RMSE of a job's image.", jobs,
           [](const JobView& job) { return job.error; });
  add_jobs(out, "bandsaw_job_bands_audited", "Bands that two machines rendered with equal results.",
           jobs, [](const JobView& job) { return static_cast<double>(job.bands_audited); });
  add_jobs(out, "bandsaw_job_samples_per_second", "A job's pace.", jobs,
           [](const JobView& job) { return job.samples_per_s; });
  return std::move(out).text();
}

}  // namespace bandsaw::coordinator
