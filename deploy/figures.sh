#!/usr/bin/env bash
# Makes the comparison figures of the gallery's README again, and the pictures of the main README.
# Usage: deploy/figures.sh samples|defocus|lights|density|tone|strip|all|sheet [FOLDER [WIDTH [SCENE...]]]
#   (default: out/figures, the width of one picture 300)
# strip: the pictures of the main README, each a file of its own, WIDTH pixels wide (default: 480).
# sheet: one picture with thumbnails of all scenes of the gallery, or of the SCENEs. Each thumbnail is at most WIDTH pixels wide
#   (default: 160). Prints the names of the scenes in each row.
# BANDSAW_BUILD=DIR: the build to use (default: build/release).
set -euo pipefail
cd "$(dirname "$0")/.."
name=${1:-}
folder=${2:-out/figures}
case "$name" in sheet) width=${3:-160} ;; strip) width=${3:-480} ;; *) width=${3:-300} ;; esac
export PATH="${BANDSAW_BUILD:-$PWD/build/release}/bin:$PATH"
gallery=renderlib/gallery
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

render() { # SCENE NAME [OPTION...]: renders $work/NAME.png
  bandsaw render "$1" -o "$work/$2.png" --width "$width" --report none --quiet "${@:3}" >/dev/null
}

size_of() { # PNG OFFSET: prints the width (OFFSET 16) or the height (20): four bytes, big-endian.
  echo $((16#$(od -An -tx1 -j"$2" -N4 "$1" | tr -d ' \n')))
}
height_of() { size_of "$1" 20; }

picture() { # NUMBER FILE X Y WIDE HIGH [UV]: prints a quad that emits the picture, its lower left corner at X Y.
  cat <<SCENE
material { name: "m$1"  emissive { texture { image { file: "$2.png"  filter: FILTER_NEAREST  ${7:-} } } } }
shape { quad { corner: [$3, $4, 0]  u: [$5, 0, 0]  v: [0, $6, 0] }  material: "m$1" }
SCENE
}

# Renders the quads in the file $work/panel, before a background of GREY, to the image OUT of WIDTH x HEIGHT pixels. A scene unit is a
# pixel.
panel() { # OUT WIDTH HEIGHT GREY
  cat - "$work/panel" >"$work/panel.textproto" <<SCENE
camera { position: [$(awk "BEGIN { print $2 / 2 \", \" $3 / 2 }"), 1]  rotate { axis: [0, 1, 0]  degrees: 0 }
         orthographic { height: $3 } }
image { width: $2  height: $3  filter { box { radius: 0 } } }
background { constant { rgb: [$4, $4, $4] } }
SCENE
  mkdir -p "$folder"
  bandsaw render "$work/panel.textproto" -o "$folder/$1.png" --samples 1 --report none --quiet >/dev/null
  echo "$folder/$1.png"
}

# Renders OUT, a scene that shows the pictures side by side, pixel for pixel, GAP pixels apart. A
# PICTURE is FILE, or FILE:FROM:TO for a part of it. FROM and TO are fractions of the picture's width.
side_by_side() { # OUT GAP PICTURE...
  local out=$1 gap=$2 x=0 number=0 height file from to wide
  height=$(height_of "$work/${3%%:*}.png")
  for picture in "${@:3}"; do
    IFS=: read -r file from to _ <<<"$picture:0:1"
    wide=$(awk "BEGIN { print int($width * $to + 0.5) - int($width * $from + 0.5) }")
    picture "$number" "$file" "$x" 0 "$wide" "$height" \
      "uv_offset: [$from, 0]  uv_scale: [$(awk "BEGIN { print $wide / $width }"), 1]"
    x=$((x + wide + gap))
    number=$((number + 1))
  done >"$work/panel"
  panel "$out" $((x - gap)) "$height" 1
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

# The left half is rendered without light sampling, so paths hit lamps only by chance. The right half is rendered with it.
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

figure_tone() {
  for tone in none filmic; do render $gallery/environment.textproto "$tone" --samples 256 --tone "$tone"; done
  side_by_side tone 4 none filmic
}

figure_strip() {
  local scenes=(books/one_weekend orthographic motion spheres)
  mkdir -p "$folder"
  for scene in "${scenes[@]}"; do
    render "$gallery/$scene.textproto" strip --height $((width * 5 / 8)) --samples 256 --denoise
    mv "$work/strip.png" "$folder/strip_$(basename "$scene").png"
    echo "$folder/strip_$(basename "$scene").png"
  done
}

# Renders a thumbnail of each scene and puts the thumbnails into rows of 8. Without a SCENE, takes all scenes of the gallery.
figure_sheet() { # [SCENE...]
  local scenes=("$@") high=$((width * 9 / 16)) gap=4 columns=8 number=0 row=-1 rows wide x y
  if [ ${#scenes[@]} = 0 ]; then
    cp -r "$gallery" "$work/gallery"
    bandsaw-gallery "$work/gallery" >/dev/null # makes the globes, which are not in the repository
    scenes=("$work"/gallery/*.textproto "$work"/gallery/{books,hard_light,study}/*.textproto)
  fi
  rows=$(((${#scenes[@]} + columns - 1) / columns))
  : >"$work/panel"
  for scene in "${scenes[@]}"; do
    bandsaw render "$scene" -o "$work/t$number.png" --height "$high" --samples 32 --quiet >/dev/null
    if [ "$(size_of "$work/t$number.png" 16)" -gt "$width" ]; then render "$scene" "t$number" --samples 32; fi
    if [ $((number / columns)) != "$row" ]; then
      row=$((number / columns))
      [ "$row" = 0 ] || echo
      printf 'row %d:' $((row + 1))
    fi
    printf ' %s' "$(basename "$scene" .textproto)"
    wide=$(size_of "$work/t$number.png" 16)
    x=$((number % columns * (width + gap) + (width - wide) / 2))
    y=$(((rows - 1 - row) * (high + gap)))
    picture "$number" "t$number" "$x" "$y" "$wide" "$(height_of "$work/t$number.png")" >>"$work/panel"
    number=$((number + 1))
  done
  echo
  panel sheet $((columns * (width + gap) - gap)) $((rows * (high + gap) - gap)) 0.02
}

case "$name" in
  sheet) figure_sheet "${@:4}" ;;
  samples | defocus | lights | density | tone | strip) "figure_$name" ;;
  all) for each in samples defocus lights density tone strip; do "figure_$each"; done ;;
  *) sed -n 's/^# Usage: /usage: /p' "$0" >&2; exit 2 ;;
esac
