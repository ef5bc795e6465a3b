// Connects executor, uploader and session. The executor renders a task. The uploader sends the band
// until the coordinator has answered. Each event is reported to the session and logged.

#include "worker/band_pipeline.h"

#include <spdlog/spdlog.h>

#include "absl/strings/str_cat.h"
#include "renderlib/base/status_macros.h"

namespace bandsaw::worker {
namespace {

/// Returns the name of a band in the log, in a form that is easy to search for.
std::string name_of(const Task& task) {
  return absl::StrCat("job=", task.job, " rows=", task.band.rows.first, ":", task.band.rows.last,
                      " samples=", task.band.samples.first, ":", task.band.samples.last);
}

std::string text_of(const absl::Status& status) { return std::string(status.message()); }

}  // namespace

BandPipeline::BandPipeline(SharedSession& session, std::unique_ptr<BlobCache> cache, int threads,
                           const Kernel* kernel, CoordinatorApi& calls, LogTail log_tail,
                           std::uint64_t seed)
    : session_(session),
      cache_(std::move(cache)),
      calls_(calls),
      log_tail_(std::move(log_tail)),
      pool_(threads),
      loader_(pool_, kernel),
      uploader_([this](const FinishedBand& band) { return put(band); },
                [this](TaskId task, const auto& outcome) { settled(task, outcome); }, seed),
      executor_(
          pool_,
          [this](const wire::Digest& manifest, const std::atomic<bool>& stop,
                 const Prepared& prepared) { return load(manifest, stop, prepared); },
          executor_events()) {}

void BandPipeline::stop(TaskId task) {
  executor_.stop(task);
  uploader_.drop(task);
}

absl::StatusOr<std::shared_ptr<const Scene>> BandPipeline::load(const wire::Digest& manifest,
                                                                const std::atomic<bool>& stop,
                                                                const Prepared& prepared) {
  const std::string name = manifest.hex().substr(0, 12);
  spdlog::info("scene {}: loading", name);
  const TransferBlob transfer = [this](const wire::Digest& digest, std::uint64_t offset,
                                       const TakeBytes& take) {
    return calls_.get_blob(digest, offset, take);
  };
  FetchingSource blobs(*cache_, transfer, stop, prepared);
  ASSIGN_OR_RETURN(std::shared_ptr<const Scene> scene, loader_.load(manifest, blobs));
  spdlog::info("scene {}: ready", name);
  return scene;
}

ExecutorEvents BandPipeline::executor_events() {
  return {.preparing = [this](TaskId task,
                              std::uint64_t prepared) { session_.preparing(task, prepared); },
          .rendering = [this](TaskId task,
                              std::uint32_t rows_done) { session_.rendering(task, rows_done); },
          .finished =
              [this](FinishedBand band) {
                if (session_.finished(band.task.id)) {
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

void BandPipeline::failed(TaskId task, const absl::Status& status) {
  session_.failed(task, text_of(status), log_tail_ ? log_tail_() : std::vector<std::string>());
}

absl::StatusOr<farm::PutBandReply::Outcome> BandPipeline::put(const FinishedBand& band) {
  ASSIGN_OR_RETURN(const LeaseName lease, session_.lease_of(band.task.id));
  absl::StatusOr<farm::PutBandReply::Outcome> outcome = calls_.put_band(band, lease);
  if (!outcome.ok()) {
    spdlog::warn("could not send {}: {}", name_of(band.task), text_of(outcome.status()));
  } else if (*outcome == farm::PutBandReply::OUTCOME_UNWANTED) {
    spdlog::info("unwanted {}", name_of(band.task));
  } else {
    spdlog::info("stored {}", name_of(band.task));
  }
  return outcome;
}

void BandPipeline::settled(TaskId task,
                           const absl::StatusOr<farm::PutBandReply::Outcome>& outcome) {
  if (outcome.ok()) {
    session_.settled(task);
  } else {
    failed(task, outcome.status());
  }
}

}  // namespace bandsaw::worker
