#!/usr/bin/env bash
# Checks that an ARM64 machine computes the same bits as this one. Tests of the cross build run in an emulator. Then the worker of the cross build
# renders on a farm, first alone and then beside a worker of this machine. The images are compared byte by byte with those of `bandsaw render` here.
# Usage: arm64.sh BIN-FOLDER ARM64-BUILD      Exit 77: there is no emulator or no cross build (deploy/arm64.sh makes both).
set -euo pipefail
bin=$(cd "$1" && pwd)
arm=$2
gallery=$(cd "$(dirname "$0")/../../renderlib/gallery" && pwd)
command -v qemu-aarch64-static > /dev/null || { echo "skipped: qemu-aarch64-static is not installed (deploy/install.sh arm64)"; exit 77; }
[ -x "$arm/bin/bandsaw-worker" ] || { echo "skipped: '$arm' is no build for ARM64 (deploy/arm64.sh makes one)"; exit 77; }
arm=$(cd "$arm" && pwd)
export PATH="$bin:$PATH"
. "$(dirname "$0")/../../deploy/loopback.sh"
fail() { echo "arm64.sh: $*" >&2; exit 1; }

for test in unit_base:'Simd.*:Compiler.*:FloatingPointState.*' unit_math:'*' unit_kernel:'*' same_bits:'*'; do
  qemu-aarch64-static "$arm/tests/${test%%:*}" --gtest_filter="${test#*:}" --gtest_brief=1
done

cd "$scratch"
scene=$gallery/materials.textproto
how=(--width 32 --report none --quiet)
serve_here serve.log --web none
compare() {  # SAMPLES: compares a farm's image with that of `render`
  bandsaw render "$scene" "${how[@]}" --samples "$1" -o here.pfm
  bandsaw submit "$scene" --farm "$data/farm" "${how[@]}" --samples "$1" -o farm.pfm
  cmp here.pfm farm.pfm
}
join_here arm arm.log qemu-aarch64-static "$arm/bin/bandsaw-worker" --threads 1
bandsaw workers --farm "$data/farm" > workers
grep -q "neon kernel" workers || fail "the list of workers does not name the kernel: $(cat workers)"
compare 64
work_here here here.log --threads 1
compare 1024  # enough samples that both workers get bands
echo "the same bytes: here, by an ARM64 worker, and by a farm of both architectures"
