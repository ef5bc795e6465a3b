// Writes bands (the pixels of some rows and samples, rendered by a worker) and results to disk.
// append() writes a band to the log of its job. settle(), which is called after each batch of
// messages, syncs each log with one fdatasync. Then it reports the bands to the scheduler as
// stored.

#include "coordinator/engine/store_thread.h"

#include <spdlog/spdlog.h>

#include <chrono>
#include <filesystem>
#include <utility>

#include "absl/strings/str_cat.h"
#include "renderlib/base/status_macros.h"

namespace bandsaw::coordinator {
namespace {

/// Interval of the tests of a disk that has failed.
constexpr double kTestEvery_s = 2;

double unix_seconds() {
  return std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count();
}

/// Returns true if the record belongs to a job with this scene and these settings. A log may hold
/// bands of another job with the same id, because ids are used again after a reset of the journal.
bool belongs(const BandRecord& record, const JobSpec& spec) {
  return record.package_digest == spec.manifest && record.settings == spec.settings;
}

}  // namespace

absl::StatusOr<BandLogReport> StoreThread::open_job(
    JobId id, const JobSpec& spec, absl::FunctionRef<void(BandRecord, std::uint64_t)> each) {
  RETURN_IF_ERROR(add_job(id, spec));
  OpenJob& job = jobs_[id];
  BandLogReport report;
  const auto hand_on = [&](BandRecord record, std::uint64_t offset) {
    if (belongs(record, spec)) {
      each(std::move(record), offset);
    } else {
      report.damaged_bytes += band_record_size(record.pixels.band, record.settings.width);
    }
  };
  ASSIGN_OR_RETURN(job.log, BandLog::open(folder_.job(id), folder_.bands(id), hand_on, report));
  return report;
}

absl::Status StoreThread::add_job(JobId id, const JobSpec& spec) {
  jobs_[id].spec = spec;
  RETURN_IF_ERROR(make_folder(folder_.job(id)));
  return sync_folder(folder_.jobs());
}

void StoreThread::append(IncomingBand incoming) {
  const auto job = jobs_.find(incoming.job);
  if (job == jobs_.end()) {
    scheduler_.band_failed(std::move(incoming), absl::CancelledError("the job is over"));
    return;
  }
  const absl::Status written = write(job->second, incoming);
  if (!written.ok()) {
    test_disk_until_writable();
    scheduler_.band_failed(std::move(incoming), written);
    return;
  }
  job->second.written.push_back(std::move(incoming));
}

absl::Status StoreThread::write(OpenJob& job, IncomingBand& incoming) {
  RETURN_IF_ERROR(open_log(incoming.job, job));
  BandRecord record{.package_digest = job.spec.manifest,
                    .settings = job.spec.settings,
                    .pixels = std::move(incoming.pixels),
                    .cpu_s = incoming.cpu_s,
                    .process = incoming.process};
  const absl::StatusOr<std::uint64_t> offset = job.log->append(record);
  incoming.pixels = std::move(record.pixels);
  RETURN_IF_ERROR(offset.status());
  incoming.offset = *offset;
  incoming.written = true;
  return absl::OkStatus();
}

absl::Status StoreThread::open_log(JobId id, OpenJob& job) {
  if (!job.log) {
    RETURN_IF_ERROR(add_job(id, job.spec));
    BandLogReport report;
    ASSIGN_OR_RETURN(
        job.log, BandLog::open(
                     folder_.job(id), folder_.bands(id), [](BandRecord, std::uint64_t) {}, report));
  }
  return absl::OkStatus();
}

// Compares nothing itself: computes the digests of the band's rows and sends them to the scheduler.
void StoreThread::compare(IncomingBand incoming) {
  std::vector<std::uint64_t> digests = row_digests(incoming.pixels);
  scheduler_.band_stored(std::move(incoming), std::move(digests));
}

void StoreThread::settle() {
  for (auto& [id, job] : jobs_) {
    if (!job.written.empty()) {
      settle(job);
    }
  }
  if (!trouble_ || clock_.now() - tested_at_ < kTestEvery_s) {
    return;
  }
  tested_at_ = clock_.now();
  if (probe_disk(folder_.path()).ok()) {
    trouble_ = false;
    scheduler_.disk_is_back();
  }
}

void StoreThread::settle(OpenJob& job) {
  const absl::Status synced = job.log->sync();
  for (IncomingBand& incoming : std::exchange(job.written, {})) {
    if (synced.ok()) {
      compare(std::move(incoming));  // reports it as stored, with its digests
    } else {
      test_disk_until_writable();
      scheduler_.band_failed(std::move(incoming), synced);
    }
  }
}

void StoreThread::write_result(JobId id, const Finished& finished) {
  // An error here is only logged, because the image is valid without the attribution.
  if (const absl::Status status = write_attribution(finished.attribution, folder_.attribution(id));
      !status.ok()) {
    spdlog::warn("job={} the names of the workers that rendered its rows could not be stored: {}",
                 id, status.ToString());
  }
  absl::Status written;
  if (finished.first) {
    written = coordinator::write_result(*finished.first, folder_.job(id), folder_.first(id));
  }
  if (written.ok() && finished.samples) {
    written = coordinator::write_result(*finished.samples, folder_.job(id), folder_.samples(id));
  }
  if (written.ok()) {
    written = coordinator::write_result(finished.image, folder_.job(id), folder_.result(id));
  }
  if (!written.ok()) {
    test_disk_until_writable();
  }
  scheduler_.result_written(id, written);
}

absl::StatusOr<StoredResult> StoreThread::read_result(JobId id, FinishedPart part) const {
  if (part == FinishedPart::kSamples) {
    absl::StatusOr<StoredResult> samples = coordinator::read_result(folder_.samples(id));
    return absl::IsNotFound(samples.status())
               ? absl::NotFoundError(
                     absl::StrCat("the number of samples of each pixel is not stored for job ", id,
                                  ": the job was not adaptive, or an earlier version rendered it"))
               : std::move(samples);
  }
  if (part == FinishedPart::kFirst) {
    absl::StatusOr<StoredResult> first = coordinator::read_result(folder_.first(id));
    return absl::IsNotFound(first.status())
               ? absl::NotFoundError(absl::StrCat(
                     "the mean of the first samples is not stored for job ", id,
                     ": the job has too few samples, or was rendered by an earlier version"))
               : std::move(first);
  }
  absl::StatusOr<StoredResult> result = coordinator::read_result(folder_.result(id));
  if (absl::IsNotFound(result.status())) {
    return absl::DataLossError(absl::StrCat("the result of job ", id, " is missing (",
                                            folder_.result(id), "); submit the job again"));
  }
  return result;
}

// Settles the bands of the job's log and closes the log, which was found damaged. The job's next
// band opens the log again (open_log).
void StoreThread::reopen(JobId id) {
  if (const auto job = jobs_.find(id); job != jobs_.end() && job->second.log) {
    settle(job->second);
    job->second.log.reset();
  }
}

void StoreThread::drop_bands(JobId id) {
  jobs_.erase(id);
  remove_file(folder_.bands(id)).IgnoreError();  // remaining files are removed at the next start
}

void StoreThread::drop_job(JobId id) {
  std::error_code error;  // remaining files are removed by the next sweep
  std::filesystem::remove_all(folder_.job(id), error);
}

void StoreThread::collect(const std::vector<KeptJob>& jobs) {
  const double now = unix_seconds();
  // The files of a forgotten job are removed once the journal has the record that the job is
  // forgotten (action::DropJob). The blobs of this job are removed by the next sweep.
  collector_.sweep(jobs, now);
  if (std::vector<JobId> old = collector_.to_forget(jobs, now); !old.empty()) {
    scheduler_.forget(std::move(old));
  }
}

void StoreThread::test_disk_until_writable() {
  if (!trouble_) {
    trouble_ = true;
    tested_at_ = clock_.now();
  }
}

}  // namespace bandsaw::coordinator
