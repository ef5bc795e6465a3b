// The reserve is a file of kBytes bytes. It is removed when the disk is full, so that the journal
// has space.

#include "coordinator/store/reserve.h"

#include <unistd.h>

#include "coordinator/store/staged_file.h"
#include "renderlib/base/file.h"
#include "renderlib/base/status_macros.h"

namespace bandsaw::coordinator {

absl::Status Reserve::hold() {
  if (const absl::StatusOr<File> there = File::open(path_, O_RDONLY); there.ok()) {
    ASSIGN_OR_RETURN(const std::uint64_t size, there->size());
    if (size == kBytes) {
      return absl::OkStatus();
    }
  }
  const std::string staging = path_ + ".incoming";
  RETURN_IF_ERROR(remove_file(staging));
  ASSIGN_OR_RETURN(StagedFile file, StagedFile::create(staging, kBytes));
  return file.commit(path_.substr(0, path_.rfind('/')), path_);
}

bool Reserve::release() { return ::unlink(path_.c_str()) == 0; }

}  // namespace bandsaw::coordinator
