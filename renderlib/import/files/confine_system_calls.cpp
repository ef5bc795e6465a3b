#include "renderlib/import/files/confine_system_calls.h"

#include <linux/audit.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <sched.h>
#include <sys/prctl.h>
#include <sys/syscall.h>

#include <array>
#include <cerrno>
#include <cstddef>
#include <vector>

#include "renderlib/base/atomic_file.h"

namespace bandsaw {
namespace {

#if defined(__x86_64__)
constexpr std::uint32_t kArchitecture = AUDIT_ARCH_X86_64;
#elif defined(__aarch64__)
constexpr std::uint32_t kArchitecture = AUDIT_ARCH_AARCH64;
#else
#error "say which system calls these numbers are of"
#endif

// A list of what is forbidden, not of what is allowed: allocators, the C library and sanitizers are
// free to change what they use, while the ways to the network and to other processes are few.
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
    SYS_pidfd_open,
    SYS_pidfd_getfd,
    SYS_pidfd_send_signal,
    // doors around the rules above
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
constexpr sock_filter jump(std::uint16_t code, std::uint32_t value, std::uint8_t yes,
                           std::uint8_t no) {
  return {code, yes, no, value};
}
constexpr sock_filter answer(int error) {
  return statement(BPF_RET | BPF_K, SECCOMP_RET_ERRNO | static_cast<std::uint32_t>(error));
}

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
      // On x86-64 the x32 numbers are other names of the same calls; elsewhere there are none.
      jump(kAtLeast, kX32, 0, 1),
      answer(EPERM),
      // The C library falls back to clone, whose flags can be looked at: threads are allowed,
      // processes are not.
      jump(kEqual, SYS_clone3, 0, 1),
      answer(ENOSYS),
      jump(kEqual, SYS_clone, 0, 4),
      statement(kLoad, offsetof(seccomp_data, args)),
      jump(kAnyBit, CLONE_THREAD, 1, 0),
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

}  // namespace

absl::Status forbid_system_calls() {
  std::vector<sock_filter> filter = program();
  const sock_fprog whole = {static_cast<unsigned short>(filter.size()), filter.data()};
  if (prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &whole, 0, 0) != 0) {
    return errno_status(errno, "cannot forbid system calls (seccomp)");
  }
  return absl::OkStatus();
}

}  // namespace bandsaw
