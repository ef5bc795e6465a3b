#!/usr/bin/env bash
# What adaptive sampling gains: renders gallery scenes until an error, evenly and adaptively, with several seeds in turn, and
# compares both with a reference of another seed. Gain: error squared x CPU time of the even render over that of the adaptive
# one, mean over the seeds; above 1 adaptive sampling is better.
# Usage: tests/bench/adaptive.sh PATH-TO-BANDSAW [WIDTH [ERROR [SEEDS [SCENE...]]]]
set -euo pipefail
bandsaw=${1:?usage: adaptive.sh PATH-TO-BANDSAW [WIDTH [ERROR [SEEDS [SCENE...]]]]}
width=${2:-96}
error=${3:-5%}
seeds=${4:-3}
shift $(($# < 4 ? $# : 4))
scenes=("$@")
((${#scenes[@]})) || scenes=(cornell spheres room glass_and_metal spots smoke)
gallery=$(cd "$(dirname "$0")/../../renderlib/gallery" && pwd)
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

number() { sed -n "s/.*\"$1\":\([-0-9.e+]*\).*/\1/p"; }

# CPU seconds, samples a pixel, relative MSE, relative RMSE, estimated error.
measure() {
  local done compared
  done=$("$bandsaw" render "$gallery/$scene.textproto" --width "$width" --error "$error" --seed "$seed" --json \
    -o "$folder/image.pfm" "$@" | tail -1)
  compared=$("$bandsaw" compare "$folder/image.pfm" "$folder/reference.pfm" --json)
  echo "$(number cpu_s <<<"$done") $(number samples_per_pixel <<<"$done") $(number relative_mse <<<"$compared")" \
    "$(number relative_rmse <<<"$compared") $(number error <<<"$done")"
}

echo "| scene | samples even | adaptive | error even | adaptive | told adaptive | gain in relMSE | gain in MSE |"
echo "| --- | --- | --- | --- | --- | --- | --- | --- |"
for scene in "${scenes[@]}"; do
  seed=1
  most=$("$bandsaw" render "$gallery/$scene.textproto" --width "$width" --error "$error" --seed 1 --json -o "$folder/image.pfm" |
    tail -1 | number samples_per_pixel)
  "$bandsaw" render "$gallery/$scene.textproto" --width "$width" --samples $((most * 16)) --seed 4711 --quiet \
    -o "$folder/reference.pfm" >/dev/null
  for ((seed = 1; seed <= seeds; ++seed)); do
    echo "$(measure) $(measure --adaptive)"
  done | awk -v scene="$scene" '
    { even = $1 * $3; own = $6 * $8; rel += even; arel += own; mse += $1 * $4 ^ 2; amse += $6 * $9 ^ 2
      n += $2; an += $7; e += $4; ae += $9; told += $10; ++k }
    END { printf "| %s | %.0f | %.0f | %.2f %% | %.2f %% | %.2f %% | %.2f | %.2f |\n",
          scene, n / k, an / k, 100 * e / k, 100 * ae / k, 100 * told / k, rel / arel, mse / amse }'
done
