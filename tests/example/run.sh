#!/usr/bin/env bash
# Installs the renderer into a fresh folder, builds the example against it as an external user would, and compares its picture with
# that of `bandsaw render`, byte by byte. Usage: run.sh BUILD-FOLDER
set -euo pipefail
build=$(cd "$1" && pwd)
example=$(cd "$(dirname "$0")" && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# If the library was built with sanitizers, a program that uses it must be built with them too.
sanitizers=$(sed -n 's/^BANDSAW_SANITIZE:STRING=//p' "$build/CMakeCache.txt")
cmake --install "$build" --component development --prefix "$work/prefix" >/dev/null
cmake -G Ninja -S "$example" -B "$work/build" -DCMAKE_PREFIX_PATH="$work/prefix" -DCMAKE_BUILD_TYPE=Release \
  -DCMAKE_CXX_FLAGS="${sanitizers:+-fsanitize=$sanitizers}" >/dev/null
cmake --build "$work/build" >"$work/log" || { cat "$work/log"; exit 1; }
cd "$work"
build/ball
"$build/bin/bandsaw" render "$example/ball.textproto" --samples 16 -o same.pfm --report none --quiet
cmp ball.pfm same.pfm
