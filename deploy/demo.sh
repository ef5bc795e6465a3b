#!/usr/bin/env bash
# Runs a farm on this machine: installs what is needed, builds, starts a coordinator and three workers on loopback, renders a
# scene with a real model, removes the noise and writes the picture.
# Usage: deploy/demo.sh [FOLDER]
#   FOLDER: where the picture, the scene and the logs are written (default: out/demo)
# BANDSAW_BUILD=DIR: the build to use. If it is set, nothing is installed or built.
# BANDSAW_DEMO_SAMPLES=N: samples per pixel (default: 64).
set -euo pipefail
cd "$(dirname "$0")/.."
folder=${1:-out/demo}
mkdir -p "$folder"
folder=$(cd "$folder" && pwd)

. deploy/build.sh demo
export PATH="$build/bin:$PATH"

cp deploy/demo.textproto "$folder/engine.textproto"
cp /usr/share/assimp/models/glTF2/2CylinderEngine-glTF-Binary/2CylinderEngine.glb "$folder/"
cp renderlib/gallery/{knot.obj,pawn.obj,vase.obj,planet.png,dusk.hdr} "$folder/"

. deploy/loopback.sh
serve_here "$folder/coordinator.log"
for name in anna ben cleo; do
  work_here "$name" "$folder/$name.log" --threads 1
done

bandsaw submit "$folder/engine.textproto" --farm "$data/farm" --samples "${BANDSAW_DEMO_SAMPLES:-64}" \
  --denoise -o "$folder/engine.png"
echo "the picture: $folder/engine.png"
