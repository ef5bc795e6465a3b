#include "coordinator/rpc/put_bands_call.h"

#include "coordinator/rpc/blob_intake.h"
#include "coordinator/rpc/convert.h"
#include "renderlib/base/status_macros.h"

namespace bandsaw::coordinator {
namespace {

farm::PutBandReply::Outcome to_wire(BandOutcome outcome) {
  switch (outcome) {
    case BandOutcome::kStored:
      return farm::PutBandReply::OUTCOME_STORED;
    case BandOutcome::kDuplicate:
      return farm::PutBandReply::OUTCOME_DUPLICATE;
    case BandOutcome::kUnwanted:
      break;
  }
  return farm::PutBandReply::OUTCOME_UNWANTED;
}

}  // namespace

void PutBandsCall::begin() {
  if (const absl::Status status = doors_.streams.add(weak_from_this()); !status.ok()) {
    Finish(link::to_grpc(status));
    return;
  }
  StartRead(&chunk_);
}

void PutBandsCall::done() {
  MutexLock lock(mutex_);
  context_ = nullptr;
}

void PutBandsCall::stop(const absl::Status& why) {
  (void)why;
  MutexLock lock(mutex_);
  if (context_ != nullptr) {
    context_->TryCancel();
  }
}

void PutBandsCall::OnReadDone(bool ok) {
  if (!ok) {
    Finish(last_word());
  } else if (const absl::Status status = take(chunk_); !status.ok()) {
    Finish(link::to_grpc(status));
  }
}

absl::Status PutBandsCall::take(const farm::BandChunk& chunk) {
  RETURN_IF_ERROR(intake_.add(chunk));
  if (!intake_.whole()) {
    StartRead(&chunk_);
    return absl::OkStatus();
  }
  ASSIGN_OR_RETURN(BandPixels pixels, intake_.take());
  const farm::BandHeader header = std::exchange(intake_, {}).header();
  doors_.engine.put_band(header.job(), header.instance(), std::move(pixels),
                         header.counters().render_s(), header.counters().cpu_s(),
                         [self = shared_from_this()](const absl::StatusOr<BandOutcome>& outcome) {
                           self->answer(outcome);
                         });
  return absl::OkStatus();
}

void PutBandsCall::answer(const absl::StatusOr<BandOutcome>& outcome) {
  if (!outcome.ok()) {
    Finish(link::to_grpc(outcome.status()));
    return;
  }
  reply_.set_outcome(to_wire(*outcome));
  StartWrite(&reply_);
}

void PutBandsCall::OnWriteDone(bool ok) {
  if (ok) {
    StartRead(&chunk_);
  } else {
    Finish(grpc::Status::CANCELLED);
  }
}

/// No chunk comes any more.
grpc::Status PutBandsCall::last_word() {
  {
    MutexLock lock(mutex_);
    if (context_->IsCancelled()) {
      return grpc::Status::CANCELLED;
    }
  }
  return link::to_grpc(intake_.cut() ? cut_short(intake_.received(), intake_.header().size())
                                     : absl::OkStatus());
}

}  // namespace bandsaw::coordinator
