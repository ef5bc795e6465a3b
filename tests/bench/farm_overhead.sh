#!/usr/bin/env bash
# Compares a farm of one local worker with `bandsaw render`, by paired runs of the same job in alternating order. The images must
# be equal. Prints the time of the farm divided by the time of `bandsaw render`, as the median over the pairs: first the wall clock
# time, then the CPU time of all processes (for the farm: coordinator, worker and submitter). Other work on the machine disturbs the
# wall clock time more than the CPU time.
# Usage: tests/bench/farm_overhead.sh FOLDER-OF-PROGRAMS [PAIRS [SCENE [OPTION-OF-RENDER...]]]
#   a job of 60 s or more:       farm_overhead.sh build/release/bin 3 cornell --samples 256
#   a 4K image of 16 samples:    farm_overhead.sh build/release/bin 1 books/one_weekend --width 3840 --height 2160 --samples 16
set -euo pipefail
bin=$(cd "${1:?usage: farm_overhead.sh FOLDER-OF-PROGRAMS [PAIRS [SCENE [OPTION...]]]}" && pwd)
pairs=${2:-5}
top=$(cd "$(dirname "$0")/../.." && pwd)
scene=$bin/../share/bandsaw/gallery/${3:-cornell}.textproto  # with the textures that the build generates
options=("${@:4}")
((${#options[@]})) || options=(--samples 128)
PATH=$bin:$PATH
. "$top/deploy/loopback.sh"
serve_here "$scratch/serve.log" --web none
work_here local "$scratch/worker.log"
until grep -q joined "$scratch/worker.log"; do sleep 0.05; done

# CPU seconds so far: of ended children of this shell, and of the farm.
cpu() {
  {
    sed 's/.*) //' "/proc/$$/stat" | cut -d ' ' -f 14,15
    for pid in "${pids[@]}"; do sed 's/.*) //' "/proc/$pid/stat" | cut -d ' ' -f 12,13; done
  } | awk -v hz="$(getconf CLK_TCK)" '{ ticks += $1 + $2 } END { print ticks / hz }'
}

spent() {  # COMMAND...: its seconds of wall clock and of CPU
  local begin cpu_begin
  begin=$(date +%s.%N)
  cpu_begin=$(cpu)
  "$@" "${options[@]}" --quiet >/dev/null
  echo "$begin $(date +%s.%N) $cpu_begin $(cpu)" | awk '{ print $2 - $1, $4 - $3 }'
}

on_farm() { spent bandsaw submit "$scene" --farm "$data/farm" --seed "$1" -o "$scratch/on_farm.pfm"; }
alone() { spent bandsaw render "$scene" --seed "$1" -o "$scratch/alone.pfm"; }

for ((i = 1; i <= pairs; ++i)); do
  ways=(on_farm alone)
  ((i % 2)) || ways=(alone on_farm)
  for way in "${ways[@]}"; do "$way" "$i" >"$scratch/$way"; done
  cmp "$scratch/on_farm.pfm" "$scratch/alone.pfm"
  paste -d ' ' "$scratch/on_farm" "$scratch/alone" >>"$scratch/pairs"
done

median() { awk "{ print $1 }" "$scratch/pairs" | sort -n | sed -n "$(((pairs + 1) / 2))p"; }
echo "median ratio of farm to local render: wall $(median '$1 / $3'), CPU $(median '$2 / $4')"
awk '{ printf "wall %.4f  farm %.2f s, local %.2f s   CPU %.4f  farm %.2f s, local %.2f s\n", $1 / $3, $1, $3, $2 / $4, $2, $4 }' "$scratch/pairs"
