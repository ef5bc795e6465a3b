#!/usr/bin/env bash
# Checks that a farm of four different machines gives the same bytes as one machine. Two workers run directly: this build's worker, and a worker
# that was built on Debian 13. Two workers are emulated: this build's worker on a processor without AVX2, and a worker for ARM64. Each of the four
# must render a part of the image.
# Usage: tests/machines/run.sh BUILD DEBIAN13 ARM64
#   BUILD     this build's folder
#   DEBIAN13  the root folder of a Debian 13 in which /root/bandsaw is built (made by deploy/nightly.sh debian13)
#   ARM64     the folder of the cross build (made by deploy/arm64.sh)
# Exit status 77: DEBIAN13 or ARM64 has no worker, or this machine cannot run the test (root and qemu-user-static are needed).
set -euo pipefail
cd "$(dirname "$0")/../.."
build=$(realpath "$1") debian13=$2 arm64=$3
lacks() { echo "skipped: $*"; exit 77; }
[ "$(id -u)" -eq 0 ] || lacks "entering Debian 13 needs root"
[ -x "$debian13/root/bandsaw/build/release/bin/bandsaw-worker" ] || lacks "no build in $debian13 (deploy/nightly.sh debian13)"
[ -x "$arm64/bin/bandsaw-worker" ] || lacks "no build in $arm64 (deploy/arm64.sh)"
for emulator in qemu-x86_64-static qemu-aarch64-static; do
  command -v "$emulator" >/dev/null || lacks "$emulator is not installed (deploy/install.sh arm64)"
done

export PATH="$build/bin:$PATH"
. deploy/loopback.sh
mkdir -p "$scratch/logs"
serve_here "$scratch/logs/coordinator"

mkdir -p "$debian13$scratch"
trap 'rm -rf "$debian13$scratch"; stop' EXIT
join_here no-avx2 "$scratch/logs/no-avx2" qemu-x86_64-static -cpu Nehalem "$build/bin/bandsaw-worker" --threads 1
join_here arm64 "$scratch/logs/arm64" qemu-aarch64-static -L "${BANDSAW_ARM64_ROOT:-/}" "$arm64/bin/bandsaw-worker" --threads 1

# same_bytes SCENE SAMPLES renders a scene on the farm and on this machine, and compares the images. The emulated workers are 30 to 100 times
# slower than the other two. The coordinator also gives the bands of slow workers to idle workers (backup tasks), so the fast workers would
# render the whole image alone. Therefore the fast workers join only when both emulated workers have bands in the image, and they leave after
# the job. In the second job the coordinator calls the fast workers NAME-2.
same_bytes() {
  local scene=$1 options=(--width 64 --samples "$2") progress=$scratch/$1.progress emulated=${#pids[@]} name
  : >"$progress"
  bandsaw submit "renderlib/gallery/$scene.textproto" --farm "$data/farm" "${options[@]}" -o "$scratch/farm.pfm" --json >"$progress" &
  local submit=$!
  until grep -q '"workers_used":2' "$progress"; do
    kill -0 "$submit" || { cat "$progress"; exit 1; }
    sleep 0.05
  done
  join_here debian12 "$scratch/logs/debian12" "$build/bin/bandsaw-worker" --threads 1
  join_here debian13 "$scratch/logs/debian13" chroot "$debian13" /root/bandsaw/build/release/bin/bandsaw-worker --threads 1
  wait "$submit"
  kill "${pids[@]:$emulated}"
  wait "${pids[@]:$emulated}" || true
  pids=("${pids[@]:0:$emulated}")
  bandsaw render "renderlib/gallery/$scene.textproto" "${options[@]}" -o "$scratch/here.pfm" --quiet
  cmp "$scratch/farm.pfm" "$scratch/here.pfm"
  for name in debian12 debian13 no-avx2 arm64; do
    grep -qE "\"$name(-2)?\"" "$scratch/farm.json" || { echo "$scene: $name rendered nothing:"; cat "$scratch/farm.json"; exit 1; }
  done
  echo "$scene: the same bytes"
}
same_bytes cornell 256
same_bytes materials 1024
