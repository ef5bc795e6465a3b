#include "worker/session/band_stream.h"

#include <algorithm>
#include <span>

#include "proto/convert/render_values.h"
#include "proto/wire/limits.h"
#include "renderlib/render/work_hash.h"

namespace bandsaw::worker {
namespace {

// Every band has at least the second of the two minutes; an interrupted one is sent again.
constexpr std::chrono::milliseconds kDeadline{120'000};
constexpr std::chrono::milliseconds kServes{60'000};

farm::BandHeader header_of(const FinishedBand& band, const std::string& instance,
                           const LeaseName& lease) {
  const BandPixels& pixels = band.pixels;
  const absl::Span<const std::byte> bytes = std::as_bytes(std::span(pixels.sums));
  farm::BandHeader header;
  header.set_job(band.task.job);
  *header.mutable_band() = to_message(pixels.band);
  header.set_lease(lease.lease);
  header.set_epoch(lease.epoch);
  header.set_instance(instance);
  header.set_size(bytes.size());
  header.set_sha256(wire::sha256(bytes).raw());
  header.set_work(work_hash(band.task.manifest.hex(), band.task.settings));
  farm::Counters* counters = header.mutable_counters();
  *counters = to_message(pixels.counters);
  counters->set_render_s(band.cost.render_s);
  counters->set_cpu_s(band.cost.cpu_s);
  return header;
}

}  // namespace

BandStream::BandStream(FarmCalls& calls, std::shared_ptr<grpc::Channel> channel)
    : channel_(std::move(channel)),
      stub_(farm::Work::NewStub(channel_)),
      context_(calls, kDeadline) {
  (*context_).set_initial_metadata_corked(true);  // sent with the first chunk
  stream_ = stub_->PutBands(context_.get());
}

BandStream::~BandStream() {
  if (!finished_) {
    (*context_).TryCancel();
    stream_->Finish();
  }
}

bool BandStream::serves(const std::shared_ptr<grpc::Channel>& channel) const {
  return channel == channel_ && std::chrono::steady_clock::now() - opened_ < kServes;
}

bool BandStream::send(const FinishedBand& band, const std::string& instance,
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

absl::StatusOr<farm::PutBandReply::Outcome> BandStream::put(const FinishedBand& band,
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

}  // namespace bandsaw::worker
