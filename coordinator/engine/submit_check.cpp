// Checks the fields of a job. Then reads the manifest of its package, and checks that every blob
// that the manifest lists is stored.

#include "coordinator/engine/submit_check.h"

#include <cmath>
#include <string>

#include "absl/strings/str_cat.h"
#include "proto/wire/digest.h"
#include "proto/wire/limits.h"
#include "renderlib/base/clean_text.h"
#include "renderlib/base/status_macros.h"
#include "renderlib/package/package.h"

namespace bandsaw::coordinator {
namespace {

/// Length of a request id (proto/farm.proto).
constexpr std::size_t kMinRequestId = 16;
constexpr std::size_t kMaxRequestId = 64;

absl::Status check_samples(const char* name, std::uint64_t samples) {
  if (samples < 1 || samples > kMaxSamples) {
    return absl::InvalidArgumentError(
        absl::StrCat("stop.", name, " must be in [1, ", kMaxSamples, "], found ", samples));
  }
  return absl::OkStatus();
}

absl::Status check_positive(const char* name, double value) {
  if (!std::isfinite(value) || value <= 0) {
    return absl::InvalidArgumentError(
        absl::StrCat("stop.", name, " must be finite and greater than 0, found ", value));
  }
  return absl::OkStatus();
}

absl::Status check_stop(const StopRule& stop) {
  if (const auto* samples = std::get_if<StopAtSamples>(&stop)) {
    return check_samples("samples", samples->samples);
  }
  if (const auto* error = std::get_if<StopAtError>(&stop)) {
    RETURN_IF_ERROR(check_positive("error", error->relative_rmse));
    return check_samples("max_samples", error->max_samples);
  }
  const auto& time = std::get<StopAtTime>(stop);
  RETURN_IF_ERROR(check_positive("time_s", time.seconds));
  return check_samples("max_samples", time.max_samples);
}

/// Checks the length of the request id, and that the name is short and clean text.
absl::Status check_words(const std::string& request_id, const std::string& name) {
  if (request_id.size() < kMinRequestId || request_id.size() > kMaxRequestId) {
    return absl::InvalidArgumentError(absl::StrCat("request_id must have ", kMinRequestId, " to ",
                                                   kMaxRequestId, " characters, found ",
                                                   request_id.size()));
  }
  if (name.size() > wire::kJobNameBytes) {
    return absl::InvalidArgumentError(absl::StrCat("name must have at most ", wire::kJobNameBytes,
                                                   " bytes, found ", name.size()));
  }
  // A message with a name that is not UTF-8 cannot be parsed, and terminals obey control
  // characters.
  if (clean_text(name, wire::kJobNameBytes) != name) {
    return absl::InvalidArgumentError(
        absl::StrCat("name must be UTF-8 without control characters, for example \"",
                     clean_text(name, wire::kJobNameBytes), "\""));
  }
  return absl::OkStatus();
}

/// Returns the manifest with this digest. FAILED_PRECONDITION: it is not stored. INVALID_ARGUMENT:
/// it is too long. Further errors: those of BlobSource::get.
absl::StatusOr<std::string> read_manifest(const DigestHex& hex, BlobSource& blobs) {
  ASSIGN_OR_RETURN(const wire::Digest digest, wire::digest_from_hex(hex));
  const absl::StatusOr<std::unique_ptr<BlobBytes>> blob = blobs.get(digest);
  if (absl::IsNotFound(blob.status())) {
    return absl::FailedPreconditionError(
        absl::StrCat("the package's manifest, blob ", hex, ", is missing; send it first"));
  }
  RETURN_IF_ERROR(blob.status());
  const absl::Span<const std::byte> bytes = (*blob)->bytes();
  if (bytes.size() > wire::kManifestBytes) {
    return absl::InvalidArgumentError(absl::StrCat("a manifest has at most ", wire::kManifestBytes,
                                                   " bytes, found ", bytes.size()));
  }
  return std::string(reinterpret_cast<const char*>(bytes.data()), bytes.size());
}

}  // namespace

absl::Status check_submit(JobSpec& spec, BlobStore& blobs) {
  RETURN_IF_ERROR(check_words(spec.request_id, spec.name));
  RETURN_IF_ERROR(validate(spec.settings));
  RETURN_IF_ERROR(check_stop(spec.stop));
  ASSIGN_OR_RETURN(spec.package_bytes, check_package(spec.manifest, blobs));
  return absl::OkStatus();
}

absl::Status check_sequence(const SequenceSpec& spec) {
  RETURN_IF_ERROR(check_words(spec.request_id, spec.name));
  RETURN_IF_ERROR(validate(spec.settings));
  return check_stop(spec.stop);
}

absl::StatusOr<std::uint64_t> check_package(const DigestHex& digest_hex, BlobStore& blobs) {
  ASSIGN_OR_RETURN(const std::string manifest, read_manifest(digest_hex, blobs));
  RETURN_IF_ERROR(package_info(manifest).status());
  ASSIGN_OR_RETURN(const std::vector<BlobRef> refs, package_blobs(manifest));
  // The manifest and the blobs are marked as used, because the collector must not remove them
  // before the scheduler has the job.
  ASSIGN_OR_RETURN(const wire::Digest manifest_digest, wire::digest_from_hex(digest_hex));
  blobs.touch(manifest_digest);
  std::uint64_t bytes = manifest.size();
  for (const BlobRef& ref : refs) {
    bytes += ref.size;
    blobs.touch(ref.digest);
    if (!blobs.has(ref.digest)) {
      return absl::FailedPreconditionError(absl::StrCat(
          "blob ", ref.digest.hex(), " of the package is missing; send it, then submit again"));
    }
  }
  return bytes;
}

Display display_of(const DigestHex& manifest, BlobSource& blobs) {
  const auto bytes = read_manifest(manifest, blobs);
  const auto info = bytes.ok() ? package_info(*bytes) : bytes.status();
  return info.ok() ? info->display : Display();
}

}  // namespace bandsaw::coordinator
