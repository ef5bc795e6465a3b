#!/usr/bin/env bash
# Blender in a window under Xvfb: F12 begins a render at a coordinator that takes 12 seconds for it, the picture grows in the window, and
# Esc cancels the job. Usage: window.sh WORK-FOLDER SCREENSHOTS-FOLDER
set -euo pipefail
work=$1 shots=$2
here=$(cd "$(dirname "$0")" && pwd)
mkdir -p "$shots"
display=$((100 + RANDOM % 400))
Xvfb ":$display" -screen 0 1280x800x24 >/dev/null 2>&1 &
echo $! >>"$work/pids"
export DISPLAY=:$display LIBGL_ALWAYS_SOFTWARE=1
until xdotool getdisplaygeometry >/dev/null 2>&1; do sleep 0.1; done
rm -f "$work/state"
blender --factory-startup --window-geometry 0 0 1280 800 --no-window-focus --python "$here/window_test.py" -- "$work/addon.zip" "$work/state" >"$work/log" 2>&1 &
blender=$!
echo $blender >>"$work/pids"

# Waits until the script in Blender has written a word.
state() {
  until grep -q "^$1" "$work/state" 2>/dev/null; do
    kill -0 $blender 2>/dev/null || { cat "$work/log" "$work/state"; exit 1; }
    sleep 0.1
  done
}
state ready
xdotool mousemove 640 400
xdotool key F12
state quarter
import -window root "$shots/blender_quarter.png"
state half
import -window root "$shots/blender_half.png"
cmp -s "$shots/blender_quarter.png" "$shots/blender_half.png" && { echo "the window has not changed"; exit 1; }
xdotool key Escape
state cancelled
import -window root "$shots/blender_cancelled.png"
cat "$work/state"
