#include "worker/workshop.h"

#include <spdlog/spdlog.h>

#include "absl/strings/str_cat.h"
#include "renderlib/base/status_macros.h"

namespace bandsaw::worker {
namespace {

/// How the log names a band, for people and for those who search it.
std::string name_of(const Task& task) {
  return absl::StrCat("job=", task.job, " rows=", task.band.rows.first, ":", task.band.rows.last,
                      " samples=", task.band.samples.first, ":", task.band.samples.last);
}

std::string text_of(const absl::Status& status) { return std::string(status.message()); }

}  // namespace

Workshop::Workshop(Desk& desk, std::unique_ptr<BlobCache> cache, int threads, const Kernel* kernel,
                   FarmDoors farm, LogTail log_tail, std::uint64_t seed)
    : desk_(desk),
      cache_(std::move(cache)),
      farm_(std::move(farm)),
      log_tail_(std::move(log_tail)),
      kernel_(kernel),
      pool_(threads),
      uploader_([this](const FinishedBand& band) { return put(band); },
                [this](TaskId task, const auto& outcome) { settled(task, outcome); }, seed),
      executor_(
          pool_,
          [this](const wire::Digest& manifest, const std::atomic<bool>& stop,
                 const Prepared& prepared) { return load(manifest, stop, prepared); },
          executor_events()) {}

void Workshop::stop(TaskId task) {
  executor_.stop(task);
  uploader_.drop(task);
}

absl::StatusOr<std::shared_ptr<const Scene>> Workshop::load(const wire::Digest& manifest,
                                                            const std::atomic<bool>& stop,
                                                            const Prepared& prepared) {
  const std::string name = manifest.hex().substr(0, 12);
  spdlog::info("scene {}: loading", name);
  FetchingSource blobs(*cache_, farm_.get_blob, stop, prepared);
  ASSIGN_OR_RETURN(std::shared_ptr<const Scene> scene,
                   load_package(manifest, blobs, pool_, kernel_));
  spdlog::info("scene {}: ready", name);
  return scene;
}

ExecutorEvents Workshop::executor_events() {
  return {
      .preparing = [this](TaskId task, std::uint64_t prepared) { desk_.preparing(task, prepared); },
      .rendering = [this](TaskId task,
                          std::uint32_t rows_done) { desk_.rendering(task, rows_done); },
      .finished =
          [this](FinishedBand band) {
            if (desk_.finished(band.task.id)) {
              spdlog::info("rendered {} in {:.2f} s", name_of(band.task), band.cost.render_s);
              uploader_.add(std::move(band));
            }
          },
      .failed =
          [this](const Task& task, const absl::Status& status) {
            spdlog::error("failed {}: {}", name_of(task), text_of(status));
            failed(task.id, status);
          }};
}

void Workshop::failed(TaskId task, const absl::Status& status) {
  desk_.failed(task, text_of(status), log_tail_ ? log_tail_() : std::vector<std::string>());
}

absl::StatusOr<farm::PutBandReply::Outcome> Workshop::put(const FinishedBand& band) {
  ASSIGN_OR_RETURN(const LeaseName lease, desk_.lease_of(band.task.id));
  absl::StatusOr<farm::PutBandReply::Outcome> outcome = farm_.put_band(band, lease);
  if (!outcome.ok()) {
    spdlog::warn("kept {}: {}", name_of(band.task), text_of(outcome.status()));
  } else if (*outcome == farm::PutBandReply::OUTCOME_UNWANTED) {
    spdlog::info("unwanted {}", name_of(band.task));
  } else {
    spdlog::info("stored {}", name_of(band.task));
  }
  return outcome;
}

void Workshop::settled(TaskId task, const absl::StatusOr<farm::PutBandReply::Outcome>& outcome) {
  if (outcome.ok()) {
    desk_.settled(task);
  } else {
    failed(task, outcome.status());
  }
}

}  // namespace bandsaw::worker
