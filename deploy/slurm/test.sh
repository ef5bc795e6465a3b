#!/usr/bin/env bash
# Tests a farm whose workers are jobs of Slurm. The script runs Slurm's daemons on this machine, keeps their files in a temporary folder, and
# installs nothing. While the farm renders, the script adds workers, requeues one, cancels one, and sends one the signal that Slurm sends
# before a time limit. Each of these three workers must drain: it finishes its bands (parts of the image) and takes no more. The image must
# have the bytes of `bandsaw render`.
# Exit status 77: Slurm is not installed.
# Usage: deploy/slurm/test.sh FOLDER-OF-THE-PROGRAMS
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
programs=$(cd "$1" && pwd)
export PATH="$programs:$PATH:/usr/sbin:/sbin"

skip() { echo "skipped: $*"; exit 77; }
for program in munged slurmctld slurmd sbatch; do
  command -v "$program" >/dev/null || skip "$program is not here (packages slurm-wlm, munge)"
done
[ "$(id -u)" -eq 0 ] || skip "slurmd must be run by root"

dir=$(mktemp -d)
pids=()
stop() {
  status=$?
  scancel --quiet --user root 2>/dev/null || true
  [ "$status" -eq 0 ] || tail -n 20 "$dir"/*.log >&2
  for ((i = ${#pids[@]} - 1; i >= 0; i--)); do
    kill "${pids[i]}" 2>/dev/null || true
    wait "${pids[i]}" 2>/dev/null || true
  done
  rm -rf "$dir"
}
trap stop EXIT

# until_true SECONDS COMMAND...: runs the command five times a second until it succeeds.
until_true() {
  local left=$(($1 * 5))
  shift
  until "$@"; do
    ((left-- > 0)) || { echo "waited in vain: $*" >&2; return 1; }
    sleep 0.2
  done
}
free_port() { python3 -c 'import socket; s = socket.socket(); s.bind(("127.0.0.1", 0)); print(s.getsockname()[1])'; }

start_slurm() {
  mkdir -m 0700 "$dir/munge" "$dir/state" "$dir/spool"
  dd if=/dev/urandom of="$dir/munge/key" bs=128 count=1 status=none
  chmod 0600 "$dir/munge/key"
  munged --foreground --force --key-file="$dir/munge/key" --socket="$dir/munge/socket" --pid-file="$dir/munge/pid" \
    --log-file="$dir/munge.log" --seed-file="$dir/munge/seed" >/dev/null 2>&1 &
  pids+=($!)
  until_true 10 test -S "$dir/munge/socket"
  cat >"$dir/slurm.conf" <<CONF
ClusterName=bandsaw
SlurmctldHost=$(hostname -s)(127.0.0.1)
SlurmctldPort=$(free_port)
SlurmdPort=$(free_port)
SlurmUser=root
AuthType=auth/munge
AuthInfo=socket=$dir/munge/socket,cred_expire=5
StateSaveLocation=$dir/state
SlurmdSpoolDir=$dir/spool
SlurmctldPidFile=$dir/slurmctld.pid
SlurmdPidFile=$dir/slurmd.pid
SlurmctldLogFile=$dir/slurmctld.log
SlurmdLogFile=$dir/slurmd.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
ReturnToService=2
KillWait=30
SlurmdParameters=config_overrides
NodeName=$(hostname -s) NodeAddr=127.0.0.1 CPUs=4 Boards=1 SocketsPerBoard=1 CoresPerSocket=4 ThreadsPerCore=1 RealMemory=512 State=UNKNOWN
PartitionName=all Nodes=ALL Default=YES MaxTime=INFINITE State=UP
CONF
  export SLURM_CONF="$dir/slurm.conf"
  slurmctld -D >/dev/null 2>&1 &
  pids+=($!)
  slurmd -D >/dev/null 2>&1 &
  pids+=($!)
  until_true 30 node_is_idle
}
node_is_idle() { [ "$(sinfo --noheader --format=%t 2>/dev/null)" = idle ]; }

start_coordinator() {
  bandsaw serve --data "$dir/data" --listen 127.0.0.1:0 --web none >"$dir/coordinator.log" 2>&1 &
  pids+=($!)
  until_true 20 test -s "$dir/data/farm"
  export BANDSAW_FARM="$dir/data/farm"
}

# start_workers RANGE [PROGRAM]: submits an array of workers; prints its job number.
start_workers() {
  BANDSAW_JOIN="$dir/data/join" BANDSAW_CACHE="$dir/cache" BANDSAW_WORKER="${2:-bandsaw-worker}" sbatch --parsable --array="$1" --cpus-per-task=1 \
    --output="$dir/worker-%A_%a.log" "$here/worker.sbatch"
}
# A worker is named by its task, such as 2_1: the number of the Slurm job, and the index in its array.
# log_holds TASK PATTERN: succeeds if a line of the worker's log matches.
log_holds() { grep -q "$2" "$dir/worker-$1.log" 2>/dev/null; }
# times_joined TASK COUNT: succeeds if the worker has joined the farm at least so many times.
times_joined() { [ "$(grep -c ' joined ' "$dir/worker-$1.log")" -ge "$2" ]; }
# is_gone TASK: succeeds if Slurm no longer lists the worker.
is_gone() { [ -z "$(squeue --noheader --jobs="$1" 2>/dev/null)" ]; }

start_slurm
start_coordinator
echo "slurm and a coordinator run"

first=$(start_workers 1-2)
until_true 30 log_holds "${first}_1" ' joined '
scene=$here/../../renderlib/gallery/cornell.textproto
settings=(--width 128 --samples 256 --seed 3)
bandsaw submit "$scene" "${settings[@]}" -o "$dir/farm.pfm" >"$dir/submit.log" 2>&1 &
submit=$!
until_true 30 log_holds "${first}_1" 'rendered job='

# The folder `shared` is like a shared disk of a cluster with several architectures. worker.sbatch gets the path shared/bandsaw-worker, which
# does not exist. It must run the file whose name ends with the architecture of the node.
mkdir "$dir/shared"
cp "$programs/bandsaw-worker" "$dir/shared/bandsaw-worker-$(uname -m)"
second=$(start_workers 3-4 "$dir/shared/bandsaw-worker")
until_true 30 log_holds "${second}_4" 'rendered job='
echo "workers were added during the render, now running: $(squeue --noheader --states=RUNNING --array | wc -l)"

scontrol requeue "${first}_1"
until_true 60 log_holds "${first}_1" 'drain'
until_true 90 times_joined "${first}_1" 2
echo "a requeued worker drained, and came back"

scancel "${second}_3"
until_true 40 is_gone "${second}_3"
log_holds "${second}_3" 'drain'
echo "a cancelled worker drained"

# Sends the signal that Slurm sends 120 s before the time limit (--signal=B:TERM@120 in
# worker.sbatch).
scancel --batch --signal=TERM "${second}_4"
until_true 40 is_gone "${second}_4"
log_holds "${second}_4" 'drain'
echo "a worker drained before its time limit"

wait "$submit"
bandsaw render "$scene" "${settings[@]}" -o "$dir/here.pfm" >/dev/null
cmp "$dir/farm.pfm" "$dir/here.pfm"
echo "the farm's image has the same bytes as that of bandsaw render"
