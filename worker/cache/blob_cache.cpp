// A download writes to a partial file under a lock (flock), and renames it to the digest when it is
// complete. The modification time of a file is the time of its last use.

#include "worker/cache/blob_cache.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <numeric>
#include <tuple>
#include <vector>

#include "absl/strings/str_cat.h"
#include "renderlib/base/atomic_file.h"
#include "renderlib/base/status_macros.h"

namespace bandsaw::worker {
namespace {

/// A file of the cache.
struct Entry {
  std::filesystem::file_time_type used;  ///< time of the last use
  std::string path;
  std::uint64_t bytes = 0;
  friend bool operator<(const Entry& a, const Entry& b) {
    return std::tie(a.used, a.path) < std::tie(b.used, b.path);
  }
};

/// Returns true if the file has a name as the cache gives to its files. The cache removes no other
/// files. So if a user names a wrong folder as the cache, the user's files in the folder are safe.
bool is_ours(const std::filesystem::path& path) {
  const bool whole_or_part = path.extension().empty() || path.extension() == ".part";
  return whole_or_part && wire::digest_from_hex(path.stem().string()).ok();
}

/// Each time that a worker has added 1 / kListings of the size limit, it lists the folder, because
/// other workers may have added files. So a worker does not add much more than this part of the
/// limit before it counts their files.
constexpr std::uint64_t kListings = 16;

/// Lists the cache's files. Files that are removed during the scan are left out.
std::vector<Entry> entries(const std::string& folder) {
  std::vector<Entry> found;
  std::error_code error;
  for (std::filesystem::directory_iterator it(folder, error), end; !error && it != end;
       it.increment(error)) {
    if (!is_ours(it->path())) {
      continue;
    }
    std::error_code gone;
    Entry entry{.used = it->last_write_time(gone), .path = it->path().string()};
    entry.bytes = gone ? 0 : it->file_size(gone);
    if (!gone) {
      found.push_back(std::move(entry));
    }
  }
  return found;
}

/// Returns true if `path` is still the name of the open file `fd`. Another worker may have renamed
/// or removed the file before this worker locked it.
bool is_at(int fd, const std::string& path) {
  struct stat open_file {};
  struct stat named {};
  return fstat(fd, &open_file) == 0 && stat(path.c_str(), &named) == 0 &&
         open_file.st_ino == named.st_ino && open_file.st_dev == named.st_dev;
}

/// Returns true if this errno says that the disk or the user's quota has no bytes or no inodes
/// left. The call that failed may then succeed after files are removed.
bool is_full(int error) { return error == ENOSPC || error == EDQUOT; }

/// Removes a file unless it is being downloaded. If a partial file were removed during its
/// download, another worker could begin a new partial file of the same name. Then the commit of the
/// first download would give the blob's name to this new file, which is incomplete. Returns true if
/// the file was removed.
bool remove_unused(const std::string& path) {
  // NFS grants exclusive locks only on files that are open for writing.
  const int fd = ::open(path.c_str(), O_RDWR | O_CLOEXEC | O_NOFOLLOW);
  if (fd < 0) {
    return false;
  }
  const bool removed =
      flock(fd, LOCK_EX | LOCK_NB) == 0 && is_at(fd, path) && unlink(path.c_str()) == 0;
  close(fd);
  return removed;
}

/// Removes the least recently used files of `all`, except `kept`, until `wanted` bytes are removed
/// or no file is left. Returns the number of bytes removed.
std::uint64_t remove_oldest(std::vector<Entry> all, std::uint64_t wanted, const std::string& kept) {
  std::sort(all.begin(), all.end());
  std::uint64_t freed = 0;
  for (const Entry& entry : all) {
    if (freed >= wanted) {
      break;
    }
    freed += entry.path != kept && remove_unused(entry.path) ? entry.bytes : 0;
  }
  return freed;
}

}  // namespace

BlobCache::BlobCache(std::string folder, std::uint64_t max_bytes)
    : folder_(std::move(folder)), max_bytes_(max_bytes), blobs_(folder_) {}

absl::StatusOr<std::unique_ptr<BlobCache>> BlobCache::open(std::string folder,
                                                           std::uint64_t max_bytes) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error || access(folder.c_str(), R_OK | W_OK | X_OK) != 0) {
    return errno_status(error ? error.value() : errno, absl::StrCat("the cache folder ", folder));
  }
  std::unique_ptr<BlobCache> cache(new BlobCache(std::move(folder), max_bytes));
  std::uint64_t bytes = 0;
  for (const Entry& entry : entries(cache->folder_)) {
    bytes += entry.bytes;
  }
  cache->make_room(bytes, /*newest=*/"");
  return cache;
}

std::string BlobCache::part_path(const wire::Digest& digest) const {
  return absl::StrCat(blobs_.path_of(digest), ".part");
}

bool BlobCache::has(const wire::Digest& digest) const {
  return access(blobs_.path_of(digest).c_str(), R_OK) == 0;
}

absl::StatusOr<std::unique_ptr<BlobBytes>> BlobCache::get(const wire::Digest& digest) {
  absl::StatusOr<std::unique_ptr<BlobBytes>> blob = blobs_.get(digest);
  const std::string path = blobs_.path_of(digest);
  if (blob.ok()) {
    utimensat(AT_FDCWD, path.c_str(), nullptr, 0);  // marks it as used
  } else if (absl::IsDataLoss(blob.status())) {
    unlink(path.c_str());
  }
  return blob;
}

absl::StatusOr<int> BlobCache::open_part(const std::string& path) {
  bool is_folder_made = false;
  while (true) {
    const int fd = ::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0600);
    if (fd >= 0) {
      return fd;
    }
    const int error = errno;
    if (error == ENOENT && !is_folder_made) {
      std::error_code ignored;  // if this fails, opening the file fails again
      std::filesystem::create_directories(folder_, ignored);
      is_folder_made = true;
    } else if (!is_full(error) || !free_space(1)) {
      return errno_status(error, path);
    }
  }
}

absl::StatusOr<std::unique_ptr<BlobCache::Download>> BlobCache::begin(const wire::Digest& digest) {
  const std::string path = part_path(digest);
  ASSIGN_OR_RETURN(const int fd, open_part(path));
  const bool is_taken = flock(fd, LOCK_EX | LOCK_NB) != 0;
  if (is_taken && errno != EWOULDBLOCK) {
    const absl::Status status = errno_status(errno, absl::StrCat("a lock on ", path));
    close(fd);
    return status;
  }
  struct stat info {};
  if (is_taken || !is_at(fd, path) || fstat(fd, &info) != 0) {
    close(fd);
    return std::unique_ptr<Download>();
  }
  return std::make_unique<Download>(*this, digest, fd, static_cast<std::uint64_t>(info.st_size));
}

void BlobCache::make_room(std::uint64_t added, const std::string& newest) {
  MutexLock lock(mutex_);
  bytes_ += added;
  added_ += added;
  if (bytes_ <= max_bytes_ && added_ <= max_bytes_ / kListings) {
    return;
  }
  added_ = 0;
  std::vector<Entry> all = entries(folder_);
  bytes_ = std::accumulate(all.begin(), all.end(), std::uint64_t{0},
                           [](std::uint64_t sum, const Entry& entry) { return sum + entry.bytes; });
  if (bytes_ > max_bytes_) {
    bytes_ -= remove_oldest(std::move(all), bytes_ - max_bytes_, newest);
  }
}

bool BlobCache::free_space(std::uint64_t wanted) {
  constexpr std::uint64_t kAtOnce = 64 << 20;  // so that the folder is not scanned for each chunk
  MutexLock lock(mutex_);
  const std::uint64_t freed =
      remove_oldest(entries(folder_), std::max(wanted, kAtOnce), /*kept=*/"");
  bytes_ -= std::min(bytes_, freed);
  return freed > 0;
}

BlobCache::Download::Download(BlobCache& cache, const wire::Digest& digest, int fd,
                              std::uint64_t offset)
    : cache_(cache), digest_(digest), fd_(fd), offset_(offset) {}

BlobCache::Download::~Download() { close(fd_); }

absl::Status BlobCache::Download::append(absl::Span<const std::byte> bytes) {
  while (!bytes.empty()) {
    const ssize_t written = pwrite(fd_, bytes.data(), bytes.size(), static_cast<off_t>(offset_));
    if (written < 0 && errno != EINTR) {
      const int error = errno;
      if (is_full(error) && cache_.free_space(bytes.size())) {
        continue;
      }
      return errno_status(error, absl::StrCat("the cache folder ", cache_.folder_));
    }
    if (written > 0) {
      offset_ += static_cast<std::uint64_t>(written);
      bytes.remove_prefix(static_cast<std::size_t>(written));
    }
  }
  return absl::OkStatus();
}

absl::Status BlobCache::Download::commit() {
  const std::string part = cache_.part_path(digest_);
  const absl::StatusOr<wire::Digest> received = digest_of_file(fd_, offset_, part);
  if (!received.ok() || *received != digest_) {
    discard();
    RETURN_IF_ERROR(received.status());
    return absl::DataLossError(
        absl::StrCat("the received bytes of blob ", digest_.hex(), " do not have that digest"));
  }
  const std::string path = cache_.blobs_.path_of(digest_);
  if (rename(part.c_str(), path.c_str()) != 0) {
    // A user who needed space has removed the partial file. The caller fetches the blob again.
    return absl::UnavailableError(errno_status(errno, part).message());
  }
  cache_.make_room(offset_, path);
  return absl::OkStatus();
}

void BlobCache::Download::discard() { unlink(cache_.part_path(digest_).c_str()); }

}  // namespace bandsaw::worker
