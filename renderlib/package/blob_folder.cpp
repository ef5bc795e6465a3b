// Checks the digest of a blob's file and maps it into memory.

#include "renderlib/package/blob_folder.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <utility>
#include <vector>

#include "absl/status/status.h"
#include "absl/strings/str_cat.h"
#include "renderlib/base/mapped_file.h"
#include "renderlib/base/status_macros.h"

namespace bandsaw {
namespace {

class MappedBytes : public BlobBytes {
 public:
  explicit MappedBytes(MappedFile file) : file_(std::move(file)) {}
  absl::Span<const std::byte> bytes() const override { return file_.bytes(); }

 private:
  MappedFile file_;
};

}  // namespace

absl::StatusOr<wire::Digest> digest_of_file(int fd, std::uint64_t size, const std::string& path) {
  wire::Hasher hasher;
  std::vector<std::byte> buffer(std::min<std::uint64_t>(size, 1 << 20));
  for (std::uint64_t at = 0; at < size;) {
    const std::size_t wanted = std::min<std::uint64_t>(buffer.size(), size - at);
    const ssize_t got = pread(fd, buffer.data(), wanted, static_cast<off_t>(at));
    if (got < 0 && errno == EINTR) {
      continue;
    }
    if (got <= 0) {
      return absl::DataLossError(errno_status(got < 0 ? errno : EIO, path).message());
    }
    hasher.update(absl::MakeConstSpan(buffer.data(), static_cast<std::size_t>(got)));
    at += static_cast<std::uint64_t>(got);
  }
  return hasher.finish();
}

absl::StatusOr<std::unique_ptr<BlobBytes>> map_blob(const File& file) {
  ASSIGN_OR_RETURN(MappedFile mapped, MappedFile::map(file));
  return std::make_unique<MappedBytes>(std::move(mapped));
}

absl::StatusOr<std::unique_ptr<BlobBytes>> BlobFolder::get(const wire::Digest& digest) {
  const std::string path = path_of(digest);
  absl::StatusOr<File> opened = File::open_regular(path, O_NOFOLLOW);
  if (absl::IsInvalidArgument(opened.status())) {
    return absl::DataLossError(absl::StrCat(opened.status().message(), "; remove it"));
  }
  ASSIGN_OR_RETURN(const File file, std::move(opened));
  ASSIGN_OR_RETURN(const std::uint64_t size, file.size());
  const absl::StatusOr<wire::Digest> found = digest_of_file(file.fd(), size, path);
  if (!found.ok()) {
    return absl::DataLossError(absl::StrCat("blob ", found.status().message(), "; remove it"));
  }
  if (*found != digest) {
    return absl::DataLossError(absl::StrCat(
        "blob ", path, " is damaged: its bytes do not have the digest that names it; remove it"));
  }
  return map_blob(file);
}

}  // namespace bandsaw
