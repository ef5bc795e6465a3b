// Tests `bandsaw invite`, which installs workers on other machines over ssh, and `bandsaw dismiss`,
// which removes them. The machines are simulated, and `ssh` is a script of the test.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "tests/farm/fake_machines.h"
#include "tests/farm/farm_processes.h"

namespace bandsaw::test {
namespace {

using ::testing::HasSubstr;

class Invite : public ::testing::Test {
 protected:
  Finished invite(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), {BANDSAW_BIN, "invite", "--join", farm_.join_file()});
    return run(arguments, machines_.environment());
  }
  Finished dismiss(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), {BANDSAW_BIN, "dismiss"});
    return run(arguments, machines_.environment());
  }
  /// Returns true, and fails the test, if the host's home folder contains a file of the worker. The
  /// files `asked` and `service` belong to the simulated systemctl.
  bool has_files(const std::string& host) {
    for (const auto& entry : std::filesystem::recursive_directory_iterator(machines_.home(host))) {
      if (!entry.is_directory() && entry.path().filename() != "asked" &&
          entry.path().filename() != "service") {
        ADD_FAILURE() << entry.path();
        return true;
      }
    }
    return false;
  }

  FarmProcesses farm_;
  FakeMachines machines_;
};

TEST_F(Invite, InstallsWorkersThatRenderAndDismissRemovesThem) {
  const Finished invited = invite({"anna@desk", "laptop"});
  EXPECT_EQ(invited.code, 0) << invited.out << invited.err;
  EXPECT_THAT(invited.out, HasSubstr("anna@desk: bandsaw-worker "));
  EXPECT_THAT(invited.out, HasSubstr("invited: 2 of 2 hosts"));
  const Finished submitted =
      run(farm_.command({"submit", std::string(BANDSAW_GALLERY) + "/cornell.textproto", "--width",
                         "32", "--samples", "16", "-o", farm_.path("a.pfm")}));
  EXPECT_EQ(submitted.code, 0) << submitted.err;
  const Finished dismissed = dismiss({"anna@desk", "laptop", "never"});
  EXPECT_EQ(dismissed.code, 0) << dismissed.out << dismissed.err;
  EXPECT_THAT(dismissed.out, HasSubstr("never: there was no worker"));
  EXPECT_FALSE(has_files("anna@desk"));
  EXPECT_FALSE(has_files("laptop"));
}

TEST_F(Invite, ASecondInvitationReplacesTheFirst) {
  ASSERT_EQ(invite({"desk"}).code, 0);
  const std::string first = file_bytes(machines_.worker_folder("desk") + "/pid");
  ASSERT_EQ(invite({"desk"}).code, 0);
  const std::string second = file_bytes(machines_.worker_folder("desk") + "/pid");
  EXPECT_NE(first, second);
  // The first worker has ended if its process does not exist or is a zombie.
  const std::string runs =
      "grep -qs '^State:[[:space:]][^ZX]' /proc/" + std::to_string(std::stoi(first)) + "/status";
  EXPECT_NE(run({"/bin/sh", "-c", runs}).code, 0)
      << "the first worker still runs, but it must have ended";
  EXPECT_EQ(dismiss({"desk"}).code, 0);
}

TEST_F(Invite, AHomeFolderThatMachinesShareHasOneWorker) {
  std::filesystem::create_directories(machines_.home("desk"));
  std::filesystem::create_directory_symlink(machines_.home("desk"), machines_.home("laptop"));
  for (const std::string host : {"desk", "laptop"}) {
    machines_.replace(host, "uname",
                      "[ $1 = -n ] && echo " + host + " || exec /usr/bin/uname $@\n");
  }
  ASSERT_EQ(invite({"desk"}).code, 0);
  const Finished second = invite({"laptop"});
  EXPECT_EQ(second.code, 1) << second.out;
  EXPECT_THAT(second.err, HasSubstr("laptop: this home folder is shared with desk"));
  const Finished wrong = dismiss({"laptop"});
  EXPECT_EQ(wrong.code, 1) << wrong.out;
  EXPECT_THAT(wrong.err, HasSubstr("laptop: this home folder is shared with desk"));
  EXPECT_EQ(dismiss({"desk"}).code, 0);
  EXPECT_FALSE(has_files("desk"));
  EXPECT_EQ(invite({"laptop"}).code, 0);
  EXPECT_EQ(dismiss({"laptop"}).code, 0);
}

TEST_F(Invite, UsesSystemdIfTheUserHasIt) {
  machines_.add_systemd("desk");
  const Finished invited = invite({"desk"});
  EXPECT_EQ(invited.code, 0) << invited.err;
  EXPECT_THAT(invited.out, HasSubstr("a user service"));
  EXPECT_EQ(dismiss({"desk"}).code, 0);
  const std::string asked = file_bytes(machines_.home("desk") + "/asked");
  EXPECT_THAT(asked, HasSubstr("systemctl --user enable --quiet bandsaw-worker"));
  EXPECT_THAT(asked, HasSubstr("loginctl enable-linger"));
  EXPECT_THAT(asked, HasSubstr("systemctl --user kill --signal=TERM bandsaw-worker"));
  EXPECT_THAT(asked, HasSubstr("systemctl --user stop bandsaw-worker"));
  EXPECT_THAT(asked, HasSubstr("systemctl --user disable --quiet bandsaw-worker"));
  EXPECT_THAT(asked, HasSubstr("loginctl disable-linger"));
  EXPECT_FALSE(has_files("desk"));
}

TEST_F(Invite, ReportsTheErrorOfEachHostAndTheOthersJoin) {
  machines_.replace("phone", "uname", "[ $1 = -s ] && echo Linux || echo riscv64\n");
  machines_.replace("full", "df", "echo H; echo '/dev/sda 9 9 1000 99% /'\n");
  machines_.replace("ancient", "chmod",
                    "echo 'echo no GLIBC_2.36; exit 1' >$2; exec /usr/bin/chmod $@\n");
  const Finished invited = invite({"nobody", "stranger", "phone", "full", "ancient", "desk"});
  EXPECT_EQ(invited.code, 1);
  EXPECT_THAT(invited.err, HasSubstr("nobody: not reached: ssh: connect to host nobody port 22: No "
                                     "route to host"));
  EXPECT_THAT(invited.err, HasSubstr("stranger: not reached: Host key verification failed. "
                                     "(connect once by hand: ssh stranger)"));
  EXPECT_THAT(invited.err, HasSubstr("ancient: the worker does not run there: no GLIBC_2.36"));
  EXPECT_THAT(invited.err,
              HasSubstr("phone: there is no worker for this machine (uname says: Linux "
                        "riscv64); workers run on Linux, on x86_64 or aarch64"));
  EXPECT_THAT(invited.err, HasSubstr("full: no space: 1000 KiB are free"));
  EXPECT_THAT(invited.out, HasSubstr("invited: 1 of 6 hosts"));
  EXPECT_THAT(invited.out, HasSubstr("desk: bandsaw-worker "));
  EXPECT_FALSE(has_files("full"));
  EXPECT_EQ(dismiss({"desk"}).code, 0);
}

TEST_F(Invite, AHostThatDoesNotAnswerTimesOut) {
  const Finished invited = invite({"frozen", "--time", "0.5s"});
  EXPECT_EQ(invited.code, 1);
  EXPECT_THAT(invited.err, HasSubstr("frozen: did not end within 0.50 s"));
}

TEST_F(Invite, ReportsWhyAWorkerCannotJoin) {
  const std::string before = file_bytes(farm_.join_file());
  ASSERT_EQ(run({BANDSAW_BIN, "secret", "rotate", "worker", "--data", farm_.path("data")}).code, 0);
  const Finished invited =
      run({BANDSAW_BIN, "invite", "--join", before, "desk"}, machines_.environment());
  EXPECT_EQ(invited.code, 1);
  EXPECT_THAT(invited.err, HasSubstr("desk: the worker ended: bandsaw-worker: ")) << invited.out;
  EXPECT_EQ(dismiss({"desk"}).code, 0);
}

TEST_F(Invite, WrongUseIsRefusedBeforeAnythingIsSent) {
  EXPECT_EQ(invite({}).code, 2);
  EXPECT_EQ(invite({""}).code, 2);
  const Finished people =
      run({BANDSAW_BIN, "invite", "--join", farm_.farm_file(), "desk"}, machines_.environment());
  EXPECT_EQ(people.code, 2);
  EXPECT_THAT(people.err, HasSubstr("for users"));
  const Finished no_farm =
      run({BANDSAW_BIN, "invite", "--data", farm_.path("none"), "desk"}, machines_.environment());
  EXPECT_EQ(no_farm.code, 2);
  EXPECT_FALSE(std::filesystem::exists(machines_.home("desk")));
}

}  // namespace
}  // namespace bandsaw::test
