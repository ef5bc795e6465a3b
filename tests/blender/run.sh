#!/usr/bin/env bash
# Tests of the add-on in a real Blender. Usage: run.sh addon|compare|window|command|frames BUILD-FOLDER. Exit 77: Blender or another program is not installed.
#   addon    The installed add-on talks to a coordinator that renders nothing. Tests messages, regions, passes and animations.
#   compare  Cycles, and the add-on on a farm on loopback, render fifteen scenes. The images stay in BUILD-FOLDER/compare.
#   command  `bandsaw render FILE.blend` renders a scene, and a farm renders frames of a .blend file.
#   frames   A farm whose processes are killed renders 48 frames of a skinned model. The vertices must be where Blender places them.
#   window   In a window under Xvfb, F12 starts a render, the picture grows, and Esc cancels it. Screenshots are in BUILD-FOLDER/screenshots.
set -euo pipefail
part=$1
build=$(cd "$2" && pwd)
here=$(cd "$(dirname "$0")" && pwd)
needs() {
  for program in "$@"; do
    command -v "$program" >/dev/null || { echo "skipped: there is no program $program (deploy/install.sh blender)"; exit 77; }
  done
}
needs blender
/usr/bin/python3 -c 'import numpy' 2>/dev/null || { echo "skipped: numpy is not installed (deploy/install.sh blender)"; exit 77; }
work=$(mktemp -d)
finish() {
  [ -f "$work/pids" ] && xargs kill <"$work/pids" 2>/dev/null || true
  wait
  rm -rf "$work"
}
trap finish EXIT
export BLENDER_USER_SCRIPTS=$work/scripts PYTHONDONTWRITEBYTECODE=1 HOME=$work
mkdir -p "$work/scripts" "$work/out"
"$here/../../deploy/blender/make.sh" "$work/addon.zip"

# in_blender SCRIPT [ARGUMENT...] runs a Python file in Blender. If the file fails, the output of Blender is shown.
in_blender() {
  local script=$1
  shift
  blender -b --factory-startup --python-exit-code 1 --python "$script" -- "$@" >"$work/log" 2>&1 || { cat "$work/log"; return 1; }
}

# Starts a coordinator and a worker, and sets BANDSAW_FARM to the join string of users.
start_farm() {
  "$build/bin/bandsaw" serve --data "$work/farm" --listen 127.0.0.1:0 --web 127.0.0.1:0 >"$work/serve.log" 2>&1 &
  echo $! >>"$work/pids"
  until grep -q "^join with" "$work/serve.log"; do
    kill -0 $! || { cat "$work/serve.log"; return 1; }
    sleep 0.1
  done
  "$build/bin/bandsaw-worker" --join "$work/farm/join" --name desk >"$work/worker.log" 2>&1 &
  echo $! >>"$work/pids"
  BANDSAW_FARM=$(cat "$work/farm/farm")
  export BANDSAW_FARM
}

case $part in
  addon)
    in_blender "$here/addon_test.py" "$work/addon.zip"
    grep -E "^(test_|Ran|OK)|triangles in" "$work/log" ;;
  compare)
    start_farm
    images=$build/compare
    rm -rf "$images"
    mkdir -p "$images"
    in_blender "$here/compare.py" "$work/addon.zip" "$images" cycles
    in_blender "$here/compare.py" "$work/addon.zip" "$images" bandsaw
    "$here/judge.sh" "$build/bin/bandsaw" "$images" ;;
  command)
    in_blender "$here/save.py" "$work/out/lens.blend" lens
    "$build/bin/bandsaw" render "$work/out/lens.blend" --samples 4 --report none -o "$work/out/lens.pfm"
    head -c 12 "$work/out/lens.pfm" | grep -q "96 64"
    echo "not a blend file" >"$work/out/bad.blend"
    ! "$build/bin/bandsaw" render "$work/out/bad.blend" --samples 1 -o "$work/out/bad.pfm" 2>"$work/error"
    grep -q "bad.blend: Blender made no scene of it" "$work/error" || { cat "$work/error"; exit 1; }
    [ ! -e "$work/out/bad.pfm" ]
    # The first one of several view layers is rendered. Here the first layer has a green ball in the middle of the image.
    in_blender "$here/save.py" "$work/out/layers.blend" layers
    "$build/bin/bandsaw" render "$work/out/layers.blend" --samples 4 --report none -o "$work/out/layers.pfm" 2>"$work/error"
    grep -q 'only the view layer "ViewLayer" is rendered' "$work/error" || { cat "$work/error"; exit 1; }
    /usr/bin/python3 - "$work/out/layers.pfm" <<'END'
import sys
import numpy
r, g, b = numpy.fromfile(sys.argv[1], "<f4", offset=len(b"PF\n96 64\n-1.0\n")).reshape(64, 96, 3)[32, 48]
assert g > 4 * max(r, b), (r, g, b)
END
    # For a sequence, one process of Blender writes all frames. Each frame must be the same as from
    # a process that writes it alone.
    start_farm
    in_blender "$here/save.py" "$work/out/motion.blend" motion
    "$build/bin/bandsaw" submit "$work/out/motion.blend" --frames 1-3 --samples 4 --report none -o "$work/out/m.#.pfm"
    for frame in 1 2 3; do
      "$build/bin/bandsaw" render "$work/out/motion.blend" --frame $frame --samples 4 --report none -o "$work/out/alone.pfm"
      cmp "$work/out/m.$frame.pfm" "$work/out/alone.pfm"
    done
    cmp -s "$work/out/m.1.pfm" "$work/out/m.3.pfm" && { echo "the frames are equal"; exit 1; }
    ! PATH=$work "$build/bin/bandsaw" render "$work/out/lens.blend" --samples 1 -o "$work/out/none.pfm" 2>"$work/error"
    grep -q "Blender is not installed" "$work/error" || { cat "$work/error"; exit 1; } ;;
  frames)
    needs ffprobe
    "$here/frames.sh" "$build" "$work"
    in_blender "$here/vertices.py" "$work/walk.glb" "$work/walk.npy" 1 48
    mkdir "$work/packages"
    /usr/bin/python3 "$here/vertices_check.py" "$build/bin/bandsaw-import" "$work/walk.glb" "$work/walk.npy" 1 "$work/packages" ;;
  window)
    needs Xvfb xdotool import
    "$here/window.sh" "$work" "$build/screenshots" ;;
  *) echo "usage: run.sh addon|compare|command|frames|window BUILD-FOLDER" >&2; exit 2 ;;
esac
echo "run.sh $part: passed"
