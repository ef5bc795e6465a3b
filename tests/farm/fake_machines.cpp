// Scripts that stand in for `ssh` and `systemctl`. Each simulated machine is a home folder;
// commands for it run on the machine of the test.

#include "tests/farm/fake_machines.h"

#include <filesystem>
#include <fstream>

#include "tests/support/process.h"

namespace bandsaw::test {
namespace {

namespace fs = std::filesystem;

// Stands in for ssh: runs the remote command here, in the home folder of the simulated host.
constexpr char kSsh[] = R"sh(#!/bin/sh
while [ "$1" != -- ]; do shift; done
host=$2
shift 2
case $host in
  nobody) echo "ssh: connect to host nobody port 22: No route to host" >&2; exit 255 ;;
  stranger) echo "Host key verification failed." >&2; exit 255 ;;
  frozen) exec sleep 1000 ;;
esac
mkdir -p "$MACHINES/homes/$host"
exec env -i HOME="$MACHINES/homes/$host" PATH="$MACHINES/bin-$host:$MACHINES/bin-all:/usr/bin:/bin" \
  XDG_RUNTIME_DIR=/nowhere sh -c "$*"
)sh";

// Stands in for systemctl --user: starts and stops the command of one unit file. Writes each call
// of systemctl to the file `asked`.
constexpr char kSystemctl[] = R"sh(
echo "systemctl $*" >>"$HOME/asked"
unit=$HOME/.config/systemd/user/bandsaw-worker.service
running() { readlink "/proc/$(cat "$HOME/service")/exe" >/dev/null; }
case $2 in
  restart) eval "exec setsid $(sed -n s/^ExecStart=//p "$unit")" >"$(sed -n s/^StandardOutput=append://p "$unit")" 2>&1 </dev/null &
    echo $! >"$HOME/service" ;;
  is-active) running ;;
  kill) kill "-${3#--signal=}" "$(cat "$HOME/service")" ;;
  stop) kill "$(cat "$HOME/service")"; while running; do sleep 0.1; done ;;
esac
)sh";

void write_program(const fs::path& path, const std::string& text) {
  fs::create_directories(path.parent_path());
  std::ofstream(path) << text;
  fs::permissions(path, fs::perms::owner_all);
}

}  // namespace

FakeMachines::FakeMachines() {
  write_program(folder_ / "bin/ssh", kSsh);
  // Makes `nice` run the command at normal priority: at low priority the worker would get no CPU
  // time beside other tests.
  replace("all", "nice", "shift 2; exec \"$@\"\n");
}

FakeMachines::~FakeMachines() {
  // Ends the processes whose ids were written to files. If an id was reused, the process runs
  // another program and is left alone.
  run({"/bin/sh", "-c",
       "for file in '" + folder_.path() + "'/homes/*/.local/share/bandsaw-worker/pid '" +
           folder_.path() +
           "'/homes/*/service; do pid=$(cat \"$file\" 2>/dev/null) && "
           "case $(readlink \"/proc/$pid/exe\") in '" +
           folder_.path() + "'*) kill -KILL \"$pid\" ;; esac; done; true"});
}

void FakeMachines::replace(const std::string& host, const std::string& command,
                           const std::string& script) {
  write_program(folder_ / ("bin-" + host + "/" + command), "#!/bin/sh\n" + script);
}

void FakeMachines::add_systemd(const std::string& host) {
  replace(host, "systemctl", kSystemctl);
  replace(host, "loginctl", "echo \"loginctl $*\" >>\"$HOME/asked\"\n");
}

std::vector<std::string> FakeMachines::environment() const {
  return {"PATH=" + folder_ / "bin" + ":/usr/bin:/bin", "MACHINES=" + folder_.path()};
}

}  // namespace bandsaw::test
