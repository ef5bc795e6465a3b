#!/usr/bin/env bash
# Measures the gain of adaptive sampling at equal CPU time. For each of several seeds, renders each gallery scene uniformly with the
# error limit ERROR, and adaptively with the error limit that takes about the same CPU time. Compares both images with a reference of
# another seed and subtracts the reference's own noise. The gain is the product of squared error and CPU time of the
# uniform renders, divided by this product of the adaptive renders. Both factors are means over the seeds. If the gain is above 1,
# adaptive sampling is better.
# Usage: tests/bench/adaptive.sh PATH-TO-BANDSAW [WIDTH [ERROR [SEEDS [SCENE[:ERROR]...]]]]
# The first samples of an adaptive render are its pilot, which decides where more samples are taken. If the pilot has fewer than 32
# samples a pixel, nothing is planned. So ERROR should be so small that a render takes some 200 samples a pixel or more.
# The environment variable TIMES (default 8) is the number of samples of a reference, divided by that of a uniform image.
set -euo pipefail
bandsaw=${1:?usage: adaptive.sh PATH-TO-BANDSAW [WIDTH [ERROR [SEEDS [SCENE...]]]]}
width=${2:-128}
standard_error=${3:-2%}
seeds=${4:-3}
times=${TIMES:-8}
shift $(($# < 4 ? $# : 4))
scenes=("$@")
((${#scenes[@]})) || scenes=(defocus spheres glass_and_metal everything many_lights materials
  study/lights_0 mesh environment textures)
gallery=$(dirname "$(realpath "$bandsaw")")/../share/bandsaw/gallery  # with the textures that the build generates
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

# Prints the number in field $1 of a line of JSON.
number() { sed -n "s/.*\"$1\":\([-0-9.e+]*\).*/\1/p"; }

# Renders $scene with $seed and prints: CPU seconds, samples a pixel, relative MSE, relative RMSE, estimated error.
measure() {  # ERROR OPTION...
  local done compared error=$1
  shift
  done=$("$bandsaw" render "$gallery/$scene.textproto" --width "$width" --error "$error" --seed "$seed" --json \
    -o "$folder/image.pfm" "$@" | tail -1)
  compared=$("$bandsaw" compare "$folder/image.pfm" "$folder/reference.pfm" --json)
  echo "$(number cpu_s <<<"$done") $(number samples_per_pixel <<<"$done") $(number relative_mse <<<"$compared")" \
    "$(number relative_rmse <<<"$compared") $(number error <<<"$done")"
}

echo "| scene | samples, uniform | samples, adaptive | error, uniform | error, adaptive | estimated error, adaptive | CPU time, uniform over adaptive | gain in relMSE | gain in MSE |"
echo "| --- | --- | --- | --- | --- | --- | --- | --- | --- |"
for wanted in "${scenes[@]}"; do
  IFS=: read -r scene error <<<"$wanted"
  error=${error:-$standard_error}
  seed=1
  most=$("$bandsaw" render "$gallery/$scene.textproto" --width "$width" --error "$error" --seed 1 --json -o "$folder/image.pfm" |
    tail -1 | number samples_per_pixel)
  "$bandsaw" render "$gallery/$scene.textproto" --width "$width" --samples $((most * times)) --seed 4711 --quiet \
    -o "$folder/reference.pfm" >/dev/null
  for ((seed = 1; seed <= seeds; ++seed)); do
    even=$(measure "$error")
    adaptive=$(measure "$error" --adaptive)
    # The squared error is about proportional to 1 / time. From this follows the error limit that takes the time of the uniform
    # render. With equal samples (fields 2 and 7) nothing was planned, and the times differ only by noise.
    longer=$(echo "$even $adaptive ${error%\%}" | awk '{ if ($2 != $7) print $11 * sqrt($6 / $1) "%" }')
    if [ -n "$longer" ]; then adaptive=$(measure "$longer" --adaptive); fi
    echo "$even $adaptive"
  done | awk -v scene="$scene" -v reference="$((most * times))" '
    { cpu += $1; n += $2; rel += $3; mse += $4 ^ 2; acpu += $6; an += $7; arel += $8; amse += $9 ^ 2; told += $10; ++k }
    # The squared error of n samples is proportional to 1 / n. So the share of the reference with m samples in the measured
    # squared difference is n / (n + m).
    END { noise = n / k / (n / k + reference)
          printf "| %s | %.0f | %.0f | %.2f %% | %.2f %% | %.2f %% | %.2f | %.2f | %.2f |\n", scene, n / k, an / k,
          100 * sqrt((1 - noise) * mse / k), 100 * sqrt((amse - noise * mse) / k), 100 * told / k, cpu / acpu,
          (1 - noise) * rel * cpu / ((arel - noise * rel) * acpu), (1 - noise) * mse * cpu / ((amse - noise * mse) * acpu) }'
done
