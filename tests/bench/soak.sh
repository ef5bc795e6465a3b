#!/usr/bin/env bash
# Sends thousands of small jobs through one coordinator and one worker; measures the memory of both and the jobs per second.
# Usage: tests/bench/soak.sh BIN-FOLDER [JOBS [KEPT]]   (default 10,000 and 1,000). A job takes about 0.1 s on two cores.
# KEPT: the number of finished jobs that the coordinator keeps (--keep-jobs). Until it keeps so many, its memory grows with each job.
# Prints a line after each tenth of the jobs: jobs done, resident MB of coordinator and worker, MB of the coordinator's folder, jobs a
# second. The last line says by how much the memory of both processes has grown during the second half of the jobs.
set -euo pipefail
bin=$(cd "${1:?usage: soak.sh BIN-FOLDER [JOBS [KEPT]]}" && pwd)
jobs=${2:-10000} kept=${3:-1000}
top=$(cd "$(dirname "$0")/../.." && pwd)
PATH=$bin:$PATH
. "$top/deploy/loopback.sh"
serve_here "$scratch/coordinator.log" --web none --keep-jobs "$kept"
work_here soak "$scratch/worker.log" --threads 1

resident() { awk '/^VmRSS/ { printf "%.1f", $2 / 1024 }' "/proc/$1/status"; }
submit() {
  bandsaw submit "$top/renderlib/gallery/spheres.textproto" --farm "$data/farm" --samples 1 --width 16 --seed "$1" --quiet \
    --report none -o "$scratch/$2.pfm" >/dev/null
}

echo "| jobs | coordinator, MB | worker, MB | on disk, MB | jobs a second |"
echo "| --- | --- | --- | --- | --- |"
step=$(((jobs + 9) / 10))
for ((done = 0; done < jobs; done += step)); do
  began=$(date +%s.%N)
  for lane in 0 1 2 3; do  # four jobs at a time
    for ((i = done + lane; i < done + step && i < jobs; i += 4)); do submit "$i" "$lane"; done &
    lanes[lane]=$!
  done
  wait "${lanes[@]}"
  last=$((done + step < jobs ? done + step : jobs))
  coordinator=$(resident "${pids[0]}") worker=$(resident "${pids[1]}")
  awk -v jobs="$last" -v c="$coordinator" -v w="$worker" -v disk="$(du -sm "$data" | cut -f1)" \
    -v took="$(date +%s.%N) $began" -v step=$((last - done)) 'BEGIN {
      split(took, t, " "); printf "| %d | %s | %s | %d | %.1f |\n", jobs, c, w, disk, step / (t[1] - t[2]) }'
  ((2 * last < jobs)) || [ -n "${half:-}" ] || half=$coordinator half_worker=$worker half_at=$last
done
awk -v c="$coordinator" -v h="$half" -v w="$worker" -v hw="$half_worker" -v n=$((jobs - half_at)) 'BEGIN {
  printf "growth during the last %d jobs: coordinator %+.1f MB, worker %+.1f MB\n", n, c - h, w - hw }'
