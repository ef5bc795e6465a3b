// Tests `bandsaw invite`, which installs workers on other machines over ssh, and `bandsaw dismiss`,
// which removes them, with the real ssh. ssh itself starts the real sshd (ProxyCommand), so the
// test needs no port and no daemon.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "tests/farm/farm_processes.h"

namespace bandsaw::test {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

constexpr char kSshd[] = "/usr/sbin/sshd";

void write_text(const std::string& path, const std::string& text) { std::ofstream(path) << text; }

// Makes a program `ssh` with a configuration of the test. HOME of the account to which `ssh` logs
// in is a folder of the test. Returns the environment variable PATH=… with which this `ssh` is
// found.
std::string make_account(const TempDir& folder) {
  for (const char* key : {"key", "host"}) {
    run({"/usr/bin/ssh-keygen", "-q", "-t", "ed25519", "-N", "", "-f", folder / key});
  }
  fs::create_directories(folder / "bin");
  fs::create_directories(folder / "home");
  write_text(folder / "sshd_config",
             "HostKey " + folder / "host" + "\nAuthorizedKeysFile " + folder / "key.pub" +
                 "\nStrictModes no\nUsePAM no\nPidFile none\n"
                 "PermitRootLogin yes\nSetEnv XDG_RUNTIME_DIR=/nowhere PATH=" +
                 folder / "there" + ":/usr/bin:/bin HOME=" + folder / "home" + "\n");
  write_text(folder / "ssh_config",
             std::string("ProxyCommand ") + kSshd + " -i -f " + folder / "sshd_config" +
                 "\nIdentityFile " + folder / "key" + "\nIdentitiesOnly yes\nUserKnownHostsFile " +
                 folder / "known" + "\nLogLevel ERROR\n");
  write_text(folder / "bin/ssh",
             "#!/bin/sh\nexec /usr/bin/ssh -F " + folder / "ssh_config" + " \"$@\"\n");
  fs::permissions(folder / "bin/ssh", fs::perms::owner_all);
  // Makes `nice` run the command at normal priority: at low priority the worker would get no CPU
  // time beside other tests.
  fs::create_directories(folder / "there");
  write_text(folder / "there/nice", "#!/bin/sh\nshift 2; exec \"$@\"\n");
  fs::permissions(folder / "there/nice", fs::perms::owner_all);
  return "PATH=" + folder / "bin" + ":/usr/bin:/bin";
}

TEST(InviteSsh, InviteAndDismissWorkThroughARealServer) {
  if (access(kSshd, X_OK) != 0 || access("/usr/bin/ssh", X_OK) != 0) {
    GTEST_SKIP() << "needs the packages openssh-server and openssh-client";
  }
  if (geteuid() == 0) {
    // As root, sshd requires this folder, which its package creates at boot.
    fs::create_directories("/run/sshd");
  }
  FarmProcesses farm;
  const TempDir folder;
  const std::string path = make_account(folder);
  const std::vector<std::string> invite = {BANDSAW_BIN, "invite", "--join", farm.join_file(),
                                           "desk"};
  // The key of the host is not known yet.
  const Finished stranger = run(invite, {path});
  EXPECT_EQ(stranger.code, 1);
  EXPECT_THAT(stranger.err, HasSubstr("connect once by hand: ssh desk"));

  const std::string key = file_bytes(folder / "host.pub");
  write_text(folder / "known", "desk " + key);
  const Finished invited = run(invite, {path});
  EXPECT_EQ(invited.code, 0) << invited.err;
  EXPECT_THAT(invited.out, HasSubstr("desk: bandsaw-worker ")) << invited.out;
  const Finished dismissed = run({BANDSAW_BIN, "dismiss", "desk"}, {path});
  EXPECT_EQ(dismissed.code, 0) << dismissed.err;
  EXPECT_FALSE(fs::exists(folder / "home/.local/share/bandsaw-worker"));
}

}  // namespace
}  // namespace bandsaw::test
