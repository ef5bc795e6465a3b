#!/usr/bin/env bash
# Tests the add-on in a window of Blender under Xvfb. F12 must start a render at a fake coordinator (window_test.py). The
# render takes two minutes. The picture must grow in the window, and Esc must cancel the job. Usage: window.sh WORK-FOLDER SCREENSHOTS-FOLDER
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
blender --factory-startup --window-geometry 0 0 1280 800 --no-window-focus --python-exit-code 1 --python "$here/window_test.py" -- "$work/addon.zip" "$work/state" >"$work/log" 2>&1 &
blender=$!
echo $blender >>"$work/pids"

# state WORD waits until window_test.py, which runs in Blender, has written this word.
state() {
  until grep -q "^$1" "$work/state" 2>/dev/null; do
    kill -0 $blender 2>/dev/null || { cat "$work/log" "$work/state"; exit 1; }
    sleep 0.1
  done
}
# middle SCREENSHOT FILE writes the middle of the screenshot, where Blender shows the picture, to a file.
middle() { convert "$1" -crop 500x300+390+266 +repage "$2"; }
# is_coloured FILE: the picture of the fake coordinator is coloured, and Blender's background is grey.
is_coloured() { awk "BEGIN { exit !($(convert "$1" -colorspace HSL -channel G -separate -format '%[fx:mean]' info:) > 0.2) }"; }

state ready
xdotool mousemove 640 400
xdotool key F12
state looked
for ((i = 0; ; ++i)); do
  import -window root "$shots/blender_growing.png"
  middle "$shots/blender_growing.png" "$work/first.png"
  is_coloured "$work/first.png" && break
  ((i < 100)) || { echo "the picture does not come"; exit 1; }
  sleep 0.2
done
for ((i = 0; ; ++i)); do
  import -window root "$shots/blender_grown.png"
  middle "$shots/blender_grown.png" "$work/second.png"
  is_coloured "$work/second.png" && ! cmp -s "$work/first.png" "$work/second.png" && break
  ((i < 100)) || { echo "the picture does not grow"; exit 1; }
  sleep 0.2
done
xdotool key Escape
state cancelled
import -window root "$shots/blender_cancelled.png"
cat "$work/state"
