#!/usr/bin/env bash
# A farm on this machine: installs what is needed, builds, starts a coordinator and three workers on loopback, renders a scene
# with a real model and leaves the picture.
# Usage: deploy/demo.sh [FOLDER]   (default: out/demo; picture, scene and logs are left there)
# BANDSAW_BUILD=DIR: use that build; nothing is installed or built.
set -euo pipefail
cd "$(dirname "$0")/.."
folder=${1:-out/demo}

. deploy/build.sh demo
export PATH="$build/bin:$PATH"

mkdir -p "$folder"
cp deploy/demo.textproto "$folder/engine.textproto"
cp /usr/share/assimp/models/glTF2/2CylinderEngine-glTF-Binary/2CylinderEngine.glb "$folder/"
cp renderlib/gallery/{knot.obj,pawn.obj,vase.obj,planet.png,dusk.hdr} "$folder/"

data=$(mktemp -d)
pids=()
stop() {
  kill "${pids[@]}" 2>/dev/null || true
  wait 2>/dev/null || true
  rm -rf "$data"
}
trap stop EXIT

bandsaw serve --data "$data" --listen 127.0.0.1:0 >"$folder/coordinator.log" 2>&1 &
pids+=($!)
until [ -s "$data/join" ]; do
  kill -0 "${pids[0]}" 2>/dev/null || { cat "$folder/coordinator.log" >&2; exit 1; }
  sleep 0.05
done
for name in anna ben cleo; do
  bandsaw-worker --join "$data/join" --name "$name" --threads 1 --cache "$data/cache-$name" \
    >"$folder/$name.log" 2>&1 &
  pids+=($!)
done

bandsaw submit "$folder/engine.textproto" --farm "$data/farm" --samples "${BANDSAW_DEMO_SAMPLES:-64}" \
  -o "$folder/engine.png"
echo "the picture: $PWD/$folder/engine.png"
