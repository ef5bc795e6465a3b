// Confines the process that reads files of unknown origin: sets resource limits, restricts files to
// two folders by Landlock, and forbids system calls by a seccomp filter, which is a list of
// instructions for the kernel's packet filter.

#include "renderlib/import/files/confine.h"

#include <fcntl.h>
#include <linux/audit.h>
#include <linux/filter.h>
#include <linux/landlock.h>
#include <linux/seccomp.h>
#include <sched.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstddef>
#include <vector>

#include "absl/cleanup/cleanup.h"
#include "absl/status/status.h"
#include "renderlib/base/atomic_file.h"
#include "renderlib/base/status_macros.h"

namespace bandsaw {
namespace {

#if defined(__x86_64__)
constexpr std::uint32_t kArchitecture = AUDIT_ARCH_X86_64;
#elif defined(__aarch64__)
constexpr std::uint32_t kArchitecture = AUDIT_ARCH_AARCH64;
#else
#error "add the AUDIT_ARCH constant of this architecture"
#endif

// Forbidden system calls. There is no list of allowed calls, because allocators, the C library and
// sanitizers may change the calls that they use. The calls for network and other processes are few.
constexpr std::array kForbidden = {
    // network
    SYS_socket,
    SYS_socketpair,
    SYS_connect,
    SYS_bind,
    SYS_listen,
    SYS_accept,
    SYS_accept4,
    SYS_sendto,
    SYS_sendmsg,
    SYS_sendmmsg,
    SYS_recvfrom,
    SYS_recvmsg,
    SYS_recvmmsg,
    // programs and processes
    SYS_execve,
    SYS_execveat,
#if defined(SYS_fork)  // newer architectures have clone alone
    SYS_fork,
    SYS_vfork,
#endif
    SYS_ptrace,
    SYS_process_vm_readv,
    SYS_process_vm_writev,
    SYS_kill,
    SYS_tkill,
    SYS_rt_sigqueueinfo,
    SYS_rt_tgsigqueueinfo,
    SYS_pidfd_open,
    SYS_pidfd_getfd,
    SYS_pidfd_send_signal,
    // ways around the rules above
    SYS_io_uring_setup,
    SYS_io_uring_enter,
    SYS_io_uring_register,
    SYS_bpf,
    SYS_userfaultfd,
    SYS_keyctl,
    SYS_add_key,
    SYS_request_key,
    SYS_unshare,
    SYS_setns,
    SYS_mount,
    SYS_umount2,
    SYS_pivot_root,
    SYS_chroot,
    SYS_open_by_handle_at,
    SYS_perf_event_open,
};

constexpr sock_filter statement(std::uint16_t code, std::uint32_t value) {
  return {code, 0, 0, value};
}
/// `yes` and `no` are the numbers of statements to skip if the comparison is true or false.
constexpr sock_filter jump(std::uint16_t code, std::uint32_t value, std::uint8_t yes,
                           std::uint8_t no) {
  return {code, yes, no, value};
}
/// Ends the filter: the system call fails with this errno.
constexpr sock_filter answer(int error) {
  return statement(BPF_RET | BPF_K, SECCOMP_RET_ERRNO | static_cast<std::uint32_t>(error));
}

/// Returns the instructions of the seccomp filter.
std::vector<sock_filter> program() {
  constexpr std::uint16_t kLoad = BPF_LD | BPF_W | BPF_ABS;
  constexpr std::uint16_t kEqual = BPF_JMP | BPF_JEQ | BPF_K;
  constexpr std::uint16_t kAtLeast = BPF_JMP | BPF_JGE | BPF_K;
  constexpr std::uint16_t kAnyBit = BPF_JMP | BPF_JSET | BPF_K;
  constexpr std::uint32_t kX32 = 0x40000000;
  std::vector<sock_filter> filter = {
      statement(kLoad, offsetof(seccomp_data, arch)),
      jump(kEqual, kArchitecture, 1, 0),
      statement(BPF_RET | BPF_K, SECCOMP_RET_KILL_PROCESS),
      statement(kLoad, offsetof(seccomp_data, nr)),
      // On x86-64, call numbers from kX32 up are aliases of the same calls (x32 ABI). The
      // comparisons with kForbidden would miss the aliases, so every alias fails. Other
      // architectures have no such numbers.
      jump(kAtLeast, kX32, 0, 1),
      answer(EPERM),
      // clone3 fails with ENOSYS, so that the C library falls back to clone, whose flags can be
      // checked: threads are allowed, processes are not.
      jump(kEqual, SYS_clone3, 0, 1),
      answer(ENOSYS),
      jump(kEqual, SYS_clone, 0, 4),
      statement(kLoad, offsetof(seccomp_data, args)),
      jump(kAnyBit, CLONE_THREAD, 1, 0),
      answer(EPERM),
      statement(BPF_RET | BPF_K, SECCOMP_RET_ALLOW),
      // abort() and pthread_kill() send signals with tgkill, to threads of this process.
      jump(kEqual, SYS_tgkill, 0, 4),
      statement(kLoad, offsetof(seccomp_data, args)),
      jump(kEqual, static_cast<std::uint32_t>(getpid()), 1, 0),
      answer(EPERM),
      statement(BPF_RET | BPF_K, SECCOMP_RET_ALLOW),
  };
  for (const long call : kForbidden) {
    filter.push_back(jump(kEqual, static_cast<std::uint32_t>(call), 0, 1));
    filter.push_back(answer(EPERM));
  }
  filter.push_back(statement(BPF_RET | BPF_K, SECCOMP_RET_ALLOW));
  return filter;
}

/// Installs the seccomp filter; "no new privileges" MUST be set.
absl::Status forbid_system_calls() {
  std::vector<sock_filter> filter = program();
  const sock_fprog whole = {static_cast<unsigned short>(filter.size()), filter.data()};
  if (prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &whole, 0, 0) != 0) {
    return errno_status(errno, "cannot forbid system calls (seccomp)");
  }
  return absl::OkStatus();
}

// True if the program is built with a sanitizer that uses shadow memory.
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

// Limits the resource to `most`, or to the inherited hard limit if that limit is lower, because
// only privileged users may raise a hard limit. `what` begins the message of an error.
absl::Status limit(__rlimit_resource resource, std::uint64_t most, const char* what) {
  rlimit inherited{};
  if (getrlimit(resource, &inherited) != 0) {
    return errno_status(errno, what);
  }
  const rlim_t lowest = std::min<rlim_t>(most, inherited.rlim_max);
  const rlimit value{lowest, lowest};
  return setrlimit(resource, &value) == 0 ? absl::OkStatus() : errno_status(errno, what);
}

// Sets all resource limits of this process.
absl::Status limit_resources(const Confinement& to) {
  RETURN_IF_ERROR(limit(RLIMIT_CORE, 0, "cannot limit core dumps"));
  // 64 files are more than enough, because files are read whole, one after the other.
  RETURN_IF_ERROR(limit(RLIMIT_NOFILE, 64, "cannot limit open files"));
  RETURN_IF_ERROR(limit(RLIMIT_CPU, to.cpu_seconds, "cannot limit CPU time"));
  RETURN_IF_ERROR(limit(RLIMIT_FSIZE, to.file_bytes, "cannot limit file sizes"));
  // A sanitizer's shadow memory uses terabytes of address space.
  return kShadowMemory ? absl::OkStatus()
                       : limit(RLIMIT_AS, to.memory_bytes, "cannot limit memory");
}

// Makes the kernel end this process first if the machine runs out of memory. Errors are ignored.
void volunteer_for_out_of_memory() {
  const int fd = open("/proc/self/oom_score_adj", O_WRONLY | O_CLOEXEC);
  if (fd >= 0) {
    [[maybe_unused]] const ssize_t written = write(fd, "1000", 4);
    close(fd);
  }
}

// The rights of Landlock's first version, which every kernel with Landlock supports.
constexpr std::uint64_t kRead = LANDLOCK_ACCESS_FS_READ_FILE | LANDLOCK_ACCESS_FS_READ_DIR;
constexpr std::uint64_t kWrite = kRead | LANDLOCK_ACCESS_FS_WRITE_FILE |
                                 LANDLOCK_ACCESS_FS_MAKE_REG | LANDLOCK_ACCESS_FS_REMOVE_FILE;
// The rights that are forbidden except where a rule allows them.
constexpr std::uint64_t kHandled =
    kWrite | LANDLOCK_ACCESS_FS_EXECUTE | LANDLOCK_ACCESS_FS_REMOVE_DIR |
    LANDLOCK_ACCESS_FS_MAKE_CHAR | LANDLOCK_ACCESS_FS_MAKE_DIR | LANDLOCK_ACCESS_FS_MAKE_SOCK |
    LANDLOCK_ACCESS_FS_MAKE_FIFO | LANDLOCK_ACCESS_FS_MAKE_BLOCK | LANDLOCK_ACCESS_FS_MAKE_SYM;

/// Allows `rights` in the folder and below it. `rules` is the descriptor of the Landlock rule set.
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

/// Makes all files outside of the two folders inaccessible by Landlock. Does nothing if the kernel
/// has no Landlock.
absl::Status confine_to_folders(const Confinement& to) {
  landlock_ruleset_attr attributes{};
  attributes.handled_access_fs = kHandled;
  const long rules =
      syscall(SYS_landlock_create_ruleset, &attributes, sizeof(attributes.handled_access_fs), 0);
  if (rules < 0) {
    // The kernel has no Landlock.
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
