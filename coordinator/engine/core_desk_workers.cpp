#include <spdlog/spdlog.h>

#include <utility>

#include "absl/strings/str_cat.h"
#include "coordinator/engine/core_desk.h"
#include "coordinator/scheduler/api/worker_process.h"

namespace bandsaw::coordinator {
namespace {

/// INVALID_ARGUMENT: not a band of an image of these settings, or not all of its pixels.
absl::Status check_band(const BandPixels& pixels, const RenderSettings& settings,
                        const TileSamples& tiles) {
  if (absl::Status valid = validate(pixels.band, settings); !valid.ok()) {
    return valid;
  }
  const std::size_t sums = std::size_t{pixels.band.rows.count()} * settings.width * 3;
  if (pixels.width != settings.width || pixels.sums.size() != sums) {
    return absl::InvalidArgumentError(
        absl::StrCat("the band's pixels are ", pixels.sums.size(), " sums of rows of ",
                     pixels.width, " pixels; it must be ", sums, " of ", settings.width));
  }
  absl::Status valid = check_left_out(pixels, tiles);
  valid.Update(check_counters(pixels, tiles));
  return valid;
}

}  // namespace

void CoreDesk::hello(SessionId session, std::shared_ptr<WorkerLink> link, WorkerHello hello) {
  links_.add(session, std::move(link), hello);
  run(input::Hello{.session = session, .worker = std::move(hello)});
}

void CoreDesk::lost(SessionId session, std::string reason) {
  links_.lost(session, reason);
  run(input::SessionEnded{.session = session, .reason = std::move(reason)});
}

void CoreDesk::worker_log(SessionId session, std::vector<std::string> lines) {
  if (const std::string name = links_.name(session); !name.empty()) {
    logs_.add(name, std::move(lines));
  }
}

void CoreDesk::put_band(PutBand put) {
  const auto known = known_.find(put.job);
  if (known == known_.end() || is_final(known->second.state) ||
      !known->second.spec.may_be(put.work)) {
    put.answer(BandOutcome::kUnwanted);
    return;
  }
  if (const absl::Status valid = check_band(put.pixels, known->second.spec.settings,
                                            core_.tiles(put.job, put.pixels.band));
      !valid.ok()) {
    put.answer(valid);
    return;
  }
  if (!journal_status_.ok()) {
    put.answer(journal_status_);
    return;
  }
  put.renderer = worker_process_id(put.instance);
  const std::optional<std::vector<RowRange>> wanted = core_.wanted(put.job, put.pixels.band);
  if (!wanted) {
    put.answer(BandOutcome::kUnwanted);
  } else if (wanted->empty()) {
    hooks_.compare_band(std::move(put));
  } else if (!room_.ok()) {
    put.answer(room_);
  } else {
    hooks_.store_band(std::move(put));
  }
}

void CoreDesk::band_stored(PutBand put, std::vector<std::uint64_t> row_digests) {
  const Step step = run(input::BandStored{.job = put.job,
                                          .band = put.pixels.band,
                                          .row_digests = std::move(row_digests),
                                          .instance = put.instance,
                                          .counters = put.pixels.counters,
                                          .render_s = put.render_s,
                                          .cpu_s = put.cpu_s,
                                          .written = put.written},
                        &put);
  const bool added = std::any_of(step.actions.begin(), step.actions.end(), [](const Action& a) {
    return std::holds_alternative<action::AddToFilm>(a);
  });
  const BandOutcome outcome = added           ? BandOutcome::kStored
                              : over(put.job) ? BandOutcome::kUnwanted
                                              : BandOutcome::kDuplicate;
  outbox_.reply([outcome, answer = std::move(put.answer)](const absl::Status& journalled) mutable {
    if (journalled.ok()) {
      answer(outcome);
    } else {
      answer(absl::ResourceExhaustedError(journalled.message()));
    }
  });
}

void CoreDesk::band_failed(PutBand put, const absl::Status& status) {
  if (over(put.job)) {
    put.answer(BandOutcome::kUnwanted);
    return;
  }
  storage_failed(put.job, status);
  put.answer(absl::ResourceExhaustedError(
      absl::StrCat("the coordinator cannot keep the band now: ", status.message())));
}

}  // namespace bandsaw::coordinator
