#include "renderlib/import/files/confine.h"

#include <fcntl.h>
#include <linux/landlock.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cerrno>

#include "absl/cleanup/cleanup.h"
#include "renderlib/base/atomic_file.h"
#include "renderlib/base/status_macros.h"
#include "renderlib/import/files/confine_system_calls.h"

namespace bandsaw {
namespace {

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kShadowMemory = true;
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
constexpr bool kShadowMemory = true;
#else
constexpr bool kShadowMemory = false;
#endif
#else
constexpr bool kShadowMemory = false;
#endif

absl::Status limit(__rlimit_resource resource, std::uint64_t most, const char* what) {
  const rlimit value{most, most};
  return setrlimit(resource, &value) == 0 ? absl::OkStatus() : errno_status(errno, what);
}

absl::Status limit_resources(const Confinement& to) {
  RETURN_IF_ERROR(limit(RLIMIT_CORE, 0, "cannot limit core dumps"));
  RETURN_IF_ERROR(limit(RLIMIT_NOFILE, 64, "cannot limit open files"));
  RETURN_IF_ERROR(limit(RLIMIT_CPU, to.cpu_seconds, "cannot limit CPU time"));
  RETURN_IF_ERROR(limit(RLIMIT_FSIZE, to.file_bytes, "cannot limit file sizes"));
  // A sanitizer's shadow memory takes terabytes of address space.
  return kShadowMemory ? absl::OkStatus()
                       : limit(RLIMIT_AS, to.memory_bytes, "cannot limit memory");
}

// If the machine runs out of memory all the same, this process is the one to end.
void volunteer_for_out_of_memory() {
  const int fd = open("/proc/self/oom_score_adj", O_WRONLY | O_CLOEXEC);
  if (fd >= 0) {
    [[maybe_unused]] const ssize_t written = write(fd, "1000", 4);
    close(fd);
  }
}

// The rights of the first version of Landlock's interface, which every kernel with Landlock knows.
constexpr std::uint64_t kRead = LANDLOCK_ACCESS_FS_READ_FILE | LANDLOCK_ACCESS_FS_READ_DIR;
constexpr std::uint64_t kWrite = kRead | LANDLOCK_ACCESS_FS_WRITE_FILE |
                                 LANDLOCK_ACCESS_FS_MAKE_REG | LANDLOCK_ACCESS_FS_REMOVE_FILE;
constexpr std::uint64_t kHandled =
    kWrite | LANDLOCK_ACCESS_FS_EXECUTE | LANDLOCK_ACCESS_FS_REMOVE_DIR |
    LANDLOCK_ACCESS_FS_MAKE_CHAR | LANDLOCK_ACCESS_FS_MAKE_DIR | LANDLOCK_ACCESS_FS_MAKE_SOCK |
    LANDLOCK_ACCESS_FS_MAKE_FIFO | LANDLOCK_ACCESS_FS_MAKE_BLOCK | LANDLOCK_ACCESS_FS_MAKE_SYM;

absl::Status allow_folder(int rules, const std::string& folder, std::uint64_t rights) {
  const int fd = open(folder.c_str(), O_PATH | O_DIRECTORY | O_CLOEXEC);
  if (fd < 0) {
    return errno_status(errno, folder);
  }
  const absl::Cleanup close_folder = [fd] { close(fd); };
  landlock_path_beneath_attr rule{};
  rule.allowed_access = rights;
  rule.parent_fd = fd;
  if (syscall(SYS_landlock_add_rule, rules, LANDLOCK_RULE_PATH_BENEATH, &rule, 0) != 0) {
    return errno_status(errno, "cannot allow " + folder);
  }
  return absl::OkStatus();
}

absl::Status confine_to_folders(const Confinement& to) {
  landlock_ruleset_attr attributes{};
  attributes.handled_access_fs = kHandled;
  const long rules =
      syscall(SYS_landlock_create_ruleset, &attributes, sizeof(attributes.handled_access_fs), 0);
  if (rules < 0) {
    return absl::OkStatus();
  }
  const int fd = static_cast<int>(rules);
  const absl::Cleanup close_rules = [fd] { close(fd); };
  RETURN_IF_ERROR(allow_folder(fd, to.read_folder, kRead));
  RETURN_IF_ERROR(allow_folder(fd, to.write_folder, kWrite));
  if (syscall(SYS_landlock_restrict_self, fd, 0) != 0) {
    return errno_status(errno, "cannot confine reading to a folder (Landlock)");
  }
  return absl::OkStatus();
}

}  // namespace

absl::Status confine_this_process(const Confinement& to) {
  volunteer_for_out_of_memory();
  RETURN_IF_ERROR(limit_resources(to));
  if (prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) != 0) {
    return errno_status(errno, "cannot give up new privileges");
  }
  RETURN_IF_ERROR(confine_to_folders(to));
  return forbid_system_calls();
}

}  // namespace bandsaw
