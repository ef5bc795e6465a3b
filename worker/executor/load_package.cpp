// FetchingSource returns blobs from the cache and downloads those that are missing. PackageLoader
// decodes the package and builds its scene, with parts of earlier scenes.

#include "worker/executor/load_package.h"

#include <algorithm>
#include <thread>
#include <utility>

#include "absl/strings/str_cat.h"
#include "proto/wire/limits.h"
#include "renderlib/base/status_macros.h"
#include "renderlib/package/package.h"
#include "worker/executor/backoff.h"
#include "worker/executor/pool_watch.h"

namespace bandsaw::worker {
namespace {

// The interval at which a wait checks `stop`, and whether another worker has finished a download.
constexpr auto kPollInterval = std::chrono::milliseconds(50);
// After this many downloads whose bytes do not have the blob's digest, the blob is not downloaded
// again, because the coordinator itself seems to send wrong bytes.
constexpr int kMaxWrongDownloads = 3;
/// The interval at which the building of a scene reports progress.
constexpr auto kReportInterval = std::chrono::milliseconds(1000);

absl::Status stopped() { return absl::CancelledError("stopped"); }

/// Sleeps for `time`, or until soon after `stop` is set.
void pause(std::chrono::milliseconds time, const std::atomic<bool>& stop) {
  const auto end = std::chrono::steady_clock::now() + time;
  while (!stop && std::chrono::steady_clock::now() < end) {
    std::this_thread::sleep_for(std::min(kPollInterval, time));
  }
}

/// Returns true if the transfer may succeed when it is repeated.
bool is_temporary(const absl::Status& status) {
  return absl::IsUnavailable(status) || absl::IsDeadlineExceeded(status) ||
         absl::IsCancelled(status) || absl::IsAborted(status);
}

}  // namespace

absl::StatusOr<std::unique_ptr<BlobBytes>> FetchingSource::get(const wire::Digest& digest) {
  // A blob may be damaged on disk, or evicted after it was fetched; it is then fetched again.
  for (int attempt = 0;; ++attempt) {
    if (cache_.has(digest)) {
      absl::StatusOr<std::unique_ptr<BlobBytes>> blob = cache_.get(digest);
      if (blob.ok() || attempt == kMaxWrongDownloads ||
          !(absl::IsDataLoss(blob.status()) || absl::IsNotFound(blob.status()))) {
        step(1);
        return blob;
      }
    }
    RETURN_IF_ERROR(fetch(digest));
  }
}

absl::Status FetchingSource::fetch(const wire::Digest& digest) {
  Backoff backoff(digest.bytes[0]);
  int wrong = 0;
  while (!stop_) {
    if (cache_.has(digest)) {
      return absl::OkStatus();
    }
    ASSIGN_OR_RETURN(const std::unique_ptr<BlobCache::Download> partial, cache_.begin(digest));
    if (partial == nullptr) {
      step(1);  // another worker of this machine fetches the blob, which is progress as well
      pause(kPollInterval, stop_);
      continue;
    }
    const std::uint64_t before = partial->offset();
    const absl::Status status = download(digest, *partial);
    if (status.ok()) {
      return status;
    }
    if (absl::IsDataLoss(status) && ++wrong < kMaxWrongDownloads) {
      continue;
    }
    if (!is_temporary(status)) {
      return status;
    }
    if (partial->offset() > before) {
      backoff.reset();
    }
    pause(backoff.next(), stop_);
  }
  return stopped();
}

absl::Status FetchingSource::download(const wire::Digest& digest, BlobCache::Download& partial) {
  const std::uint64_t before = partial.offset();
  const absl::Status status =
      transfer_(digest, before, [&](absl::Span<const std::byte> bytes) -> absl::Status {
        if (stop_) {
          return stopped();
        }
        if (partial.offset() + bytes.size() > wire::kBlobBytes) {
          return absl::InvalidArgumentError(
              absl::StrCat("blob ", digest.hex(), " has more than ", wire::kBlobBytes, " bytes"));
        }
        step(bytes.size());
        return partial.append(bytes);
      });
  if (absl::IsInvalidArgument(status) && before > 0 && partial.offset() == before) {
    partial.discard();  // the partial file is longer than the blob
    return absl::DataLossError(status.message());
  }
  RETURN_IF_ERROR(status);
  return partial.commit();
}

std::vector<std::shared_ptr<const Scene>> PackageLoader::scenes_in_use() {
  std::vector<std::shared_ptr<const Scene>> in_use;
  std::erase_if(scenes_, [&](const std::weak_ptr<const Scene>& scene) {
    std::shared_ptr<const Scene> held = scene.lock();
    if (held == nullptr) {
      return true;
    }
    in_use.push_back(std::move(held));
    return false;
  });
  return in_use;
}

absl::StatusOr<std::shared_ptr<const Scene>> PackageLoader::load(const wire::Digest& manifest,
                                                                 FetchingSource& blobs) {
  ASSIGN_OR_RETURN(const std::unique_ptr<BlobBytes> bytes, blobs.get(manifest));
  if (bytes->bytes().size() > wire::kManifestBytes) {
    return absl::InvalidArgumentError(
        absl::StrCat("the manifest has more than ", wire::kManifestBytes, " bytes"));
  }
  const std::string text(reinterpret_cast<const char*>(bytes->bytes().data()),
                         bytes->bytes().size());
  parts_.forget_unused();
  const std::vector<std::shared_ptr<const Scene>> earlier = scenes_in_use();
  ASSIGN_OR_RETURN(SceneDescription description, decode_package(text, blobs, &parts_));
  const PoolWatch watch(pool_, kReportInterval, [&blobs] { blobs.step(1); });
  ASSIGN_OR_RETURN(std::shared_ptr<const Scene> scene,
                   Scene::build(std::move(description), pool_, /*forced=*/{}, Traversal::kBvh,
                                kernel_, earlier));
  scenes_.push_back(scene);
  return scene;
}

}  // namespace bandsaw::worker
