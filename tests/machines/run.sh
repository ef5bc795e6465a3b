#!/usr/bin/env bash
# A farm of four machines of different kinds gives the bytes of one: its workers are this build's, Debian 13's, this build's on a
# processor without AVX2 (emulated), and an ARM64 one (emulated). Each must render a part of the image.
# Usage: tests/machines/run.sh BUILD DEBIAN13 ARM64
#   BUILD     this build's folder
#   DEBIAN13  the root folder of a Debian 13 in which /root/bandsaw is built (deploy/nightly.sh debian13 leaves one)
#   ARM64     the folder of the cross build (deploy/arm64.sh leaves one)
# Exit status 77: one of them is not there, or this machine cannot run it (root and qemu-user-static are needed).
set -euo pipefail
cd "$(dirname "$0")/../.."
build=$(realpath "$1") debian13=$2 arm64=$3
lacks() { echo "skipped: $*"; exit 77; }
[ "$(id -u)" -eq 0 ] || lacks "entering Debian 13 needs root"
[ -x "$debian13/root/bandsaw/build/release/bin/bandsaw-worker" ] || lacks "no build in $debian13 (deploy/nightly.sh debian13)"
[ -x "$arm64/bin/bandsaw-worker" ] || lacks "no build in $arm64 (deploy/arm64.sh)"
command -v qemu-x86_64-static qemu-aarch64-static >/dev/null || lacks "qemu-user-static is not installed"

export PATH="$build/bin:$PATH"
. deploy/loopback.sh
mkdir -p "$scratch/logs"
serve_here "$scratch/logs/coordinator"

# joins NAME COMMAND...: starts a worker program by a command, and waits until it has joined.
joins() {
  local log=$scratch/logs/$1
  BANDSAW_JOIN=$(cat "$data/join") "${@:2}" --name "$1" --cache "$scratch/cache-$1" --threads 1 >"$log" 2>&1 &
  pids+=($!)
  until grep -q joined "$log"; do
    kill -0 $! 2>/dev/null || { echo "$1 did not join:"; cat "$log"; exit 1; }
    sleep 0.1
  done
}
mkdir -p "$debian13$scratch"
trap 'rm -rf "$debian13$scratch"; stop' EXIT
joins debian12 "$build/bin/bandsaw-worker"
joins debian13 chroot "$debian13" /root/bandsaw/build/release/bin/bandsaw-worker
joins no-avx2 qemu-x86_64-static -cpu Nehalem "$build/bin/bandsaw-worker"
joins arm64 qemu-aarch64-static -L "${BANDSAW_ARM64_ROOT:-/}" "$arm64/bin/bandsaw-worker"

for scene in cornell materials; do
  options=(--width 64 --samples 64)
  bandsaw submit "renderlib/gallery/$scene.textproto" --farm "$data/farm" "${options[@]}" -o "$scratch/farm.pfm" --quiet
  bandsaw render "renderlib/gallery/$scene.textproto" "${options[@]}" -o "$scratch/here.pfm" --quiet
  cmp "$scratch/farm.pfm" "$scratch/here.pfm"
  for name in debian12 debian13 no-avx2 arm64; do
    grep -q "\"$name\"" "$scratch/farm.json" || { echo "$scene: $name rendered nothing:"; cat "$scratch/farm.json"; exit 1; }
  done
  echo "$scene: the same bytes"
done
