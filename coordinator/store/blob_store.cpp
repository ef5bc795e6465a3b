// A blob is written to a staged file and renamed to its digest when it is complete and correct. An
// upload that is cut leaves its bytes as a partial blob (partial_blobs.h).

#include "coordinator/store/blob_store.h"

#include <fcntl.h>
#include <sys/stat.h>

#include <algorithm>
#include <filesystem>
#include <system_error>

#include "absl/strings/str_cat.h"
#include "proto/wire/limits.h"
#include "renderlib/base/file.h"
#include "renderlib/base/status_macros.h"
#include "renderlib/package/blob_folder.h"

namespace bandsaw::coordinator {
namespace {

constexpr char kStaging[] = "/incoming";

/// Distributes the blobs over 256 folders, so that none becomes very large.
std::string folder_of(const std::string& root, const wire::Digest& digest) {
  return absl::StrCat(root, "/", digest.hex().substr(0, 2));
}
std::string path_of(const std::string& root, const wire::Digest& digest) {
  return absl::StrCat(folder_of(root, digest), "/", digest.hex());
}

}  // namespace

absl::StatusOr<std::unique_ptr<BlobStore>> BlobStore::open(const std::string& folder) {
  ASSIGN_OR_RETURN(auto partials, PartialBlobs::open(folder + kStaging));
  return std::unique_ptr<BlobStore>(new BlobStore(folder, std::move(partials)));
}

bool BlobStore::has(const wire::Digest& digest) const {
  return file_exists(path_of(folder_, digest));
}

std::vector<BlobStore::Stored> BlobStore::list() const {
  std::vector<Stored> all;
  std::error_code error;
  for (std::filesystem::recursive_directory_iterator at(folder_, error), end; !error && at != end;
       at.increment(error)) {
    struct stat found {};
    const auto digest = wire::digest_from_hex(at->path().filename().string());
    if (digest.ok() && ::stat(at->path().c_str(), &found) == 0 && S_ISREG(found.st_mode)) {
      all.push_back({*digest, static_cast<std::uint64_t>(found.st_size),
                     static_cast<double>(found.st_mtim.tv_sec)});
    }
  }
  return all;
}

void BlobStore::touch(const wire::Digest& digest) const {
  ::utimensat(AT_FDCWD, path_of(folder_, digest).c_str(), nullptr, 0);
}

absl::Status BlobStore::remove(const wire::Digest& digest) {
  {
    MutexLock lock(mutex_);
    checked_.erase(digest);
  }
  return remove_file(path_of(folder_, digest));
}

absl::StatusOr<std::unique_ptr<BlobBytes>> BlobStore::get(const wire::Digest& digest) {
  const absl::StatusOr<File> file = File::open_regular(path_of(folder_, digest));
  if (absl::IsNotFound(file.status())) {
    return absl::NotFoundError(absl::StrCat("there is no blob ", digest.hex()));
  }
  RETURN_IF_ERROR(file.status());
  RETURN_IF_ERROR(check(digest, *file));
  return map_blob(*file);
}

absl::Status BlobStore::check(const wire::Digest& digest, const File& file) {
  {
    MutexLock lock(mutex_);
    if (checked_.contains(digest)) {
      return absl::OkStatus();
    }
  }
  ASSIGN_OR_RETURN(const std::uint64_t size, file.size());
  const absl::StatusOr<wire::Digest> found = digest_of_file(file.fd(), size, file.path());
  if (!found.ok() || *found != digest) {
    RETURN_IF_ERROR(remove_file(file.path()));
    return absl::DataLossError(
        absl::StrCat("the file of blob ", digest.hex(),
                     " was damaged and has been removed; submit the scene again"));
  }
  MutexLock lock(mutex_);
  checked_.insert(digest);
  return absl::OkStatus();
}

absl::StatusOr<BlobStore::Writer> BlobStore::write(const wire::Digest& digest, std::uint64_t size,
                                                   std::uint64_t offset) {
  if (size > wire::kBlobBytes) {
    return absl::ResourceExhaustedError(absl::StrCat("blob ", digest.hex(), " has ", size,
                                                     " bytes; at most ", wire::kBlobBytes,
                                                     " are allowed"));
  }
  RETURN_IF_ERROR(make_folder(folder_of(folder_, digest)));
  RETURN_IF_ERROR(sync_folder(folder_));
  std::unique_ptr<PartialBlobs::Claim> claim = partials_->claim(digest);
  absl::StatusOr<StagedFile> file = StagedFile::resume(claim->path(), size, offset);
  if (absl::IsOutOfRange(file.status())) {
    return absl::FailedPreconditionError(
        absl::StrCat("blob ", digest.hex(), ": ", file.status().message(),
                     "; request the number of stored bytes again, and send the rest"));
  }
  RETURN_IF_ERROR(file.status());
  Writer writer(folder_, digest, size, std::move(claim), *std::move(file));
  RETURN_IF_ERROR(writer.take_earlier(offset));
  return writer;
}

BlobStore::Writer::~Writer() {
  if (claim_ != nullptr && claim_->resumable() && intact_ && written_ >= PartialBlobs::kMinBytes) {
    file_.leave(written_);
  }
}

/// Hashes the first `bytes` bytes of the file, which are of an earlier upload. commit() compares
/// the digest of the complete blob.
absl::Status BlobStore::Writer::take_earlier(std::uint64_t bytes) {
  std::vector<std::byte> buffer(std::min<std::uint64_t>(bytes, 1 << 20));
  while (written_ < bytes) {
    const auto piece =
        absl::MakeSpan(buffer).first(std::min<std::uint64_t>(buffer.size(), bytes - written_));
    RETURN_IF_ERROR(file_.read(written_, piece));
    hasher_.update(piece);
    written_ += piece.size();
  }
  earlier_ = bytes;
  return absl::OkStatus();
}

absl::Status BlobStore::Writer::append(absl::Span<const std::byte> bytes) {
  if (bytes.size() > size_ - written_) {
    intact_ = false;
    return absl::InvalidArgumentError(
        absl::StrCat("blob ", digest_.hex(), " is longer than the ", size_, " bytes announced"));
  }
  hasher_.update(bytes);
  const absl::Status status = file_.append(bytes);
  intact_ = intact_ && status.ok();
  written_ += bytes.size();
  return status;
}

absl::Status BlobStore::Writer::commit() {
  intact_ = false;  // after commit there is nothing to resume: the blob is complete or wrong
  if (written_ != size_) {
    return absl::InvalidArgumentError(absl::StrCat(
        "blob ", digest_.hex(), " ended after ", written_, " of the ", size_, " bytes announced"));
  }
  const bool right = hasher_.finish() == digest_;
  if (!right && earlier_ > 0) {
    return absl::DataLossError(absl::StrCat(
        "blob ", digest_.hex(), " has another digest: the ", earlier_,
        " bytes of an earlier upload or the bytes sent now were damaged; all bytes were removed; "
        "send the whole blob again"));
  }
  if (!right) {
    return absl::InvalidArgumentError(
        absl::StrCat("the bytes sent for blob ", digest_.hex(), " have another digest"));
  }
  return file_.commit(folder_of(folder_, digest_), path_of(folder_, digest_));
}

}  // namespace bandsaw::coordinator
