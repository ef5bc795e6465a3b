// Makes a temporary folder with mkdtemp(), and removes it with its contents.

#include "coordinator/store/scratch_folder.h"

#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <system_error>

#include "absl/strings/str_cat.h"
#include "renderlib/base/file.h"

namespace bandsaw::coordinator {

namespace fs = std::filesystem;

absl::StatusOr<std::unique_ptr<const ScratchFolder>> ScratchFolder::make(
    const std::string& use, const std::string& parent) {
  std::error_code error;
  const fs::path in = parent.empty() ? fs::temp_directory_path(error) : fs::path(parent);
  std::string path = (in / absl::StrCat("bandsaw-", use, "-XXXXXX")).string();
  if (error || mkdtemp(path.data()) == nullptr) {
    return errno_status(error ? error.value() : errno,
                        absl::StrCat("cannot make a temporary folder in ", in.string()));
  }
  return std::unique_ptr<const ScratchFolder>(new ScratchFolder(std::move(path)));
}

ScratchFolder::~ScratchFolder() {
  std::error_code ignored;
  fs::remove_all(path_, ignored);
}

}  // namespace bandsaw::coordinator
