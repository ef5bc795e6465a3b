#!/usr/bin/env bash
# Makes the programs for ARM64 on this machine. Installs the packages that this needs (deploy/install.sh arm64), builds the
# programs for this machine and for ARM64, and runs the tests with the label arm64. The ARM64 programs are then in
# build/arm64/bin.
# Usage: deploy/arm64.sh
set -euo pipefail
cd "$(dirname "$0")/.."

deploy/install.sh arm64
for preset in release arm64; do
  cmake --preset "$preset" -DBANDSAW_TESTS=ON
done
cmake --build --preset release --target bandsaw bandsaw-worker bandsaw-import
cmake --build --preset arm64 --target bandsaw bandsaw-worker bandsaw-import unit_base unit_math unit_kernel same_bits
exec ctest --test-dir build/release --label-regex '^arm64$' --no-tests=error --output-on-failure
