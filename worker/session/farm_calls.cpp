#include "worker/session/farm_calls.h"

#include <algorithm>
#include <span>

#include "proto/wire/limits.h"
#include "renderlib/base/status_macros.h"

namespace bandsaw::worker {
namespace {

// Long enough for a slow line; what breaks off at it goes on from there (blobs) or is sent again
// (bands).
constexpr std::chrono::milliseconds kTransferDeadline{60'000};

farm::BandHeader header_of(const FinishedBand& band, const std::string& instance,
                           const LeaseName& lease) {
  const BandPixels& pixels = band.pixels;
  const absl::Span<const std::byte> bytes = std::as_bytes(std::span(pixels.sums));
  farm::BandHeader header;
  header.set_job(band.task.job);
  header.mutable_band()->set_first_sample(pixels.band.samples.first);
  header.mutable_band()->set_last_sample(pixels.band.samples.last);
  header.mutable_band()->set_first_row(pixels.band.rows.first);
  header.mutable_band()->set_last_row(pixels.band.rows.last);
  header.set_lease(lease.lease);
  header.set_epoch(lease.epoch);
  header.set_instance(instance);
  header.set_size(bytes.size());
  header.set_sha256(wire::sha256(bytes).raw());
  farm::Counters* counters = header.mutable_counters();
  counters->set_rays(pixels.counters.rays);
  counters->set_bad_samples(pixels.counters.bad_samples);
  counters->set_bad_x(pixels.counters.bad_x);
  counters->set_bad_y(pixels.counters.bad_y);
  counters->set_bad_sample(pixels.counters.bad_sample);
  counters->set_negative_samples(pixels.counters.negative_samples);
  counters->set_truncated_paths(pixels.counters.truncated_paths);
  counters->set_dropped_primitives(pixels.counters.dropped_primitives);
  counters->set_render_s(band.cost.render_s);
  counters->set_cpu_s(band.cost.cpu_s);
  return header;
}

}  // namespace

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

absl::StatusOr<std::unique_ptr<farm::Work::Stub>> FarmCalls::stub() {
  MutexLock lock(mutex_);
  if (bulk_ == nullptr) {
    return absl::UnavailableError("not connected");
  }
  return farm::Work::NewStub(bulk_);
}

absl::Status FarmCalls::get_blob(const wire::Digest& digest, std::uint64_t offset,
                                 const TakeBytes& take) {
  ASSIGN_OR_RETURN(const std::unique_ptr<farm::Work::Stub> stub, this->stub());
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
                                                                const std::string& instance,
                                                                const LeaseName& lease) {
  ASSIGN_OR_RETURN(const std::unique_ptr<farm::Work::Stub> stub, this->stub());
  const auto* data = reinterpret_cast<const char*>(band.pixels.sums.data());
  const std::size_t size = band.pixels.sums.size() * sizeof(double);
  farm::BandChunk chunk;
  *chunk.mutable_header() = header_of(band, instance, lease);
  farm::PutBandReply reply;
  Context context(*this, kTransferDeadline);
  (*context).set_initial_metadata_corked(true);  // a small band is one packet, its end with it
  const std::unique_ptr<grpc::ClientWriter<farm::BandChunk>> writer =
      stub->PutBand(context.get(), &reply);
  bool open = true;
  for (std::size_t offset = 0; open && offset < size; offset += wire::kChunkBytes) {
    chunk.set_data(data + offset, std::min(wire::kChunkBytes, size - offset));
    const bool last = size - offset <= wire::kChunkBytes;
    open =
        writer->Write(chunk, last ? grpc::WriteOptions().set_last_message() : grpc::WriteOptions());
    chunk.clear_header();
  }
  RETURN_IF_ERROR(link::from_grpc(writer->Finish()));
  return reply.outcome();
}

}  // namespace bandsaw::worker
