#!/usr/bin/env bash
# Measures Bandsaw on this machine: the speed of its kernel, which traces rays, against Embree; the error of images against
# time; the growth of time and memory with the size of a scene; the efficiency against Cycles; and the cost of each feature
# of a scene. --quick leaves out Cycles and the cost of features, and takes fewer meshes and samples.
# Usage: deploy/bench.sh [--quick] [FOLDER]    (default out/bench; about a quarter of an hour on two cores, --quick: two minutes)
# Writes to the folder: bench.md (all tables), kernel.txt, study.csv, study.svg, growth.json, growth_*.svg.
# Embree's columns are included if libembree-dev is installed, and Cycles' lines if blender is installed.
# BANDSAW_BUILD=DIR: the build to use; without it, the script makes and uses build/release.
set -euo pipefail
cd "$(dirname "$0")/.."
quick=
if [ "${1:-}" = --quick ]; then quick=--quick; shift; fi
folder=${1:-out/bench}
case "$folder" in -*) echo "usage: deploy/bench.sh [--quick] [FOLDER]" >&2; exit 2 ;; esac
build=${BANDSAW_BUILD:-build/release}
mkdir -p "$folder"

if [ -z "${BANDSAW_BUILD:-}" ]; then
  cmake --preset release -DBANDSAW_TESTS=ON >/dev/null
fi
cmake --build "$build" --target bandsaw bandsaw-import kernel_bench features_bench growth_bench

gallery=renderlib/gallery
if [ -n "$quick" ]; then
  meshes=(icosphere) samples=64 seeds=2
else
  meshes=() samples=256 seeds=4  # no meshes: all meshes of kernel_bench
fi

section() { printf '\n## %s\n\n' "$1"; }
{
  printf '# %s, %s threads, %s\n' "$(sed -n 's/^model name[^:]*: //p' /proc/cpuinfo | head -1)" "$(nproc)" "$(git describe --always --dirty)"
  section 'The kernel: millions of rays a second, and the speed of Bandsaw divided by that of Embree'
  echo '```'
  "$build/tests/kernel_bench" "${meshes[@]}" | tee "$folder/kernel.txt"
  echo '```'
  section 'Error against time'
  "$build/bin/bandsaw" study --samples "$samples" --seeds "$seeds" --quiet -o "$folder/study.csv" -o "$folder/study.svg" \
    "$gallery/cornell.textproto" "$gallery/spheres.textproto" "$gallery/mesh.textproto" "$gallery/books/one_weekend.textproto"
  section 'Growth of time and memory with the size of a scene'
  "$build/tests/growth_bench" $quick "$folder"
  if [ -z "$quick" ]; then
    section 'Efficiency of Bandsaw and of Cycles'
    tests/bench/peers.sh "$build/bin/bandsaw"
    section 'Cost of each feature for a scene that does not use it'
    "$build/tests/features_bench" "$gallery/cornell.textproto" "$gallery/spheres.textproto" "$gallery/mesh.textproto"
  fi
} | tee "$folder/bench.md"
