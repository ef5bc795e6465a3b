#!/usr/bin/env bash
# Speed against error: renders scenes at 4, 16, 64 and 256 samples and compares each with a reference of another seed.
# Prints a Markdown table. The seconds to 1 % follow from the last row's error, which falls at least as 1/sqrt(samples).
# Usage: tests/bench/speed_error.sh PATH-TO-BANDSAW [WIDTH [REFERENCE-SAMPLES]]
set -euo pipefail
bandsaw=${1:?usage: speed_error.sh PATH-TO-BANDSAW [WIDTH [REFERENCE-SAMPLES]]}
width=${2:-160}
reference=${3:-4096}
gallery=$(cd "$(dirname "$0")/../../renderlib/gallery" && pwd)
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

number() { sed -n "s/.*\"$1\":\([-0-9.e+]*\).*/\1/p"; }

echo "| scene | samples | CPU s | Msamples / CPU s | Mrays / CPU s | error (relRMSE) | relMSE | CPU s to 1 % |"
echo "| --- | --- | --- | --- | --- | --- | --- | --- |"
for scene in cornell spheres textured; do
  "$bandsaw" render "$gallery/$scene.textproto" --width "$width" --samples "$reference" --seed 4711 --quiet \
    -o "$folder/reference.pfm" >/dev/null
  for samples in 4 16 64 256; do
    done=$("$bandsaw" render "$gallery/$scene.textproto" --width "$width" --samples "$samples" --json \
      -o "$folder/image.pfm" | tail -1)
    cpu=$(number cpu_s <<<"$done")
    rays=$(number rays <<<"$done")
    taken=$(number samples_done <<<"$done")
    compared=$("$bandsaw" compare "$folder/image.pfm" "$folder/reference.pfm" --json)
    error=$(number relative_rmse <<<"$compared")
    relative=$(number relative_mse <<<"$compared")
    awk -v scene="$scene" -v n="$samples" -v cpu="$cpu" -v rays="$rays" -v taken="$taken" -v e="$error" -v m="$relative" \
      'BEGIN { printf "| %s | %d | %.2f | %.2f | %.1f | %.1f %% | %.2g | %.1f |\n",
               scene, n, cpu, taken / cpu / 1e6, rays / cpu / 1e6, 100 * e, m, cpu * (e / 0.01) ^ 2 }'
  done
done
