// upload() asks the farm which blobs (parts of the scene) it lacks, and sends them. If an earlier
// upload of a blob was interrupted, only the rest of the blob is sent. The manifest is sent last.

#include "coordinator/cli/farm/upload.h"

#include <algorithm>
#include <map>
#include <span>

#include "coordinator/engine/clock.h"
#include "proto/convert/render_values.h"
#include "proto/link/random.h"
#include "proto/wire/digest.h"
#include "renderlib/base/status_macros.h"

namespace bandsaw::coordinator {
namespace {

// Reports the bytes sent, over all blobs, to the display. `all`: the number of bytes to send.
class Meter {
 public:
  Meter(ProgressDisplay& display, std::uint64_t all) : display_(display), all_(all) {}
  // `of_this_blob`: how many bytes of the blob in progress are sent.
  void sent(std::uint64_t of_this_blob) {
    display_.preparing("sending the scene", before_ + of_this_blob, all_, steady_seconds());
  }
  // `size`: the size of the blob that was in progress, in bytes.
  void finished(std::uint64_t size) { before_ += size; }

 private:
  ProgressDisplay& display_;
  std::uint64_t all_;
  std::uint64_t before_ = 0;  // bytes of the blobs that are finished
};

}  // namespace

absl::Status upload(FarmClient& client, ImportedPackage& package, ProgressDisplay& display) {
  ASSIGN_OR_RETURN(std::vector<BlobRef> blobs, package_blobs(package.manifest()));
  const wire::Digest manifest = wire::sha256(package.manifest());
  std::vector<wire::Digest> digests = {manifest};
  for (const BlobRef& blob : blobs) {
    digests.push_back(blob.digest);
  }
  ASSIGN_OR_RETURN(const std::vector<FarmClient::MissingBlob> lacking,
                   client.missing_blobs(digests));
  // Maps each missing blob to the number of its bytes that the farm already has.
  std::map<wire::Digest, std::uint64_t> missing;
  for (const FarmClient::MissingBlob& blob : lacking) {
    missing[blob.digest] = blob.there;
  }
  std::erase_if(blobs, [&](const BlobRef& blob) { return !missing.contains(blob.digest); });
  std::uint64_t all = missing.contains(manifest) ? package.manifest().size() : 0;
  for (const BlobRef& blob : blobs) {
    all += blob.size;
  }
  Meter meter(display, all);
  for (const BlobRef& blob : blobs) {
    ASSIGN_OR_RETURN(const std::unique_ptr<BlobBytes> bytes, package.blobs().get(blob.digest));
    RETURN_IF_ERROR(client.put_blob(blob.digest, bytes->bytes(), missing[blob.digest],
                                    [&](std::uint64_t sent) { meter.sent(sent); }));
    meter.finished(blob.size);
  }
  if (missing.contains(manifest)) {
    RETURN_IF_ERROR(client.put_blob(manifest, std::as_bytes(std::span(package.manifest())),
                                    missing[manifest],
                                    [&](std::uint64_t sent) { meter.sent(sent); }));
  }
  return absl::OkStatus();
}

farm::SubmitRequest request_for(const ImportedPackage& package, const RenderSettings& settings,
                                const StopRule& stop) {
  farm::SubmitRequest request;
  request.set_request_id(link::random_hex(16));
  request.set_name(package.info().name);
  request.set_manifest_sha256(wire::sha256(package.manifest()).raw());
  *request.mutable_settings() = bandsaw::to_message(settings);
  *request.mutable_stop() = to_message(stop);
  return request;
}

// The farm may delete a blob that no job uses, between its upload and the submission of the job.
// Then submit() returns FAILED_PRECONDITION, and the package is uploaded once more.
absl::StatusOr<JobId> send(FarmClient& client, ImportedPackage& package,
                           const farm::SubmitRequest& request, ProgressDisplay& display) {
  RETURN_IF_ERROR(upload(client, package, display));
  auto job = client.submit(request);
  if (absl::IsFailedPrecondition(job.status())) {
    RETURN_IF_ERROR(upload(client, package, display));
    job = client.submit(request);
  }
  return job;
}

}  // namespace bandsaw::coordinator
