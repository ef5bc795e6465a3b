// Writes the lines of the log. Line has a function for each kind of record, which logs the record
// as key=value pairs.

#include "coordinator/engine/job_log.h"

#include <spdlog/spdlog.h>

#include "absl/strings/str_cat.h"
#include "coordinator/scheduler/api/job_spec.h"

namespace bandsaw::coordinator {
namespace {

struct Line {
  void operator()(const record::JobAdded& r) const {
    spdlog::info("job={} added name='{}' size={}x{} manifest={}{}", r.job, r.spec.name,
                 r.spec.settings.width, r.spec.settings.height, r.spec.manifest,
                 r.spec.sequence == 0
                     ? std::string()
                     : absl::StrCat(" frame=", r.spec.frame, " of=", r.spec.sequence));
  }
  void operator()(const record::PassPlanned& r) const {
    spdlog::debug("job={} pass samples=[{},{})", r.job, r.samples.first, r.samples.last);
  }
  void operator()(const record::TilesPlanned& r) const {
    spdlog::info("job={} tiles planned from samples={} {}", r.job, r.plan.pilot,
                 r.plan.even() ? "uniformly" : "more samples where there is more noise");
  }
  void operator()(const record::SamplesFixed& r) const {
    spdlog::info("job={} ends after samples={}", r.job, r.samples);
  }
  void operator()(const record::StateChanged& r) const {
    spdlog::info("job={} {} {}", r.job, state_name(r.state), r.reason);
  }
  void operator()(const record::PriorityChanged& r) const {
    spdlog::info("job={} priority={}", r.job, r.priority);
  }
  void operator()(const record::HoldChanged& r) const {
    spdlog::info("job={} {} by a user", r.job, r.held ? "paused" : "resumed");
  }
  void operator()(const record::TimeSpent&) const {}
  void operator()(const record::JobSummary& r) const {
    spdlog::info("job={} elapsed={:.3f} s cpu={:.3f} s workers={} samples={}", r.job, r.elapsed_s,
                 r.cpu_s, r.workers_used, r.samples);
  }
  void operator()(const record::ErrorMeasured& r) const {
    spdlog::debug("job={} samples={} error={:.5f}", r.job, r.point.samples,
                  r.point.estimate.at_most());
  }
  void operator()(const record::ShareCounted& r) const {
    spdlog::info("job={} worker={} samples={} cpu={:.3f} s", r.job, r.share.name, r.share.samples,
                 r.share.cpu_s);
  }
  void operator()(const record::FailureLog& r) const {
    for (const std::string& line : r.log) {
      spdlog::error("job={} worker={} | {}", r.job, r.worker, line);
    }
  }
  void operator()(const record::JobForgotten& r) const { spdlog::info("job={} forgotten", r.job); }
  void operator()(const record::WorkerJoined& r) const {
    spdlog::debug("worker instance={} joined", r.instance);
  }
  void operator()(const record::WorkerLeft& r) const {
    spdlog::debug("worker instance={} left", r.instance);
  }
  void operator()(const record::BandAudited& r) const {
    spdlog::debug("audited job={} rows={}:{} samples={}:{}", r.job, r.band.rows.first,
                  r.band.rows.last, r.band.samples.first, r.band.samples.last);
  }
  void operator()(const record::RowDisputed& r) const {
    spdlog::warn(
        "disputed job={} row={} samples={}:{} stored by worker='{}', contradicted by worker='{}'",
        r.job, r.band.rows.first, r.band.samples.first, r.band.samples.last, r.stored.machine,
        r.other.machine);
  }
  void operator()(const record::BandLost& r) const {
    spdlog::error(
        "lost job={} rows={}:{} samples={}:{} the record of this band in the band log is "
        "damaged; the band is rendered again",
        r.job, r.band.rows.first, r.band.rows.last, r.band.samples.first, r.band.samples.last);
  }
  void operator()(const record::ErrorForgotten& r) const {
    spdlog::warn("job={} wrong pixels are rendered again; its error is measured again", r.job);
  }
  void operator()(const record::WorkerQuarantined& r) const {
    spdlog::error("quarantined worker={} {}", r.name, r.reason);
  }
  void operator()(const record::SequenceAdded& r) const {
    spdlog::info("job={} added name='{}' size={}x{} frames={}", r.job, r.spec.name,
                 r.spec.settings.width, r.spec.settings.height, r.spec.frames.size());
  }
  void operator()(const record::FrameWaits& r) const {
    if (r.failures > 0) {
      spdlog::warn("job={} frame={} is tried again: {}", r.job, r.frame, r.reason);
    } else {
      spdlog::debug("job={} frame={} waits manifest={}", r.job, r.frame, r.manifest);
    }
  }
  void operator()(const record::QuarantineLifted& r) const {
    spdlog::info("quarantine lifted worker={}", r.name);
  }
};

}  // namespace

void log_record(const Record& record) { std::visit(Line{}, record); }

void log_failure(const action::LogFailure& failure) {
  spdlog::warn("failed job={} rows={}:{} samples={}:{} worker={}: {}", failure.job,
               failure.band.rows.first, failure.band.rows.last, failure.band.samples.first,
               failure.band.samples.last, failure.worker, failure.reason);
}

void log_reassignment(const action::LogReassignment& reassignment) {
  const Band& band = reassignment.band;
  spdlog::info("{} job={} rows={}:{} samples={}:{} from={} to={}",
               reassignment.begun ? "copied" : "moved", reassignment.job, band.rows.first,
               band.rows.last, band.samples.first, band.samples.last, reassignment.from,
               reassignment.to);
}

}  // namespace bandsaw::coordinator
