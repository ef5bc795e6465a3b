// Each call registers its gRPC context, so that leave() can cancel it. Bands are sent on one stream
// that is kept open for a minute. An instance is the id that this worker process has chosen for
// itself. The bulk channel carries blobs and pixels, and no heartbeats.

#include "worker/session/farm_calls.h"

#include <algorithm>
#include <chrono>
#include <memory>
#include <span>

#include "proto/wire/limits.h"
#include "worker/session/band_header.h"

namespace bandsaw::worker {
namespace {

// kDeadline: the deadline of a stream of bands, from its opening. kMaxStreamAge: the age up to
// which a stream takes a further band. So there is at least a minute for the transfer of each band.
// A band whose transfer is interrupted is sent again.
constexpr std::chrono::milliseconds kDeadline{120'000};
constexpr std::chrono::milliseconds kMaxStreamAge{60'000};

farm::BandHeader header_of(const FinishedBand& band, const std::string& instance,
                           const LeaseName& lease) {
  const absl::Span<const std::byte> bytes = std::as_bytes(std::span(band.pixels.sums));
  return band_header(band.task, {.size = bytes.size(), .digest = wire::sha256(bytes)},
                     band.pixels.counters, band.cost, instance, lease);
}

// The deadline of one transfer of a blob. It is sufficient for a slow connection, because the next
// transfer continues where an interrupted transfer has ended.
constexpr std::chrono::milliseconds kTransferDeadline{60'000};

absl::Status not_connected() { return absl::UnavailableError("not connected"); }

}  // namespace

/// A Work.PutBands call that is used for a minute, because opening a call costs more than sending a
/// small band.
class FarmCalls::BandStream {
 public:
  /// `calls` MUST outlive the stream.
  BandStream(FarmCalls& calls, std::shared_ptr<grpc::Channel> channel);
  /// Cancels a transfer in progress.
  ~BandStream();

  /// Returns true if the next band may be sent on this stream: it was opened on this channel, and
  /// the time to its deadline is sufficient for a slow connection.
  bool serves(const std::shared_ptr<grpc::Channel>& channel) const;

  /// Sends a band and waits for the coordinator's answer. After an error the stream must not be
  /// used again.
  absl::StatusOr<farm::PutBandReply::Outcome> put(const FinishedBand& band,
                                                  const std::string& instance,
                                                  const LeaseName& lease);

 private:
  /// Returns false if the stream is broken.
  bool send(const FinishedBand& band, const std::string& instance, const LeaseName& lease);

  const std::shared_ptr<grpc::Channel> channel_;
  const std::unique_ptr<farm::Work::Stub> stub_;
  const std::chrono::steady_clock::time_point opened_ = std::chrono::steady_clock::now();
  FarmCalls::Context context_;
  std::unique_ptr<grpc::ClientReaderWriter<farm::BandChunk, farm::PutBandReply>> stream_;
  bool finished_ = false;
};

FarmCalls::BandStream::BandStream(FarmCalls& calls, std::shared_ptr<grpc::Channel> channel)
    : channel_(std::move(channel)),
      stub_(farm::Work::NewStub(channel_)),
      context_(calls, kDeadline) {
  (*context_).set_initial_metadata_corked(true);  // sent with the first chunk
  stream_ = stub_->PutBands(context_.get());
}

FarmCalls::BandStream::~BandStream() {
  if (!finished_) {
    (*context_).TryCancel();
    stream_->Finish();
  }
}

bool FarmCalls::BandStream::serves(const std::shared_ptr<grpc::Channel>& channel) const {
  return channel == channel_ && std::chrono::steady_clock::now() - opened_ < kMaxStreamAge;
}

bool FarmCalls::BandStream::send(const FinishedBand& band, const std::string& instance,
                                 const LeaseName& lease) {
  const auto* data = reinterpret_cast<const char*>(band.pixels.sums.data());
  const std::size_t size = band.pixels.sums.size() * sizeof(double);
  farm::BandChunk chunk;
  *chunk.mutable_header() = header_of(band, instance, lease);
  bool open = true;
  for (std::size_t offset = 0; open && offset < size; offset += wire::kChunkBytes) {
    chunk.set_data(data + offset, std::min(wire::kChunkBytes, size - offset));
    open = stream_->Write(chunk);
    chunk.clear_header();
  }
  return open;
}

absl::StatusOr<farm::PutBandReply::Outcome> FarmCalls::BandStream::put(const FinishedBand& band,
                                                                       const std::string& instance,
                                                                       const LeaseName& lease) {
  farm::PutBandReply reply;
  if (send(band, instance, lease) && stream_->Read(&reply)) {
    return reply.outcome();
  }
  finished_ = true;
  const absl::Status why = link::from_grpc(stream_->Finish());
  return why.ok() ? absl::UnavailableError("the coordinator ended the stream of bands") : why;
}

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
