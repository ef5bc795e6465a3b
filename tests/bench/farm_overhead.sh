#!/usr/bin/env bash
# What a farm of one local worker costs over `bandsaw render`: paired runs of the same job, one after the other, and the ratio
# of their wall-clock times; the first figure printed is the median ratio.
# Usage: tests/bench/farm_overhead.sh FOLDER-OF-PROGRAMS [PAIRS [SAMPLES]]
set -euo pipefail
bin=$(cd "${1:?usage: farm_overhead.sh FOLDER-OF-PROGRAMS [PAIRS [SAMPLES]]}" && pwd)
pairs=${2:-5}
samples=${3:-128}
top=$(cd "$(dirname "$0")/../.." && pwd)
scene=$top/renderlib/gallery/cornell.textproto
PATH=$bin:$PATH
. "$top/deploy/loopback.sh"
serve_here "$scratch/serve.log"
work_here local "$scratch/worker.log"
until grep -q joined "$scratch/worker.log"; do sleep 0.05; done

seconds() {
  local begin end
  begin=$(date +%s.%N)
  "$@" >/dev/null
  end=$(date +%s.%N)
  awk -v a="$begin" -v b="$end" 'BEGIN { print b - a }'
}

for ((i = 1; i <= pairs; ++i)); do
  farm=$(seconds bandsaw submit "$scene" --farm "$data/farm" --samples "$samples" --seed "$i" --quiet \
    -o "$scratch/farm.pfm")
  local=$(seconds bandsaw render "$scene" --samples "$samples" --seed "$i" --quiet -o "$scratch/local.pfm")
  cmp "$scratch/farm.pfm" "$scratch/local.pfm"
  awk -v f="$farm" -v l="$local" 'BEGIN { printf "%.4f  farm %.2f s, local %.2f s\n", f / l, f, l }'
done | sort -n | awk '{ line[NR] = $0 } END { print "median", line[int((NR + 1) / 2)]; for (i = 1; i <= NR; ++i) print line[i] }'
