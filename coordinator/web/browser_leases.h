#pragma once

// Remembers the leases that were given to browsers which render. A lease assigns a band (a range of
// rows and samples of a job's image) to one worker. These leases decide what a holder of the link
// for browsers may do: read the scenes of the leases while their jobs run, and send the bands of
// the leases.

#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "coordinator/engine/engine.h"
#include "proto/farm.pb.h"
#include "proto/wire/digest.h"
#include "proto/wire/limits.h"
#include "renderlib/base/mutex.h"

namespace bandsaw::coordinator {

/// Thread-safe. A browser is identified by the instance id of its Hello. It is remembered after its
/// session has ended, because its bands may still arrive. It is forgotten when kBrowsers other
/// browsers have got leases after it.
class BrowserLeases {
 public:
  /// Maximum numbers of remembered browsers and of remembered leases of each browser. Both are
  /// greater than the numbers that can be in use at a time.
  static constexpr std::size_t kBrowsers = 1024;
  static constexpr std::size_t kLeasesOfOne = 2 * wire::kBandsPerWorker;

  /// `engine` outlives the object.
  explicit BrowserLeases(Engine& engine) : engine_(engine) {}

  /// Notes a lease that is given to a browser.
  void add(const std::string& instance, const action::Lease& lease) EXCLUDES(mutex_);

  /// Checks a band that a browser sends. PERMISSION_DENIED: the browser was given no lease of this
  /// job that has the same samples and contains these rows.
  absl::Status check(const farm::BandHeader& header) EXCLUDES(mutex_);

  /// Returns a blob of a scene that was leased to a browser and whose job is not over. NOT_FOUND:
  /// any other digest. Waits for the disk and the engine.
  absl::StatusOr<std::unique_ptr<BlobBytes>> blob(const wire::Digest& digest) EXCLUDES(mutex_);

 private:
  struct Lease {
    std::uint64_t number = 0;  ///< counts the leases of all browsers
    JobId job = 0;
    Band band;
    std::string manifest;  ///< in hexadecimal
  };
  using Leases = std::deque<Lease>;  ///< the leases of one browser, at least one, the newest last
  using Blobs = std::set<std::string>;  ///< digests in hexadecimal

  /// Returns the newest lease of each job, sorted from new to old.
  std::vector<Lease> newest() EXCLUDES(mutex_);
  /// Returns true if the job exists and is not over. Waits for the engine.
  bool runs(JobId job);
  /// Returns the digests of the blobs that a manifest names, and of the manifest itself; nullptr:
  /// the manifest is not stored or cannot be read.
  std::shared_ptr<const Blobs> blobs_of(const std::string& manifest) EXCLUDES(mutex_);

  Engine& engine_;
  Mutex mutex_;
  std::uint64_t leases_ GUARDED_BY(mutex_) = 0;                ///< number of leases that were noted
  std::map<std::string, Leases> browsers_ GUARDED_BY(mutex_);  ///< by instance
  std::map<std::string, std::shared_ptr<const Blobs>> scenes_ GUARDED_BY(mutex_);  ///< by manifest
};

}  // namespace bandsaw::coordinator
