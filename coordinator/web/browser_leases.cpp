// Keeps the leases of each browser. A lease assigns a band (a range of rows and samples) to a
// browser. From the leases it follows which blobs (pieces of scene data) browsers may read, and
// which bands a browser may send.

#include "coordinator/web/browser_leases.h"

#include <algorithm>
#include <utility>

#include "coordinator/engine/blocking_call.h"
#include "proto/convert/render_values.h"
#include "renderlib/base/status_macros.h"
#include "renderlib/package/package.h"

namespace bandsaw::coordinator {
namespace {

/// Number of scenes whose lists of blobs are kept.
constexpr std::size_t kScenesKept = 256;

absl::Status not_leased() {
  return absl::NotFoundError("there is no such blob in the scenes that browsers render now");
}

}  // namespace

void BrowserLeases::add(const std::string& instance, const action::Lease& lease) {
  MutexLock lock(mutex_);
  Leases& leases = browsers_[instance];
  leases.push_back({++leases_, lease.job, lease.band, lease.manifest});
  if (leases.size() > kLeasesOfOne) {
    leases.pop_front();
  }
  if (browsers_.size() > kBrowsers) {
    browsers_.erase(
        std::min_element(browsers_.begin(), browsers_.end(), [](const auto& a, const auto& b) {
          return a.second.back().number < b.second.back().number;
        }));
  }
}

absl::Status BrowserLeases::check(const farm::BandHeader& header) {
  const Band band = band_of(header.band());
  MutexLock lock(mutex_);
  const auto found = browsers_.find(header.instance());
  const bool is_leased =
      found != browsers_.end() &&
      std::any_of(found->second.begin(), found->second.end(), [&](const Lease& one) {
        return one.job == header.job() && one.band.samples == band.samples &&
               one.band.rows.first <= band.rows.first && band.rows.last <= one.band.rows.last;
      });
  return is_leased ? absl::OkStatus()
                   : absl::PermissionDeniedError(
                         "this band was not leased to this browser; say Hello, and send the band "
                         "again if it is leased");
}

std::vector<BrowserLeases::Lease> BrowserLeases::newest() {
  std::map<JobId, Lease> of_jobs;
  {
    MutexLock lock(mutex_);
    for (const auto& [instance, leases] : browsers_) {
      for (const Lease& lease : leases) {
        if (Lease& of_job = of_jobs[lease.job]; of_job.number < lease.number) {
          of_job = lease;
        }
      }
    }
  }
  std::vector<Lease> all;
  for (auto& [job, lease] : of_jobs) {
    all.push_back(std::move(lease));
  }
  std::sort(all.begin(), all.end(),
            [](const Lease& a, const Lease& b) { return a.number > b.number; });
  return all;
}

bool BrowserLeases::runs(JobId job) {
  using View = absl::StatusOr<JobView>;
  const View view = blocking_call<View>([&](auto answer) {
    engine_.watch(job, [answer](View state) {
      answer(std::move(state));
      return false;
    });
  });
  return view.ok() && !is_final(view->state);
}

std::shared_ptr<const BrowserLeases::Blobs> BrowserLeases::blobs_of(const std::string& manifest) {
  {
    MutexLock lock(mutex_);
    if (const auto found = scenes_.find(manifest); found != scenes_.end()) {
      return found->second;
    }
  }
  const absl::StatusOr<wire::Digest> digest = wire::digest_from_hex(manifest);
  const auto bytes = digest.ok() ? engine_.blobs().get(*digest) : digest.status();
  if (!bytes.ok()) {
    return nullptr;
  }
  const auto all = (*bytes)->bytes();
  const auto named =
      package_blobs(std::string(reinterpret_cast<const char*>(all.data()), all.size()));
  if (!named.ok()) {
    return nullptr;
  }
  auto blobs = std::make_shared<Blobs>();
  blobs->insert(manifest);
  for (const BlobRef& blob : *named) {
    blobs->insert(blob.digest.hex());
  }
  MutexLock lock(mutex_);
  if (scenes_.size() >= kScenesKept) {
    scenes_.erase(scenes_.begin());
  }
  return scenes_[manifest] = std::move(blobs);
}

absl::StatusOr<std::unique_ptr<BlobBytes>> BrowserLeases::blob(const wire::Digest& digest) {
  for (const Lease& lease : newest()) {
    const std::shared_ptr<const Blobs> blobs = blobs_of(lease.manifest);
    if (blobs != nullptr && blobs->contains(digest.hex()) && runs(lease.job)) {
      return engine_.blobs().get(digest);
    }
  }
  return not_leased();
}

}  // namespace bandsaw::coordinator
