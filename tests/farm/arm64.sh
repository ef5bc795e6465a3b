#!/usr/bin/env bash
# An ARM64 machine gives the same bits: tests of the cross build run in an emulator, and its worker joins a farm beside one of this
# machine. Files are compared byte by byte with those of `bandsaw render` here.
# Usage: arm64.sh BIN-FOLDER ARM64-BUILD      Exit 77: there is no emulator or no cross build (deploy/arm64.sh makes both).
set -euo pipefail
bin=$(cd "$1" && pwd)
arm=$2
gallery=$(cd "$(dirname "$0")/../../renderlib/gallery" && pwd)
command -v qemu-aarch64-static > /dev/null || { echo "skipped: qemu-aarch64-static is not installed (deploy/install.sh arm64)"; exit 77; }
[ -x "$arm/bin/bandsaw-worker" ] || { echo "skipped: '$arm' is no build for ARM64 (deploy/arm64.sh makes one)"; exit 77; }
arm=$(cd "$arm" && pwd)
work=$(mktemp -d)
jobs=()
trap 'for job in "${jobs[@]}"; do kill "$job" 2> /dev/null || true; wait "$job" 2> /dev/null || true; done; rm -rf "$work"' EXIT
fail() { echo "arm64.sh: $*" >&2; exit 1; }

for test in unit_base:'Simd.*:Compiler.*:FloatingPointState.*' unit_math:'*' unit_kernel:'*' same_bits:'*'; do
  qemu-aarch64-static "$arm/tests/${test%%:*}" --gtest_filter="${test#*:}" --gtest_brief=1
done

cd "$work"
scene=$gallery/materials.textproto
how=(--width 32 --report none --quiet)
"$bin/bandsaw" serve --data farm --listen 127.0.0.1:0 --web none > serve.log 2>&1 &
jobs+=($!)
for _ in $(seq 600); do [ -s farm/farm ] && break; sleep 0.1; done
[ -s farm/farm ] || fail "the coordinator did not start: $(cat serve.log)"
join() {  # NAME COMMAND...: waits until the worker has joined
  local name=$1
  shift
  "$@" --join farm/join --name "$name" --cache "cache-$name" --threads 1 > "$name.log" 2>&1 &
  jobs+=($!)
  for _ in $(seq 600); do grep -q "joined" "$name.log" && return; sleep 0.1; done
  fail "$name did not join: $(cat "$name.log")"
}
compare() {  # SAMPLES: a farm's image and that of `render`
  "$bin/bandsaw" render "$scene" "${how[@]}" --samples "$1" -o here.pfm
  "$bin/bandsaw" submit "$scene" --farm farm/farm "${how[@]}" --samples "$1" -o farm.pfm
  cmp here.pfm farm.pfm
}
join arm qemu-aarch64-static "$arm/bin/bandsaw-worker"
"$bin/bandsaw" workers --farm farm/farm > workers
grep -q "neon kernel" workers || fail "the list of workers does not name the kernel: $(cat workers)"
compare 64
join here "$bin/bandsaw-worker"
compare 1024  # enough for both
echo "the same bytes: here, by an ARM64 worker, and by a farm of both architectures"
