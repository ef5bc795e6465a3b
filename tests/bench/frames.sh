#!/usr/bin/env bash
# Measures the overhead of a sequence of frames: the cost beyond the rendering of the samples. The farm has one local worker with one
# thread. Prints:
# - a ratio: the time of all frames, from the start of `bandsaw submit` to its end, divided by the time in which `bandsaw render`
#   renders the same number of samples in one image after it has read the scene;
# - the time until the first frame is written, the bytes that a frame adds to the files of the coordinator, and the CPU time and
#   the most memory of each process.
# Usage: tests/bench/frames.sh FOLDER-OF-PROGRAMS [FRAMES [SQUARES...]]
#   SQUARES: the scene is a rippled plane of SQUARES x SQUARES squares (frames_scene.py); 200 and 1000 by default
set -euo pipefail
bin=$(cd "${1:?usage: frames.sh FOLDER-OF-PROGRAMS [FRAMES [SQUARES...]]}" && pwd)
frames=${2:-100}
squares=("${@:3}")
((${#squares[@]})) || squares=(200 1000)
top=$(cd "$(dirname "$0")/../.." && pwd)
PATH=$bin:$PATH
. "$top/deploy/loopback.sh"
options=(--width "${WIDTH:-160}" --height "${HEIGHT:-90}" --fps 24)
samples=${SAMPLES:-16}
serve_here "$scratch/serve.log" --web none
work_here local "$scratch/worker.log" --threads 1
export BANDSAW_FARM=$data/farm

# cpu PID prints the CPU seconds of a process, and memory PID its most resident memory. blob_bytes prints the size of the scene data
# that the coordinator keeps.
cpu() { sed 's/.*) //' "/proc/$1/stat" | cut -d ' ' -f 12,13 | awk -v hz="$(getconf CLK_TCK)" '{ print ($1 + $2) / hz }'; }
memory() { sed -n 's/^VmHWM:[^0-9]*\([0-9]*\) kB/\1/p' "/proc/$1/status" | awk '{ printf "%.0f MB", $1 / 1024 }'; }
blob_bytes() { du -sb "$data/blobs" | cut -f 1; }
now() { date +%s.%N; }

for side in "${squares[@]}"; do
  scene=$scratch/plane$side.glb
  /usr/bin/python3 "$top/tests/bench/frames_scene.py" "$scene" "$side"
  bandsaw render "$scene" --frame 50 --threads 1 "${options[@]}" --samples $((samples * frames)) --quiet --report "$scratch/alone.json" -o "$scratch/alone.pfm" >/dev/null 2>&1
  ideal=$(sed -n 's/.*"time":{"elapsed_s":\([0-9.e+-]*\),"cpu_s":\([0-9.e+-]*\).*/\1 \2/p' "$scratch/alone.json")
  # Renders one frame first, so that the farm has the data of the scene before the measurement begins.
  bandsaw submit "$scene" --frames 0 "${options[@]}" --samples 1 --quiet --report none -o "$scratch/first.####.pfm" >/dev/null
  before=$(blob_bytes) worker=$(cpu "${pids[1]}") coordinator=$(cpu "${pids[0]}")
  begin=$(now)
  mkdir -p "$scratch/out"
  bandsaw submit "$scene" --frames "1-$frames" "${options[@]}" --samples $samples --quiet --report none -o "$scratch/out/w.####.pfm" >/dev/null 2>&1 &
  submit=$!
  until [ -e "$scratch/out/w.0001.pfm" ]; do sleep 0.01; done
  first=$(now)
  wait $submit
  end=$(now)
  echo "$side $ideal $begin $first $end $(($(blob_bytes) - before)) $frames $(cpu "${pids[1]}") $worker $(cpu "${pids[0]}") $coordinator" | awk '{
    printf "%d squares, %d frames: %.2f s, samples alone %.2f s, ratio %.3f; first frame %.2f s; %.1f kB a frame\n",
      $1 * $1, $8, $6 - $4, $2, ($6 - $4) / $2, $5 - $4, $7 / $8 / 1e3
    printf "  CPU a frame: samples alone %.3f s, worker %.3f s (ratio %.3f), coordinator %.3f s\n",
      $3 / $8, ($9 - $10) / $8, ($9 - $10) / $3, ($11 - $12) / $8 }'
  echo "  most memory: coordinator $(memory "${pids[0]}"), worker $(memory "${pids[1]}"); load $(cut -d ' ' -f 1 /proc/loadavg)"
  rm -rf "$scratch/out" "$scene"
done
