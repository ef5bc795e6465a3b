#!/usr/bin/env bash
# The comparison figures of the gallery's README, made again.
# Usage: deploy/figures.sh samples|defocus|lights|density|all [FOLDER [WIDTH]]   (default: out/figures, the width of one picture 300)
# BANDSAW_BUILD=DIR: the build to use; otherwise build/release.
set -euo pipefail
cd "$(dirname "$0")/.."
name=${1:-}
folder=${2:-out/figures}
width=${3:-300}
export PATH="${BANDSAW_BUILD:-$PWD/build/release}/bin:$PATH"
gallery=renderlib/gallery
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

render() { # SCENE NAME [OPTION...]: $work/NAME.png
  bandsaw render "$1" -o "$work/$2.png" --width "$width" --quiet "${@:3}" >/dev/null
}

height_of() { # The height of a PNG: bytes 20 to 23, big-endian.
  echo $((16#$(od -An -tx1 -j20 -N4 "$1" | tr -d ' \n')))
}

# A scene of its own shows the pictures side by side, pixel for pixel. A picture is FILE, or FILE:FROM:TO for a part of its width.
side_by_side() { # OUT GAP PICTURE...
  local out=$1 gap=$2 x=0 number=0 height file from to wide
  height=$(height_of "$work/${3%%:*}.png")
  for picture in "${@:3}"; do
    IFS=: read -r file from to _ <<<"$picture:0:1"
    wide=$(awk "BEGIN { print int($width * $to + 0.5) - int($width * $from + 0.5) }")
    cat <<SCENE
material { name: "m$number"  emissive { texture { image { file: "$file.png"  filter: FILTER_NEAREST  uv_offset: [$from, 0]
           uv_scale: [$(awk "BEGIN { print $wide / $width }"), 1] } } } }
shape { quad { corner: [$x, 0, 0]  u: [$wide, 0, 0]  v: [0, $height, 0] }  material: "m$number" }
SCENE
    x=$((x + wide + gap))
    number=$((number + 1))
  done >"$work/panel"
  x=$((x - gap))
  cat - "$work/panel" >"$work/panel.textproto" <<SCENE
camera { position: [$(awk "BEGIN { print $x / 2 \", \" $height / 2 }"), 1]  rotate { axis: [0, 1, 0]  degrees: 0 }
         orthographic { height: $height } }
image { width: $x  height: $height  filter { box { radius: 0 } } }
background { constant { rgb: [1, 1, 1] } }
SCENE
  mkdir -p "$folder"
  bandsaw render "$work/panel.textproto" -o "$folder/$out.png" --samples 1 --quiet >/dev/null
  echo "$folder/$out.png"
}

figure_samples() {
  for n in 1 10 250; do render $gallery/glass_and_metal.textproto "s$n" --samples "$n"; done
  side_by_side samples 4 s1 s10 s250
}

figure_defocus() {
  sed 's/aperture: [0-9.]*/aperture: 0/' $gallery/defocus.textproto >"$work/pinhole.textproto"
  render $gallery/defocus.textproto lens --samples 256
  render "$work/pinhole.textproto" pinhole --samples 256
  side_by_side defocus 4 lens pinhole
}

figure_lights() {
  render $gallery/cornell.textproto chance --samples 16 --integrator path_scattering
  render $gallery/cornell.textproto asked --samples 16
  side_by_side lights 0 chance:0:0.5 asked:0.5:1
}

figure_density() {
  cp $gallery/cube.obj "$work/"
  for density in 0.0025 0.01 0.04; do
    sed "s/density: 0.01/density: $density/" $gallery/smoke.textproto >"$work/smoke.textproto"
    render "$work/smoke.textproto" "$density" --samples 256
  done
  side_by_side density 4 0.0025 0.01 0.04
}

case "$name" in
  samples | defocus | lights | density) "figure_$name" ;;
  all) for each in samples defocus lights density; do "figure_$each"; done ;;
  *) sed -n 's/^# Usage: /usage: /p' "$0" >&2; exit 2 ;;
esac
