#include "renderlib/package/blob_folder.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>

#include "absl/cleanup/cleanup.h"
#include "absl/status/status.h"
#include "absl/strings/str_cat.h"
#include "renderlib/base/atomic_file.h"

namespace bandsaw {
namespace {

class MappedBytes : public BlobBytes {
 public:
  MappedBytes(void* data, std::size_t size) : data_(data), size_(size) {}
  ~MappedBytes() override {
    if (size_ != 0) {
      munmap(data_, size_);
    }
  }
  MappedBytes(const MappedBytes&) = delete;
  MappedBytes& operator=(const MappedBytes&) = delete;
  absl::Span<const std::byte> bytes() const override {
    return absl::MakeConstSpan(static_cast<const std::byte*>(data_), size_);
  }

 private:
  void* data_;
  std::size_t size_;
};

absl::StatusOr<std::unique_ptr<MappedBytes>> map_file(const std::string& path) {
  const int fd = open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW);
  if (fd < 0) {
    return errno_status(errno, path);
  }
  const absl::Cleanup close_file = [fd] { close(fd); };
  struct stat info {};
  if (fstat(fd, &info) != 0) {
    return errno_status(errno, path);
  }
  if (!S_ISREG(info.st_mode)) {
    return absl::DataLossError(absl::StrCat(path, " is not a file"));
  }
  const auto size = static_cast<std::size_t>(info.st_size);
  if (size == 0) {
    return std::make_unique<MappedBytes>(nullptr, 0);
  }
  void* data = mmap(nullptr, size, PROT_READ, MAP_PRIVATE, fd, 0);
  if (data == MAP_FAILED) {
    return errno_status(errno, path);
  }
  return std::make_unique<MappedBytes>(data, size);
}

}  // namespace

absl::StatusOr<std::unique_ptr<BlobBytes>> BlobFolder::get(const wire::Digest& digest) {
  const std::string path = path_of(digest);
  auto mapped = map_file(path);
  if (!mapped.ok()) {
    return mapped.status();
  }
  if (wire::sha256((*mapped)->bytes()) != digest) {
    return absl::DataLossError(absl::StrCat(
        "blob ", path, " is damaged: its bytes do not have the digest that names it; remove it"));
  }
  return std::unique_ptr<BlobBytes>(*std::move(mapped));
}

}  // namespace bandsaw
