#!/usr/bin/env bash
# Checks that builds by clang (preset clang, -O3) and by gcc at -O2 (preset dev) render pixels with the hashes of same_bits.txt. The
# default tests check a build by gcc at -O3. Each preset has its own build folder. Builds only the programs that the test needs.
# Usage: tests/hard_cases/compilers.sh [PRESET…]      (default: clang dev)
set -euo pipefail
cd "$(dirname "$0")/../.."
presets=("$@")
((${#presets[@]})) || presets=(clang dev)
for preset in "${presets[@]}"; do
  cmake --preset "$preset" -DBANDSAW_TESTS=ON > /dev/null
  cmake --build --preset "$preset" --target same_bits
  "build/$preset/tests/same_bits" --gtest_filter='SameBits.*'
done
