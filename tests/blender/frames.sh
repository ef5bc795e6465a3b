#!/usr/bin/env bash
# Renders a walk of 48 frames with motion blur (walk.py) on three workers. One worker is killed; the coordinator is killed and restarted.
# Checks that each frame has the bytes of `bandsaw render --frame N`, that none is rendered twice, and that the video has 48 frames.
# run.sh calls this script and then compares the positions of the vertices with Blender's.
# Usage: frames.sh BUILD-FOLDER WORK-FOLDER. Appends the ids of the processes that the caller must end to WORK-FOLDER/pids.
set -euo pipefail
build=$1 work=$2
here=$(cd "$(dirname "$0")" && pwd)
bandsaw=$build/bin/bandsaw
settings=(--fps 24 --shutter 0.5 --width 64 --height 48 --samples 256)
/usr/bin/python3 "$here/walk.py" "$work/walk.glb"

# serve ADDRESS:PORT STARTS starts the coordinator, and waits until its log shows that it has started STARTS times.
serve() {
  "$bandsaw" serve --data "$work/walk" --listen "$1" --web none >>"$work/serve.log" 2>&1 &
  coordinator=$!
  echo $coordinator >>"$work/pids"
  until [ "$(grep -c '^join with' "$work/serve.log")" = "$2" ]; do
    kill -0 $coordinator || { cat "$work/serve.log"; exit 1; }
    sleep 0.1
  done
}
frames_written() { find "$work/frames" -name 'w.*.pfm' | wc -l; }
# wait_for_frames NUMBER waits until this number of frames is written.
wait_for_frames() {
  until [ "$(frames_written)" -ge "$1" ]; do
    kill -0 $submitter || { cat "$work/submit.log"; exit 1; }
    sleep 0.05
  done
}

mkdir -p "$work/frames"
: >"$work/serve.log"
serve 127.0.0.1:0 1
address=$(sed -n 's/.*bsw1-w-\([0-9.:]*\)-.*/\1/p' "$work/walk/join" | head -1)
for name in one two three; do
  "$build/bin/bandsaw-worker" --join "$work/walk/join" --name $name --threads 1 --cache "$work/cache-$name" >"$work/$name.log" 2>&1 &
  worker=$!
  echo $worker >>"$work/pids"
  [ $name = two ] && second=$worker
done
"$bandsaw" submit "$work/walk.glb" --farm "$work/walk/farm" --frames 1-48 "${settings[@]}" -o "$work/frames/w.####.pfm" --video "$work/walk.mp4" \
  --contact-sheet "$work/sheet.png" >"$work/submit.log" 2>&1 &
submitter=$!
echo $submitter >>"$work/pids"
wait_for_frames 6
kill -9 $second
wait_for_frames 16
kill -9 $coordinator
at_kill=$(frames_written)
[ "$at_kill" -lt 48 ] || { echo "all frames were done before the coordinator was killed"; exit 1; }
serve "${address:-127.0.0.1:0}" 2
wait $submitter || { cat "$work/submit.log"; exit 1; }

[ "$(frames_written)" = 48 ]
for number in $(seq -w 1 48); do
  "$bandsaw" render "$work/walk.glb" --frame $((10#$number)) "${settings[@]}" --report none --quiet -o "$work/alone.pfm" >"$work/render.log" 2>&1 ||
    { cat "$work/render.log"; exit 1; }
  cmp "$work/frames/w.00$number.pfm" "$work/alone.pfm"
done
for number in $(seq 1 48); do
  [ "$(grep -cE "added name=.* frame=$number of=" "$work/serve.log")" = 1 ] || { echo "frame $number was not rendered exactly once"; exit 1; }
done
[ "$(ffprobe -v error -count_frames -show_entries stream=nb_read_frames -of csv=p=0 "$work/walk.mp4")" = 48 ]
echo "48 frames: a worker was killed after 6, the coordinator after $at_kill"
