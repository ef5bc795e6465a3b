#!/usr/bin/env bash
# Makes the zip of the add-on for Blender, with deploy/python/bandsaw.py in it. Usage: make.sh [FILE.zip] (default: out/bandsaw_blender.zip)
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
out=$(realpath -m "${1:-$here/../../out/bandsaw_blender.zip}")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir -p "$(dirname "$out")" "$work/bandsaw_blender"
cp "$here"/bandsaw_blender/*.py "$here/../python/bandsaw.py" "$work/bandsaw_blender/"
# Fixed times, so that the same sources make the same bytes.
(cd "$work" && cmake -E tar cf bandsaw_blender.zip --format=zip --mtime="2026-01-01 00:00:00" bandsaw_blender)
mv "$work/bandsaw_blender.zip" "$out"
