// Handles the messages of workers to the scheduler's thread, and the store's answers about the
// bands (the pixels of some rows and samples) of the workers.

#include <spdlog/spdlog.h>

#include <utility>

#include "absl/strings/str_cat.h"
#include "coordinator/engine/scheduler_thread.h"
#include "coordinator/scheduler/api/worker_process.h"

namespace bandsaw::coordinator {
namespace {

/// Checks a band that a worker sent. `tiles`: how many samples each half tile of the band takes. A
/// half tile has half of the pixels of a square of 16 x 16. INVALID_ARGUMENT: it is not a band of
/// an image with these settings, some of its pixels are missing, or its pixels or counters
/// contradict `tiles`.
absl::Status check_band(const BandPixels& pixels, const RenderSettings& settings,
                        const TileSamples& tiles) {
  if (absl::Status valid = validate(pixels.band, settings); !valid.ok()) {
    return valid;
  }
  const std::size_t sums = std::size_t{pixels.band.rows.count()} * settings.width * 3;
  if (pixels.width != settings.width || pixels.sums.size() != sums) {
    return absl::InvalidArgumentError(
        absl::StrCat("the band has ", pixels.sums.size(), " sums in rows of ", pixels.width,
                     " pixels; it must have ", sums, " sums in rows of ", settings.width));
  }
  absl::Status valid = check_left_out(pixels, tiles);
  valid.Update(check_counters(pixels, tiles));
  return valid;
}

}  // namespace

void SchedulerThread::hello(SessionId session, std::shared_ptr<WorkerLink> link,
                            WorkerHello hello) {
  links_.add(session, std::move(link), hello);
  run(input::Hello{.session = session, .worker = std::move(hello)});
}

void SchedulerThread::lost(SessionId session, std::string reason) {
  links_.lost(session, reason);
  run(input::SessionEnded{.session = session, .reason = std::move(reason)});
}

void SchedulerThread::add_worker_log(SessionId session, std::vector<std::string> lines) {
  if (const std::string name = links_.name(session); !name.empty()) {
    logs_.add(name, std::move(lines));
  }
}

void SchedulerThread::put_band(IncomingBand incoming) {
  if (incoming.browser && !scheduler_.is_browser(incoming.instance)) {
    incoming.answer(absl::FailedPreconditionError(
        "no browser of this instance has joined; send Hello first, then the band again"));
    return;
  }
  const auto known = known_.find(incoming.job);
  if (known == known_.end() || is_final(known->second.state) ||
      !known->second.spec.may_be(incoming.work)) {
    incoming.answer(BandOutcome::kUnwanted);
    return;
  }
  if (const absl::Status valid = check_band(incoming.pixels, known->second.spec.settings,
                                            scheduler_.tiles(incoming.job, incoming.pixels.band));
      !valid.ok()) {
    incoming.answer(valid);
    return;
  }
  if (!journal_status_.ok()) {
    incoming.answer(journal_status_);
    return;
  }
  incoming.process = worker_process_id(incoming.instance);
  // The rows that the job still wants. Empty: all rows of the band are stored already.
  // std::nullopt: the job is over, or does not need such a band.
  const std::optional<std::vector<RowRange>> wanted =
      scheduler_.wanted(incoming.job, incoming.pixels.band);
  if (!wanted) {
    incoming.answer(BandOutcome::kUnwanted);
  } else if (wanted->empty()) {
    store_.compare(std::move(incoming));
  } else if (!disk_status_.ok()) {
    incoming.answer(disk_status_);
  } else {
    store_.append(std::move(incoming));
  }
}

void SchedulerThread::band_stored(IncomingBand incoming, std::vector<std::uint64_t> row_digests) {
  const Step step = run(input::BandStored{.job = incoming.job,
                                          .band = incoming.pixels.band,
                                          .row_digests = std::move(row_digests),
                                          .instance = incoming.instance,
                                          .counters = incoming.pixels.counters,
                                          .render_s = incoming.render_s,
                                          .cpu_s = incoming.cpu_s,
                                          .written = incoming.written},
                        &incoming);
  const bool added = std::any_of(step.actions.begin(), step.actions.end(), [](const Action& a) {
    return std::holds_alternative<action::AddToFilm>(a);
  });
  const BandOutcome outcome = added                ? BandOutcome::kStored
                              : over(incoming.job) ? BandOutcome::kUnwanted
                                                   : BandOutcome::kDuplicate;
  commit_queue_.completion(
      [outcome, answer = std::move(incoming.answer)](const absl::Status& journalled) mutable {
        if (journalled.ok()) {
          answer(outcome);
        } else {
          answer(absl::ResourceExhaustedError(journalled.message()));
        }
      });
}

void SchedulerThread::band_failed(IncomingBand incoming, const absl::Status& status) {
  if (over(incoming.job)) {
    incoming.answer(BandOutcome::kUnwanted);
    return;
  }
  storage_failed(incoming.job, status);
  incoming.answer(absl::ResourceExhaustedError(
      absl::StrCat("the coordinator cannot keep the band now: ", status.message())));
}

}  // namespace bandsaw::coordinator
