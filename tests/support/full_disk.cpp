// Simulates a full disk by the process's limit on the size of files (RLIMIT_FSIZE).

#include "tests/support/full_disk.h"

#include <sys/resource.h>

#include <csignal>

#include "renderlib/base/check.h"

namespace bandsaw::test {

FullDisk::FullDisk(std::uint64_t bytes) {
  // A write beyond the limit sends SIGXFSZ, which would end the process. If the signal is ignored,
  // only the write fails.
  std::signal(SIGXFSZ, SIG_IGN);
  rlimit limit{};
  BANDSAW_CHECK(::getrlimit(RLIMIT_FSIZE, &limit) == 0, "a process may read its limits");
  before_ = limit.rlim_cur;
  limit.rlim_cur = bytes;
  BANDSAW_CHECK(::setrlimit(RLIMIT_FSIZE, &limit) == 0, "a process may lower its soft limits");
}

void FullDisk::release() {
  rlimit limit{};
  BANDSAW_CHECK(::getrlimit(RLIMIT_FSIZE, &limit) == 0, "a process may read its limits");
  limit.rlim_cur = before_;
  BANDSAW_CHECK(::setrlimit(RLIMIT_FSIZE, &limit) == 0, "a soft limit may be raised again");
}

}  // namespace bandsaw::test
