#!/usr/bin/env bash
# Compares the efficiency of Bandsaw with that of Cycles in one run. Both render the same scenes in turns with two seeds.
# relMSE: the error of one image, which is half of the relative squared difference of a renderer's two images. No
# reference is needed.
# Efficiency: 1 / (relMSE x CPU seconds / 2). Half of the CPU seconds is the wall clock time of two
# threads. Without blender on PATH (Debian's package), only Bandsaw is measured.
# Usage: tests/bench/peers.sh PATH-TO-BANDSAW [SAMPLES [SCENE.textproto...]]   (default: 64 samples of Cornell and Weekend)
# Scenes may only use the features that cycles.py supports. Takes a minute per scene on two cores.
set -euo pipefail
bandsaw=${1:?usage: peers.sh PATH-TO-BANDSAW [SAMPLES [SCENE.textproto...]]}
samples=${2:-64}
shift $(($# < 2 ? $# : 2))
here=$(cd "$(dirname "$0")" && pwd)
scenes=("$@")
((${#scenes[@]})) || scenes=("$here"/../../renderlib/gallery/{cornell,books/one_weekend}.textproto)
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

# number FIELD prints the number that the JSON on standard input has in this field.
number() { sed -n "s/.*\"$1\":\([-0-9.e+]*\).*/\1/p"; }

# Each function renders $scene with the seed $1, writes $image and prints the CPU seconds.
by_bandsaw() {
  image=$folder/bandsaw-$1.pfm
  "$bandsaw" render "$scene" --width "$width" --samples "$samples" --seed "$1" --json -o "$image" | tail -1 | number cpu_s
}
by_cycles() {
  image=$folder/cycles-$1.exr
  blender -b --python "$here/cycles.py" -- "$scene" "$width" "$height" "$samples" "$1" "$image" >"$folder/log" 2>&1
  sed -n 's/^cpu_s=//p' "$folder/log" | grep . || { tail -5 "$folder/log" >&2; return 1; }
}

renderers=(bandsaw)
if command -v blender >/dev/null; then renderers+=(cycles); fi
echo "| scene | renderer | M samples a CPU second | relMSE | efficiency | Bandsaw's efficiency relative to this renderer |"
echo "| --- | --- | --- | --- | --- | --- |"
for scene in "${scenes[@]}"; do
  width=400
  height=$("$bandsaw" render "$scene" --width $width --samples 1 --json -o "$folder/size.pfm" | tail -1 | number height)
  for seed in 1 2; do
    for renderer in "${renderers[@]}"; do
      "by_$renderer" "$seed" >>"$folder/$renderer.cpu"
    done
  done
  for renderer in "${renderers[@]}"; do
    images=("$folder/$renderer"-[12].[pe]*)
    echo "$renderer" $(<"$folder/$renderer.cpu") \
      "$("$bandsaw" compare "${images[@]}" --json | number relative_mse)"
  done | awk -v scene="$(basename "$scene" .textproto)" -v samples=$((width * height * samples)) '{
    cpu = ($2 + $3) / 2; error = $4 / 2; efficiency = 2 / (error * cpu)
    if (NR == 1) first = efficiency
    printf "| `%s` | %s | %.2f | %.5f | %.0f | %s |\n", scene, $1, samples / cpu * 1e-6, error, efficiency,
      NR == 1 ? "1" : sprintf("%.1f", first / efficiency)
  }'
  rm -f "$folder"/*
done
