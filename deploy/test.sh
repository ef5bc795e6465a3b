#!/usr/bin/env bash
# Builds everything, then runs the tests that have one of the LABELs. Without a LABEL it runs the tests that have the label `default`.
# Usage: deploy/test.sh [--strict] [LABEL...]    (--strict: the compilers' warnings are errors)
set -euo pipefail
cd "$(dirname "$0")/.."
strict=OFF
if [ "${1:-}" = --strict ]; then strict=ON; shift; fi

deploy/install.sh test
cmake --preset release -DBANDSAW_TESTS=ON -DCMAKE_COMPILE_WARNING_AS_ERROR="$strict"
cmake --build --preset release
if [ $# -eq 0 ]; then
  set -- default
fi
labels=$(IFS='|'; echo "$*")
exec ctest --test-dir build/release --label-regex "^($labels)\$" --no-tests=error --output-on-failure \
  --parallel "$(nproc)"
