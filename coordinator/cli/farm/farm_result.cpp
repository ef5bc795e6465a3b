// FarmClient::result, samples, first_part and preview. Each receives an image in chunks and
// verifies its size and digest.

#include <bit>
#include <cmath>
#include <cstring>
#include <span>
#include <utility>

#include "absl/strings/str_cat.h"
#include "coordinator/cli/farm/farm_client.h"
#include "renderlib/base/status_macros.h"
#include "renderlib/render/settings.h"

namespace bandsaw::coordinator {
namespace {

/// An image as it was received: the fields of the first chunk, and the data of all chunks.
struct Received {
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  std::string sha256;
  std::string bytes;
  double exposure = 0;
  std::uint32_t tone = 0;

  /// Returns the number of bytes that an image of this width and height has.
  std::uint64_t size() const { return std::uint64_t{width} * height * sizeof(Rgb); }
};

// Returns the display settings, or the defaults if one of them is out of range.
Display display_of(const Received& received) {
  const bool known = std::abs(received.exposure) <= kMaxExposure &&
                     received.tone <= static_cast<std::uint32_t>(kLastTone);
  return known ? Display{received.exposure, static_cast<Tone>(received.tone), /*half=*/false}
               : Display();
}

// Converts the bytes to an image. DATA_LOSS: their number or their digest is wrong.
absl::StatusOr<FarmImage> image_of(const Received& received) {
  const absl::Span<const std::byte> span = std::as_bytes(std::span(received.bytes));
  if (received.bytes.size() != received.size() || wire::sha256(span).raw() != received.sha256) {
    return absl::DataLossError(
        "the image was damaged on the network; try again with: bandsaw watch");
  }
  static_assert(std::endian::native == std::endian::little && sizeof(Rgb) == 3 * sizeof(float),
                "the wire format is the memory layout");
  Image image{.width = received.width, .height = received.height, .pixels = {}};
  image.pixels.resize(std::size_t{received.width} * received.height);
  std::memcpy(static_cast<void*>(image.pixels.data()), received.bytes.data(),
              received.bytes.size());
  return FarmImage{std::move(image), display_of(received)};
}

}  // namespace

absl::StatusOr<FarmImage> FarmClient::result(JobId job) {
  farm::GetResultRequest request;
  request.set_job(job);
  return receive(job, [&](auto& context) { return bulk_->GetResult(&context, request); });
}

absl::StatusOr<Image> FarmClient::samples(JobId job) {
  farm::GetResultRequest request;
  request.set_job(job);
  request.set_samples(true);
  ASSIGN_OR_RETURN(FarmImage received, receive(job, [&](auto& context) {
                     return bulk_->GetResult(&context, request);
                   }));
  return std::move(received.image);
}

absl::StatusOr<Image> FarmClient::first_part(JobId job) {
  farm::GetResultRequest request;
  request.set_job(job);
  request.set_first_part(true);
  ASSIGN_OR_RETURN(FarmImage received, receive(job, [&](auto& context) {
                     return bulk_->GetResult(&context, request);
                   }));
  return std::move(received.image);
}

absl::StatusOr<FarmImage> FarmClient::preview(JobId job, std::uint32_t most_side) {
  farm::PreviewRequest request;
  request.set_job(job);
  request.set_most_side(most_side);
  return receive(job, [&](auto& context) { return bulk_->Preview(&context, request); });
}

absl::StatusOr<FarmImage> FarmClient::receive(JobId job, const OpenImage& open) {
  Received received;
  bool too_much = false;
  RETURN_IF_ERROR(call(kNoDeadline, [&](grpc::ClientContext& context) {
    received = Received();
    const auto stream = open(context);
    farm::ResultChunk chunk;
    for (bool first = true; stream->Read(&chunk); first = false) {
      if (first) {
        received.width = chunk.width();
        received.height = chunk.height();
        received.sha256 = chunk.sha256();
        received.exposure = chunk.exposure();
        received.tone = chunk.tone();
        too_much = std::uint64_t{received.width} * received.height > kMaxPixels;
      }
      too_much = too_much || received.bytes.size() + chunk.data().size() > received.size();
      if (too_much) {
        context.TryCancel();
        break;
      }
      received.bytes += chunk.data();
    }
    const grpc::Status status = stream->Finish();
    return too_much ? grpc::Status::OK : status;
  }));
  if (too_much) {
    return absl::DataLossError(absl::StrCat(
        "job ", job,
        ": the farm sent an image that is too large, or more bytes than the image has"));
  }
  return image_of(received);
}

}  // namespace bandsaw::coordinator
