#include "worker/machine.h"

#include <unistd.h>

#include <cstdlib>

#include "absl/strings/str_cat.h"
#include "renderlib/base/cpu_name.h"
#include "renderlib/base/float_mode.h"

namespace bandsaw::worker {
std::string host_name() {
  char name[65] = {};
  return gethostname(name, sizeof(name) - 1) == 0 && name[0] != '\0' ? name : "worker";
}

std::string build_description(const Kernel& kernel) {
#if defined(__clang__)
  const std::string compiler = absl::StrCat("clang ", __clang_major__, ".", __clang_minor__);
#else
  const std::string compiler = absl::StrCat("g++ ", __GNUC__, ".", __GNUC_MINOR__);
#endif
  return absl::StrCat(BANDSAW_VERSION, ", ", compiler, ", ", kernel.name, " kernel, ", cpu_name());
}

std::string default_cache_folder() {
  if (const char* cache = std::getenv("XDG_CACHE_HOME"); cache != nullptr && cache[0] == '/') {
    return absl::StrCat(cache, "/bandsaw/blobs");
  }
  if (const char* home = std::getenv("HOME"); home != nullptr && home[0] == '/') {
    return absl::StrCat(home, "/.cache/bandsaw/blobs");
  }
  return "";
}

absl::Status check_machine() {
  if (!float_mode_is_default()) {
    return absl::FailedPreconditionError(
        "the floating-point unit is not in its default mode: a library loaded with this program "
        "has changed it");
  }
  return absl::OkStatus();
}

}  // namespace bandsaw::worker
