// The scripts that install and remove a worker begin with kCommon, which defines shell functions.
// Numbers and digests are put into the text of a script. The join string, which has a secret, comes
// from standard input.

#include "coordinator/cli/machines/remote_scripts.h"

#include "absl/strings/str_cat.h"

namespace bandsaw::coordinator {
namespace {

// The common part of both scripts. `result` prints the result and ends the script; its first
// argument is ok or failed. `serves` succeeds if the worker runs as a service of systemd.
// `gone_within` waits, at most $1 seconds, until the process that own_pid finds has ended. It fails
// if the process still runs. `end_worker` ends a worker that runs.
constexpr char kCommon[] = R"sh(
result() { echo "bandsaw-result: $*"; exit 0; }
[ -n "${HOME:-}" ] || result failed "HOME is not set there"
dir=$HOME/.local/share/bandsaw-worker
unit=${XDG_CONFIG_HOME:-$HOME/.config}/systemd/user/bandsaw-worker.service
XDG_RUNTIME_DIR=${XDG_RUNTIME_DIR:-/run/user/$(id -u)}
export XDG_RUNTIME_DIR

here=$(uname -n)

# Fails if another machine shares this home folder and has a worker in it. Sets shared to the
# message.
is_ours() {
  host=$(cat "$dir/host" 2>/dev/null)
  shared="this home folder is shared with $host, which has a worker in it: dismiss $host first"
  shared="$shared (if that is this machine's former name, remove $dir/host there)"
  [ "${host:-$here}" = "$here" ]
}

# Sets pid to the process of a worker that runs without systemd. Fails if there is none, or if
# another program has this id now.
own_pid() {
  pid=$(cat "$dir/pid" 2>/dev/null) || return 1
  case $(readlink "/proc/$pid/exe" 2>/dev/null) in
    "$(cd "$dir" && pwd -P)/bandsaw-worker"*) return 0 ;;
  esac
  return 1
}
serves() { systemctl --user is-active --quiet bandsaw-worker 2>/dev/null; }
gone_within() {
  left=$(($1 * 5))
  while own_pid && [ "$left" -gt 0 ]; do
    sleep 0.2
    left=$((left - 1))
  done
  ! own_pid
}
# At the first signal the worker finishes its bands; at the second it ends at once. $1: seconds to
# wait for the bands.
end_worker() {
  if [ -f "$unit" ]; then
    # The signal is sent by `kill`: `stop` would end the worker after the time limit of the unit.
    serves && systemctl --user kill --signal=TERM bandsaw-worker 2>/dev/null
    left=$(($1 * 5))
    while serves && [ "$left" -gt 0 ]; do
      sleep 0.2
      left=$((left - 1))
    done
    timeout 5 systemctl --user stop bandsaw-worker 2>/dev/null ||
      systemctl --user kill --signal=KILL bandsaw-worker 2>/dev/null
  fi
  if own_pid; then
    kill -TERM "$pid"
    gone_within "$1" || kill -TERM "$pid"
    gone_within 2 || kill -KILL "$pid"
  fi
  rm -f "$dir/pid"
}
)sh";

// Needs the variables size and digest. Installs the program, starts it and waits for a minute until
// its log says that it has joined the farm.
constexpr char kInvite[] = R"sh(
umask 077
read -r join
mkdir -p "$dir" || result failed "cannot make $dir"
free=$(df -Pk "$dir" | awk 'NR == 2 { print $4 }')
need=$((size * 2 / 1024))
[ "$free" -ge "$need" ] || result failed "no space: $free KiB are free in $dir, $need are needed"
new=$dir/bandsaw-worker.new.$here
cat >"$new" || { rm -f "$new"; result failed "cannot write $new"; }
[ "$(sha256sum <"$new" | cut -c 1-64)" = "$digest" ] || { rm -f "$new"; result failed "what arrived is damaged"; }
chmod 700 "$new"
said=$("$new" --version 2>&1) || {
  status=$?
  rm -f "$new"
  # The shell returns 126 or 127 if the kernel does not run the file or the loader is missing.
  case $status in 126 | 127) said="$said (it needs a 64-bit system with glibc)" ;; esac
  result failed "the worker does not run there: $said"
}

# With noclobber, only one of the machines that share the folder makes this file.
(set -C; printf '%s\n' "$here" >"$dir/host") 2>/dev/null
is_ours || { rm -f "$new"; result failed "$shared"; }
end_worker 10
mv "$new" "$dir/bandsaw-worker"
printf '%s\n' "$join" >"$dir/join"
: >"$dir/log"

if systemctl --user show-environment >/dev/null 2>&1; then
  mkdir -p "${unit%/*}"
  cat >"$unit" <<END
[Unit]
Description=Bandsaw worker, by invitation
ConditionHost=$here
[Service]
ExecStart="$dir/bandsaw-worker" --join "$dir/join" --cache "$dir/cache"
StandardOutput=append:$dir/log
StandardError=append:$dir/log
Restart=on-failure
RestartPreventExitStatus=1 2
TimeoutStopSec=60
Nice=19
CPUSchedulingPolicy=idle
CPUWeight=1
NoNewPrivileges=yes
[Install]
WantedBy=default.target
END
  systemctl --user daemon-reload && systemctl --user enable --quiet bandsaw-worker &&
    systemctl --user restart bandsaw-worker || result failed "systemd --user did not start it"
  how="a user service"
  if [ "$(loginctl show-user "$(id -un)" --property=Linger --value 2>/dev/null)" != yes ]; then
    if loginctl enable-linger 2>/dev/null; then
      : >"$dir/lingers"
    else
      how="a user service until you log out there (loginctl enable-linger is not allowed)"
    fi
  fi
  running() { systemctl --user is-active --quiet bandsaw-worker; }
else
  setsid nice -n 19 "$dir/bandsaw-worker" --join "$dir/join" --cache "$dir/cache" \
    >"$dir/log" 2>&1 </dev/null &
  echo $! >"$dir/pid"
  how="a process until the host is restarted"
  running() { readlink "/proc/$(cat "$dir/pid")/exe" >/dev/null; }  # fails for a dead child
fi

joined="^bandsaw-worker .* joined "
left=300
while [ "$left" -gt 0 ] && running && ! grep -q "$joined" "$dir/log"; do
  sleep 0.2
  left=$((left - 1))
done
grep -q "$joined" "$dir/log" && result ok "$(grep -m 1 "$joined" "$dir/log"), $how"
running || result failed "the worker ended: $(tail -n 1 "$dir/log")"
result failed "it runs, but has not reached the farm yet: $(tail -n 1 "$dir/log")"
)sh";

// Needs the variable drain: the seconds in which the worker may finish its bands (the rows that it
// is rendering). Ends the worker and removes all that kInvite has made.
constexpr char kDismiss[] = R"sh(
[ -d "$dir" ] || [ -f "$unit" ] || result ok "there was no worker"
is_ours || result failed "$shared"
end_worker "$drain"
if [ -f "$unit" ]; then
  systemctl --user disable --quiet bandsaw-worker 2>/dev/null
  rm -f "$unit"
  systemctl --user daemon-reload 2>/dev/null
fi
[ ! -f "$dir/lingers" ] || loginctl disable-linger 2>/dev/null
rm -rf "$dir" && result ok "gone" || result failed "cannot remove $dir"
)sh";

}  // namespace

std::string machine_script() {
  return absl::StrCat("echo \"", kRemoteResult, "ok $(uname -s) $(uname -m)\"\n");
}

std::string invite_script(std::uint64_t size, const wire::Digest& program) {
  return absl::StrCat("size=", size, "\ndigest=", program.hex(), "\n", kCommon, kInvite);
}

std::string dismiss_script(int drain_s) {
  return absl::StrCat("drain=", drain_s, "\n", kCommon, kDismiss);
}

}  // namespace bandsaw::coordinator
