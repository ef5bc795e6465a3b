#!/usr/bin/env bash
# Checks that a machine without AVX2 renders and joins a farm. The programs run on an emulated Nehalem (2008: SSE4.2, no AVX), where any
# newer instruction ends them. The images are compared byte by byte with those of this machine.
# Usage: old_cpu.sh BIN-FOLDER      Exit 77: qemu-user-static is not installed.
set -euo pipefail
bin=$(cd "$1" && pwd)
gallery=$(cd "$(dirname "$0")/../../renderlib/gallery" && pwd)
command -v qemu-x86_64-static > /dev/null || { echo "skipped: qemu-x86_64-static is not installed (deploy/install.sh old_cpu)"; exit 77; }
old=(qemu-x86_64-static -cpu Nehalem)
export PATH="$bin:$PATH"
. "$(dirname "$0")/../../deploy/loopback.sh"
cd "$scratch"
fail() { echo "old_cpu.sh: $*" >&2; exit 1; }

how=(--width 24 --samples 16 --report none --quiet)
bandsaw render "$gallery/materials.textproto" "${how[@]}" -o here.pfm

"${old[@]}" "$bin/bandsaw" render "$gallery/materials.textproto" "${how[@]}" -o old.pfm
cmp here.pfm old.pfm
"${old[@]}" "$bin/bandsaw" render "$gallery/materials.textproto" "${how[@]}" --kernel avx2 -o none.pfm 2> refused && fail "--kernel avx2 was accepted"
grep -q "must be plain, is 'avx2'" refused || fail "--kernel avx2 was refused for another reason: $(cat refused)"
# The importer starts in the emulator. It cannot read scenes there, because the emulator does not support seccomp; so this machine's
# importer reads the scenes.
"${old[@]}" "$bin/bandsaw-import" > usage && fail "bandsaw-import accepted no arguments"
grep -q "usage: bandsaw-import" usage || fail "bandsaw-import does not start: $(cat usage)"

# The farm has one worker, which runs on the emulated processor. This machine coordinates and submits.
serve_here serve.log --web none
join_here old worker.log "${old[@]}" "$bin/bandsaw-worker" --threads 2
bandsaw submit "$gallery/materials.textproto" --farm "$data/farm" "${how[@]}" -o farm.pfm
cmp here.pfm farm.pfm
bandsaw workers --farm "$data/farm" > workers
grep -q "plain kernel" workers || fail "the list of workers does not name the kernel: $(cat workers)"
echo "the same bytes: rendered here, on the emulated processor, and by a farm with a worker on it"
