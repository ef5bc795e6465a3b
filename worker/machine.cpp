#include "worker/machine.h"

#include <unistd.h>
#if defined(__x86_64__)
#include <xmmintrin.h>
#endif

#include <cstdlib>

#include "absl/strings/str_cat.h"
#include "renderlib/base/cpu_name.h"

namespace bandsaw::worker {
std::string host_name() {
  char name[65] = {};
  return gethostname(name, sizeof(name) - 1) == 0 && name[0] != '\0' ? name : "worker";
}

std::string build_description() {
#if defined(__clang__)
  const std::string compiler = absl::StrCat("clang ", __clang_major__, ".", __clang_minor__);
#else
  const std::string compiler = absl::StrCat("g++ ", __GNUC__, ".", __GNUC_MINOR__);
#endif
  return absl::StrCat(BANDSAW_VERSION, ", ", compiler, ", ", cpu_name());
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
#if defined(__x86_64__)
#if defined(__AVX2__)
  if (!__builtin_cpu_supports("avx2") || !__builtin_cpu_supports("fma") ||
      !__builtin_cpu_supports("bmi2")) {
    return absl::FailedPreconditionError(
        "this processor is older than x86-64-v3 (Haswell, Zen), for which the program was built: "
        "build with -DBANDSAW_ARCH=x86-64-v2");
  }
#endif
  constexpr unsigned kFlags = 0x3f;      // what happened, not how to round
  constexpr unsigned kDefault = 0x1f80;  // all exceptions masked, to nearest, no flushing
  if ((_mm_getcsr() & ~kFlags) != kDefault) {
    return absl::FailedPreconditionError(
        "the floating-point unit is not in its default mode: a library loaded with this program "
        "has changed it");
  }
#endif
  return absl::OkStatus();
}

}  // namespace bandsaw::worker
