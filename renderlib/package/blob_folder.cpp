// Maps a blob's file into memory and checks its digest.

#include "renderlib/package/blob_folder.h"

#include <fcntl.h>

#include <utility>

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

absl::StatusOr<std::unique_ptr<BlobBytes>> BlobFolder::get(const wire::Digest& digest) {
  const std::string path = path_of(digest);
  absl::StatusOr<MappedFile> opened = MappedFile::open(path, O_NOFOLLOW);
  if (absl::IsInvalidArgument(opened.status())) {
    return absl::DataLossError(absl::StrCat(opened.status().message(), "; remove it"));
  }
  ASSIGN_OR_RETURN(MappedFile file, std::move(opened));
  if (wire::sha256(file.bytes()) != digest) {
    return absl::DataLossError(absl::StrCat(
        "blob ", path, " is damaged: its bytes do not have the digest that names it; remove it"));
  }
  return std::make_unique<MappedBytes>(std::move(file));
}

}  // namespace bandsaw
