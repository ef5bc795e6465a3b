#!/usr/bin/env bash
# Compares the hashes of same_bits.txt with builds by clang (preset clang, -O3) and by gcc at -O2 (preset dev), each in its own build
# folder; the default tests compare gcc at -O3. Builds only the programs that the test needs.
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
