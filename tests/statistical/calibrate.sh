#!/usr/bin/env bash
# Compares the error that `bandsaw render` reports for an image with the true error of the image. Renders each gallery scene 96 pixels wide
# with 20 seeds, first until the reported error is at most 5 %, then until it is at most 2 % (the two targets). Compares every image with a
# reference that has many times as many samples, and writes the table of tests/statistical/README.md. Finished measurements are kept in
# FOLDER and not repeated, so an interrupted run continues.
# Usage: tests/statistical/calibrate.sh BANDSAW FOLDER [--scenes a,b,…] [--seeds N] [--times N] [--seconds S] [--minutes M]
#   --scenes   names as in the gallery's folder, "cornell,books/earth"; default: all
#   --seeds    default 20
#   --times    a reference takes N times the samples that the scene is expected to need for its smallest target (default 16); the noise of
#              the reference is subtracted from the measured errors
#   --seconds  CPU time that one render may take; renders that would take longer are left out and listed (default 20)
#   --minutes  begin no render after this time; then print the progress and leave the README unchanged (default: measure all)
# Exit status 1: the share of the images that met their target is significantly below 95 % (its confidence interval lies below 95 %), or
# nothing was measured.
set -euo pipefail
bandsaw=$(realpath "${1:?usage: calibrate.sh BANDSAW FOLDER [options]}")
folder=${2:?usage: calibrate.sh BANDSAW FOLDER [options]}
shift 2
root=$(cd "$(dirname "$0")/../.." && pwd)
gallery=$(dirname "$bandsaw")/../share/bandsaw/gallery  # with the textures that the build generates
scenes=$(cd "$gallery" && find . -name '*.textproto' | sed 's,^\./,,; s,\.textproto$,,' | sort)
seeds=20
seconds=20
times=16
minutes=
while [ $# -gt 0 ]; do
  case $1 in
    --scenes) scenes=${2//,/ } ;;
    --seeds) seeds=$2 ;;
    --times) times=$2 ;;
    --seconds) seconds=$2 ;;
    --minutes) minutes=$2 ;;
    *) echo "calibrate.sh: unknown option $1" >&2; exit 2 ;;
  esac
  shift 2
done
mkdir -p "$folder"
touch "$folder/done" "$folder/runs" "$folder/left_out" "$folder/references"

# Succeeds if the time of --minutes has passed.
is_late() { [ -n "$minutes" ] && ((SECONDS >= minutes * 60)); }
# Prints the number of the field $1 of the JSON object on the standard input.
number() { sed -n "s/.*\"$1\":\([-0-9.e+]*\).*/\1/p"; }
# Succeeds if the number $1 is less than the number $2.
is_less() { awk -v a="$1" -v b="$2" 'BEGIN { exit !(a < b) }'; }

# Renders a scene until its reported error is at most `target` percent. Prints the samples of all pixels, the reported error, the CPU seconds
# and the samples per pixel. Status 1: the render took more than ten times the CPU time of --seconds.
render() {  # scene target seed image
  local done status=0
  done=$(ulimit -S -t "$((10 * seconds))" && "$bandsaw" render "$gallery/$1.textproto" --width 96 --error "$2%" --seed "$3" --json -o "$4" |
         tail -n 1) || status=$?
  ((status <= 128)) || return 1
  ((status == 0)) || { echo "calibrate.sh: $1 cannot be rendered" >&2; kill $$; }
  echo "$(number samples_done <<<"$done") $(number error <<<"$done") $(number cpu_s <<<"$done") $(number samples_per_pixel <<<"$done")"
}

# Renders the scene with all seeds to each target. Appends a line for each render to the file `runs`: scene, target, seed, the output of
# render(), and the true error.
measure() {  # scene reference targets...
  local scene=$1 reference=$2 work=$folder/work seed target result true_error
  shift 2
  for target in "$@"; do
    for ((seed = 1; seed <= seeds; ++seed)); do
      ! is_late || return 0
      grep -q "^$scene $target $seed " "$folder/runs" && continue
      result=$(render "$scene" "$target" "$seed" "$work.pfm") || { echo "$scene $target" >> "$folder/left_out"; break; }
      true_error=$("$bandsaw" compare "$work.pfm" "$reference" --json | number relative_rmse)
      echo "$scene $target $seed $result $true_error" >> "$folder/runs"
    done
  done
}

for scene in $scenes; do
  ! is_late || break
  [ -f "$gallery/$scene.textproto" ] || { echo "calibrate.sh: no scene $scene in $gallery" >&2; exit 2; }
  grep -q "^$scene$" "$folder/done" 2>/dev/null && continue
  echo "$scene" >&2
  reference=$folder/${scene//\//_}.pfm
  # The time of the other renders is predicted from one render: 2 % costs about six times as much as 5 %.
  pilot=$(render "$scene" 5 1001 "$folder/work.pfm") || { echo "$scene 5" >> "$folder/left_out"; echo "$scene" >> "$folder/done"; continue; }
  read -r _ _ cpu samples <<<"$pilot"
  targets=5
  if is_less "$(awk -v c="$cpu" 'BEGIN { print 6.25 * c }')" "$seconds"; then
    targets="5 2"
    samples=$((samples * 25 / 4))
  else
    echo "$scene 2" >> "$folder/left_out"
  fi
  if ! [ -f "$reference" ]; then
    "$bandsaw" render "$gallery/$scene.textproto" --width 96 --samples $((times * samples)) --seed 4711 --quiet --report none \
      -o "$reference" > /dev/null
    echo "$scene $((times * samples))" >> "$folder/references"
  fi
  measure "$scene" "$reference" $targets
  ! is_late || break
  echo "$scene" >> "$folder/done"
done

[ -s "$folder/runs" ] || { echo "calibrate.sh: nothing was measured" >&2; exit 1; }
readme=$root/tests/statistical/README.md
sed '/<!-- table/q' "$readme" > "$folder/readme"
sort -u "$folder/left_out" > "$folder/without"
awk -v without="$folder/without" -v references="$folder/references" '
  # A line of `runs` is: scene, target, seed, samples of all pixels, reported error, CPU seconds, samples per pixel, true error.
  function root_mean(sum, n) { return sqrt(sum / n) }
  { ++runs; scene[runs] = $1; goal[runs] = $2; guess[runs] = $5; spent[runs] = $6; count[runs] = $7; error[runs] = $8
    if ($7 >= most[$1]) { most[$1] = $7; most_goal[$1] = $2 } }
  # Returns the square of the noise of the reference. If images of n samples have the true error e, a reference of m samples has the noise
  # e sqrt(n / m), and the square of the measured error is e^2 (1 + n / m).
  function own_noise(name,   i, sum, n, samples) {
    sum = n = samples = 0
    for (i = 1; i <= runs; ++i) if (scene[i] == name && goal[i] == most_goal[name]) { ++n; sum += error[i] ^ 2; samples += count[i] }
    return sum / n / (1 + reference[name] / (samples / n))
  }
  # Adds run i to the row of the table for its scene and target.
  function add(i, true_error,   key, ratio) {
    key = scene[i] " " goal[i]; ratio = guess[i] / true_error
    if (!(key in n)) { keys[++keys_count] = key; low[key] = high[key] = ratio }
    ++n[key]; samples[key] += count[i]; squares[key] += true_error ^ 2; cpu[key] += spent[i]
    if (ratio < low[key]) low[key] = ratio
    if (ratio > high[key]) high[key] = ratio
    if (true_error <= goal[i] / 100) { ++met[key]; ++all_met }
    if (ratio >= 0.9 && ratio <= 2.5) ++within
    ++all
  }
  END {
    while ((getline line < references) > 0) { split(line, part, " "); reference[part[1]] = part[2] }
    for (i = 1; i <= runs; ++i) {
      if (!(scene[i] in noise)) noise[scene[i]] = own_noise(scene[i])
      square = error[i] ^ 2 - noise[scene[i]]
      add(i, sqrt(square > 0 ? square : 1e-12))
    }
    # 95 % confidence interval of a share (Wilson 1927).
    p = all_met / all; z = 1.96; d = 1 + z * z / all
    middle = (p + z * z / (2 * all)) / d; half = z * sqrt(p * (1 - p) / all + z * z / (4 * all * all)) / d
    printf "\n%d renders of %d scenes: the true error is at most the target in **%d, %.1f %%** (95 %% interval %.1f to %.1f %%); the estimate is\n",
           all, scenes_of(), all_met, 100 * p, 100 * (middle - half), 100 * (middle + half)
    printf "between 0.9 and 2.5 times the true error in %.1f %%.\n\n", 100 * within / all
    print "| scene | target | renders | met | true error | estimate / true | samples a pixel | excess samples | CPU s |"
    print "| --- | --- | --- | --- | --- | --- | --- | --- | --- |"
    for (i = 1; i <= keys_count; ++i) {
      key = keys[i]; split(key, name, " "); e = root_mean(squares[key], n[key]); m = samples[key] / n[key]
      # The error is proportional to samples ^ -slope. The slope is measured between the two targets, but is at least 0.4. If there is only one
      # target, the slope is 1/2. `ideal` is the number of samples at which the error would be equal to the target.
      slope = 0.5; a = name[1] " 5"; b = name[1] " 2"
      if ((a in n) && (b in n) && samples[b] / n[b] > samples[a] / n[a])
        slope = log(root_mean(squares[a], n[a]) / root_mean(squares[b], n[b])) / log(samples[b] / n[b] / (samples[a] / n[a]))
      if (slope < 0.4) slope = 0.4
      ideal = m * (e / (name[2] / 100)) ^ (1 / slope)
      printf "| %s | %d %% | %d | %d | %.2f %% | %.2f to %.2f | %.0f | %+.0f %% | %.1f |\n", name[1], name[2], n[key], met[key],
             100 * e, low[key], high[key], m, 100 * (m / ideal - 1), cpu[key] / n[key]
    }
    first = 1
    while ((getline line < without) > 0) {
      split(line, name, " ")
      printf "%s%s to %d %%", first ? "\nLeft out, as one render takes too long: " : ", ", name[1], name[2]; first = 0
    }
    if (!first) print "."
    exit middle + half < 0.95
  }
  function scenes_of(  k, part, seen, total) { total = 0; for (k in n) { split(k, part, " "); if (!(part[1] in seen)) { seen[part[1]] = 1; ++total } } return total }
' "$folder/runs" >> "$folder/readme" && status=0 || status=1
if is_late; then
  echo "not complete: $(wc -l <"$folder/done") of $(wc -w <<<"$scenes") scenes are measured; a run with the same FOLDER measures the others"
  sed '1,/<!-- table/d' "$folder/readme"
else
  cp "$folder/readme" "$readme"
fi
exit "$status"
