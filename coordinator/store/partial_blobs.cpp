// A partial blob is a file named by the digest of the whole blob. While an upload writes to the
// file, a Claim holds it. A second upload of the same blob at that time gets another file.

#include "coordinator/store/partial_blobs.h"

#include <sys/stat.h>

#include <algorithm>
#include <filesystem>
#include <system_error>
#include <tuple>
#include <vector>

#include "absl/strings/str_cat.h"
#include "proto/wire/limits.h"
#include "renderlib/base/file.h"
#include "renderlib/base/status_macros.h"

namespace bandsaw::coordinator {
namespace {

constexpr char kSuffix[] = ".part";

struct Partial {
  std::string path;
  std::uint64_t size = 0;
  double written_at = 0;  ///< seconds since 1970
};

bool is_partial(const std::filesystem::path& path) {
  return path.extension() == kSuffix && wire::digest_from_hex(path.stem().string()).ok();
}

/// Returns the paths in a folder; none, or only some, if it cannot be read. Does not throw, unlike
/// a range over directory_iterator.
std::vector<std::filesystem::path> paths_in(const std::string& folder) {
  std::vector<std::filesystem::path> paths;
  std::error_code error;
  for (std::filesystem::directory_iterator entry(folder, error), end; !error && entry != end;
       entry.increment(error)) {
    paths.push_back(entry->path());
  }
  return paths;
}

/// Returns the partial blobs in the folder, the newest first.
std::vector<Partial> partials_in(const std::string& folder) {
  std::vector<Partial> all;
  for (const std::filesystem::path& path : paths_in(folder)) {
    struct stat found {};
    if (is_partial(path) && ::stat(path.c_str(), &found) == 0) {
      all.push_back({path.string(), static_cast<std::uint64_t>(found.st_size),
                     static_cast<double>(found.st_mtim.tv_sec) + 1e-9 * found.st_mtim.tv_nsec});
    }
  }
  std::sort(all.begin(), all.end(), [](const Partial& a, const Partial& b) {
    return std::tie(a.written_at, a.path) > std::tie(b.written_at, b.path);
  });
  return all;
}

}  // namespace

absl::StatusOr<std::unique_ptr<PartialBlobs>> PartialBlobs::open(const std::string& folder) {
  RETURN_IF_ERROR(make_folder(folder));
  for (const std::filesystem::path& path : paths_in(folder)) {
    if (std::error_code error; !is_partial(path)) {
      std::filesystem::remove_all(path, error);
    }
  }
  return std::unique_ptr<PartialBlobs>(new PartialBlobs(folder));
}

std::string PartialBlobs::path_of(const wire::Digest& digest) const {
  return absl::StrCat(folder_, "/", digest.hex(), kSuffix);
}

std::uint64_t PartialBlobs::size(const wire::Digest& digest) const {
  const std::string path = path_of(digest);
  MutexLock lock(mutex_);
  struct stat found {};
  return claimed_.contains(path) || ::stat(path.c_str(), &found) != 0
             ? 0
             : static_cast<std::uint64_t>(found.st_size);
}

std::unique_ptr<PartialBlobs::Claim> PartialBlobs::claim(const wire::Digest& digest) {
  const std::string own = path_of(digest);
  MutexLock lock(mutex_);
  const bool is_own = claimed_.insert(own).second;
  return std::make_unique<Claim>(*this, is_own ? own : absl::StrCat(folder_, "/", ++others_),
                                 is_own);
}

PartialBlobs::Claim::~Claim() { all_.release(*this); }

void PartialBlobs::release(const Claim& claim) {
  MutexLock lock(mutex_);
  if (claim.resumable()) {
    claimed_.erase(claim.path());
    trim();
  }
}

void PartialBlobs::trim() {
  std::size_t count = 0;
  std::uint64_t bytes = 0;
  for (const Partial& partial : partials_in(folder_)) {
    if (claimed_.contains(partial.path)) {
      continue;
    }
    if (count == wire::kPartialBlobs || bytes + partial.size > wire::kPartialBytes) {
      remove_file(partial.path).IgnoreError();
    } else {
      ++count;
      bytes += partial.size;
    }
  }
}

void PartialBlobs::remove_unused(double now, double seconds) {
  MutexLock lock(mutex_);
  for (const Partial& partial : partials_in(folder_)) {
    if (!claimed_.contains(partial.path) && now - partial.written_at > seconds) {
      remove_file(partial.path).IgnoreError();
    }
  }
}

}  // namespace bandsaw::coordinator
