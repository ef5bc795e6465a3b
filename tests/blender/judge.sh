#!/usr/bin/env bash
# Compares the images that compare.py has written. Usage: judge.sh BANDSAW FOLDER. If the materials and lights of a scene are defined alike in both
# renderers, the means of the images must agree within 2 %. For the other scenes deploy/blender/README.md explains the larger difference.
set -euo pipefail
bandsaw=$1 folder=$2 failed=0
# Prints the largest difference of the means that is allowed for a scene, in percent.
allowed() {
  case $1 in
    principled) echo 3 ;;  # Principled of Blender 3.4 adds its reflection to the diffuse part
    normals) echo 4 ;;     # Bump Map Correction of Blender 4 darkens bent normals
    *) echo 2 ;;
  esac
}
for cycles in "$folder"/*.cycles.exr; do
  name=$(basename "$cycles" .cycles.exr)
  bias=$("$bandsaw" compare "$folder/$name.bandsaw.exr" "$cycles" | sed -n 's/^bias \([-+0-9.e]*\) %.*/\1/p')
  verdict=$(awk -v b="$bias" -v most="$(allowed "$name")" 'BEGIN { if (b < 0) b = -b; print b <= most ? "same" : "DIFFERENT" }')
  printf '%-14s %8s %% (at most %s %%) %s\n' "$name" "$bias" "$(allowed "$name")" "$verdict"
  [ "$verdict" = same ] || failed=1
done
exit $failed
