#!/usr/bin/env bash
# What a farm of one local worker costs over `bandsaw render`: paired runs of the same job, one after the other, and the ratio
# of their wall-clock times; the first figure printed is the median ratio.
# Usage: tests/bench/farm_overhead.sh FOLDER-OF-PROGRAMS [PAIRS [SAMPLES]]
set -euo pipefail
bin=${1:?usage: farm_overhead.sh FOLDER-OF-PROGRAMS [PAIRS [SAMPLES]]}
pairs=${2:-5}
samples=${3:-128}
scene=$(cd "$(dirname "$0")/../../renderlib/gallery" && pwd)/cornell.textproto
folder=$(mktemp -d)
"$bin/bandsaw" serve --data "$folder/data" --listen 127.0.0.1:0 >"$folder/serve.log" 2>&1 &
serve=$!
trap 'kill $(jobs -p) 2>/dev/null || true; wait 2>/dev/null || true; rm -rf "$folder"' EXIT
until [ -s "$folder/data/join" ]; do
  kill -0 $serve
  sleep 0.05
done
"$bin/bandsaw-worker" --join "$folder/data/join" --cache "$folder/cache" >"$folder/worker.log" 2>&1 &
until grep -q joined "$folder/worker.log"; do sleep 0.05; done

seconds() {
  local begin end
  begin=$(date +%s.%N)
  "$@" >/dev/null
  end=$(date +%s.%N)
  awk -v a="$begin" -v b="$end" 'BEGIN { print b - a }'
}

for ((i = 1; i <= pairs; ++i)); do
  farm=$(seconds "$bin/bandsaw" submit "$scene" --farm "$folder/data/farm" --samples "$samples" --seed "$i" --quiet \
    -o "$folder/farm.pfm")
  local=$(seconds "$bin/bandsaw" render "$scene" --samples "$samples" --seed "$i" --quiet -o "$folder/local.pfm")
  cmp "$folder/farm.pfm" "$folder/local.pfm"
  awk -v f="$farm" -v l="$local" 'BEGIN { printf "%.4f  farm %.2f s, local %.2f s\n", f / l, f, l }'
done | sort -n | awk '{ line[NR] = $0 } END { print "median", line[int((NR + 1) / 2)]; for (i = 1; i <= NR; ++i) print line[i] }'
