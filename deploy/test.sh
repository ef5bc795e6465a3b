#!/usr/bin/env bash
# Builds everything and runs the tests: those of the label `default`, or of the labels given.
# Usage: deploy/test.sh [LABEL...]
set -euo pipefail
cd "$(dirname "$0")/.."

deploy/install.sh test
cmake --preset release -DBANDSAW_TESTS=ON
cmake --build --preset release
if [ $# -eq 0 ]; then
  set -- default
fi
labels=$(IFS='|'; echo "$*")
exec ctest --test-dir build/release --label-regex "^($labels)\$" --no-tests=error --output-on-failure \
  --parallel "$(nproc)"
