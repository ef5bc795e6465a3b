#include "coordinator/cli/serve/import_and_store.h"

#include <span>

#include "coordinator/cli/scene/import_process.h"
#include "proto/wire/digest.h"
#include "renderlib/base/status_macros.h"

namespace bandsaw::coordinator {
namespace {

/// Shorter than for a command, because a user waits in a browser.
constexpr double kPatience_s = 120;
constexpr std::size_t kPieceBytes = 16 << 20;

absl::Status store(Engine& engine, const wire::Digest& digest, absl::Span<const std::byte> bytes) {
  if (engine.has_blob(digest)) {
    return absl::OkStatus();
  }
  ASSIGN_OR_RETURN(const auto writer, engine.write_blob(digest, bytes.size()));
  for (std::size_t at = 0; at < bytes.size(); at += kPieceBytes) {
    RETURN_IF_ERROR(writer->append(bytes.subspan(at, kPieceBytes)));
  }
  return writer->commit();
}

}  // namespace

ImportScene import_and_store(Engine& engine) {
  return [&engine](const std::string& path,
                   const std::atomic<bool>& stop) -> absl::StatusOr<SceneOnFarm> {
    ImportLimits limits;
    limits.seconds = kPatience_s;
    limits.stop = &stop;
    ASSIGN_OR_RETURN(ImportedPackage package, import_in_process(path, limits));
    ASSIGN_OR_RETURN(const std::vector<BlobRef> blobs, package_blobs(package.manifest()));
    for (const BlobRef& blob : blobs) {
      ASSIGN_OR_RETURN(const std::unique_ptr<BlobBytes> bytes, package.blobs().get(blob.digest));
      RETURN_IF_ERROR(store(engine, blob.digest, bytes->bytes()));
    }
    const std::string& manifest = package.manifest();
    const wire::Digest digest = wire::sha256(manifest);
    RETURN_IF_ERROR(store(engine, digest, std::as_bytes(std::span(manifest))));
    return SceneOnFarm{digest.hex(), package.info()};
  };
}

}  // namespace bandsaw::coordinator
