#include "worker/session/farm_calls.h"

#include <span>

#include "worker/session/band_stream.h"

namespace bandsaw::worker {
namespace {

// Sufficient for a slow connection; an interrupted transfer resumes at its offset.
constexpr std::chrono::milliseconds kTransferDeadline{60'000};

absl::Status not_connected() { return absl::UnavailableError("not connected"); }

}  // namespace

FarmCalls::FarmCalls(link::JoinString join, std::string instance)
    : join_(std::move(join)), instance_(std::move(instance)) {}

FarmCalls::~FarmCalls() = default;

void FarmCalls::set_channel(std::shared_ptr<grpc::Channel> bulk) {
  MutexLock lock(mutex_);
  bulk_ = std::move(bulk);
}

void FarmCalls::leave() {
  MutexLock lock(mutex_);
  left_ = true;
  for (grpc::ClientContext* context : open_) {
    context->TryCancel();
  }
}

FarmCalls::Context::Context(FarmCalls& calls, std::chrono::milliseconds deadline) : calls_(calls) {
  link::prepare(context_, calls.join_, deadline);
  MutexLock lock(calls_.mutex_);
  calls_.open_.insert(&context_);
  if (calls_.left_) {
    context_.TryCancel();
  }
}

FarmCalls::Context::~Context() {
  MutexLock lock(calls_.mutex_);
  calls_.open_.erase(&context_);
}

std::shared_ptr<grpc::Channel> FarmCalls::bulk() {
  MutexLock lock(mutex_);
  return bulk_;
}

absl::Status FarmCalls::get_blob(const wire::Digest& digest, std::uint64_t offset,
                                 const TakeBytes& take) {
  const std::shared_ptr<grpc::Channel> channel = bulk();
  if (channel == nullptr) {
    return not_connected();
  }
  const std::unique_ptr<farm::Work::Stub> stub = farm::Work::NewStub(channel);
  farm::GetBlobRequest request;
  request.set_sha256(digest.raw());
  request.set_offset(offset);
  Context context(*this, kTransferDeadline);
  const std::unique_ptr<grpc::ClientReader<farm::BlobChunk>> reader =
      stub->GetBlob(context.get(), request);
  farm::BlobChunk chunk;
  absl::Status status;
  while (status.ok() && reader->Read(&chunk)) {
    if (chunk.offset() != offset) {
      status = absl::DataLossError("the coordinator left out a piece of a blob");
    } else {
      offset += chunk.data().size();
      status = take(std::as_bytes(std::span(chunk.data())));
    }
  }
  if (!status.ok()) {
    (*context).TryCancel();
  }
  const absl::Status end = link::from_grpc(reader->Finish());
  return status.ok() ? end : status;
}

absl::StatusOr<farm::PutBandReply::Outcome> FarmCalls::put_band(const FinishedBand& band,
                                                                const LeaseName& lease) {
  const std::shared_ptr<grpc::Channel> channel = bulk();
  if (bands_ == nullptr || !bands_->serves(channel)) {
    bands_.reset();
    if (channel == nullptr) {
      return not_connected();
    }
    bands_ = std::make_unique<BandStream>(*this, channel);
  }
  auto outcome = bands_->put(band, instance_, lease);
  if (!outcome.ok()) {
    bands_.reset();
  }
  return outcome;
}

}  // namespace bandsaw::worker
