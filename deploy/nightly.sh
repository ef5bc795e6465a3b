#!/usr/bin/env bash
# Runs the tests that are too long for CI, in parts: every label of CTest, sanitizers, builds by clang, Debian 12 and 13, ARM64, fuzzing
# and more. The script continues after a part that fails, and writes a table with the result of each part: passed, failed or skipped.
# Exit status 1: a part in the table failed.
# Usage: deploy/nightly.sh [--continue] [--fuzz-minutes N] [--calibration-minutes N] [--out FOLDER] [PART...]
#   --continue: keeps the rows of the table that an earlier run wrote to FOLDER, so that the runs of several nights add up to one table.
#      Each row states its commit. If PARTs are given, exactly these run, whether they have a row or not. If none is given, the parts
#      without a row of the present commit run. To go on from the table that is kept in the repository, first copy tests/nightly.md to
#      FOLDER/table.md.
#   --fuzz-minutes N: minutes for each fuzz target (default: 1)
#   --calibration-minutes N: minutes for the calibration (default: 60). The next run continues where it stopped, in build/calibration.
#   --out FOLDER: where table.md and a log for each part are written (default: out/nightly)
#   PART: parts to run: default labels wasm browser blender asan-ubsan tsan clang fuzz debian12 debian13 compilers arm64 machines calibration
#         (default: all, in this order; about seven hours on two cores)
# A part whose requirements this machine lacks (root, debootstrap) is skipped, and the table states the reason. A compiler and a browser
# are installed if they are missing.
set -uo pipefail
cd "$(dirname "$0")/.."
. deploy/bare.sh

every_part=(default labels wasm browser blender asan-ubsan tsan clang fuzz debian12 debian13 compilers arm64 machines calibration)
fuzz_minutes=1
calibration_minutes=60
out=out/nightly
continues=
usage() { sed -n 's/^# Usage: /usage: /p; s/^#   \(PART\)/  \1/p' "$0" >&2; exit 2; }
while [ $# -gt 0 ]; do
  case $1 in
    --continue) continues=1; shift ;;
    --fuzz-minutes | --calibration-minutes)
      case ${2:-} in '' | *[!0-9]*) usage ;; esac
      if [ "$1" = --fuzz-minutes ]; then fuzz_minutes=$2; else calibration_minutes=$2; fi
      shift 2 ;;
    --out) out=${2:?}; shift 2 ;;
    -*) usage ;;
    *) break ;;
  esac
done
for part in "$@"; do
  case " ${every_part[*]} " in *" $part "*) ;; *) usage ;; esac
done
mkdir -p "$out"
out=$(cd "$out" && pwd)
table=$out/table.md
commit=$(git describe --always --dirty)
readonly kSkipped=77  # as CTest's SKIP_RETURN_CODE

skip() { echo "skipped: $*"; exit $kSkipped; }
# tests BUILD-FOLDER CTEST-OPTION...: runs the tests. `row` reads CTest's summary in the log.
tests() { ctest --test-dir "$1" --no-tests=error --output-on-failure --parallel "$(nproc)" "${@:2}"; }
# preset NAME TARGET...: configures and builds.
preset() {
  cmake --preset "$1" -DBANDSAW_TESTS=ON && cmake --build --preset "$1" --target "${@:2}"
}

part_default() { deploy/test.sh --strict; }

part_labels() {
  preset release hard_cases unit_scheduler farm && tests build/release --label-regex '^(hard_cases_full|simulation_full|schedules_full)$'
}

# Runs before part_browser, whose browsers load the module that this part builds.
part_wasm() {
  deploy/wasm.sh && preset release bandsaw bandsaw-import wasm_native gallery && tests build/release --label-regex '^wasm$'
}

part_browser() { deploy/install.sh browser && preset release browser && tests build/release --label-regex '^browser$'; }

part_blender() {
  deploy/install.sh blender && preset release bandsaw bandsaw-worker bandsaw-import && tests build/release --label-regex '^blender$'
}

part_asan-ubsan() {
  export LSAN_OPTIONS="suppressions=$PWD/tests/lsan_suppressions.txt"
  preset asan-ubsan all && tests build/asan-ubsan --label-regex '^default$'
}

# The system's libraries are not built for ThreadSanitizer, which therefore does not see the libraries' locks. So the option
# ignore_noninstrumented_modules lets it ignore the libraries' accesses to memory.
# Two groups of tests are left out: one reads JSON into protobuf's Struct, whose layout in the library differs from that in a program
# built for ThreadSanitizer; one starts a worker without TSAN_OPTIONS and compares its last message.
part_tsan() {
  export TSAN_OPTIONS="suppressions=$PWD/tests/tsan_suppressions.txt:ignore_noninstrumented_modules=1"
  preset tsan unit_scheduler unit_store unit_engine unit_worker farm &&
    tests build/tsan --label-regex '^(tsan|farm)$' --exclude-regex '^(ReportOf.*|Invite\.ReportsWhyAWorkerCannotJoin)$'
}

part_clang() {
  deploy/install.sh clang && preset clang all && tests build/clang --label-regex '^default$'
}

part_fuzz() {
  export LSAN_OPTIONS="suppressions=$PWD/tests/lsan_suppressions.txt"
  deploy/install.sh clang && cmake --preset fuzz -DBANDSAW_TESTS=ON -DBANDSAW_FUZZ_SECONDS=$((fuzz_minutes * 60)) &&
    cmake --build --preset fuzz --target fuzz_targets && tests build/fuzz --label-regex '^fuzz$'
}

# debian RELEASE: runs both commands of the README in a fresh clone on the bare system.
debian() {
  bare_possible || skip "no root or no debootstrap"
  local root=$PWD/build/$1
  bare_make "$root" "$1" && bare_clone "$root" && bare_run "$root" 'cd bandsaw; deploy/demo.sh; deploy/test.sh'
  local status=$?
  bare_close "$root"
  return $status
}
part_debian12() { debian bookworm; }
part_debian13() { debian trixie; }

# Checks that builds by both compilers of both Debian releases, and a build with a lower optimisation level, render images with the hashes
# of tests/hard_cases/same_bits.txt.
part_compilers() {
  deploy/install.sh clang && tests/hard_cases/compilers.sh clang dev || return
  bare_possible || skip "Debian 13's compilers: no root or no debootstrap"
  local root=$PWD/build/trixie
  bare_make "$root" trixie && bare_clone "$root" &&
    bare_run "$root" 'cd bandsaw; deploy/install.sh clang; tests/hard_cases/compilers.sh clang release'
  local status=$?
  bare_close "$root"
  return $status
}

part_arm64() { deploy/arm64.sh; }

# Runs a farm of all kinds of machines, with the programs that debian13 and arm64 built.
part_machines() {
  bare_possible || skip "no root or no debootstrap"
  preset release bandsaw bandsaw-worker bandsaw-import && tests build/release --label-regex '^machines$'
}

part_calibration() {
  preset release bandsaw bandsaw-import bandsaw-gallery &&
    tests/statistical/calibrate.sh build/release/bin/bandsaw build/calibration --minutes "$calibration_minutes"
}

# count SED-SCRIPT FILE: prints the sum of the numbers that the script prints for the file.
count() { sed -n "$1" "$2" | awk '{ sum += $1 } END { print sum + 0 }'; }

# row PART STATUS SECONDS LOG: prints a line of the table. Counts come from CTest's summary in the log.
row() {
  local state=failed log=$4 total failed skipped
  [ "$2" -ne 0 ] || state=passed
  [ "$2" -ne $kSkipped ] || state="skipped: $(sed -n 's/^skipped: //p' "$log" | tail -n 1)"
  total=$(count 's/.*tests failed out of \([0-9]*\)$/\1/p' "$log")
  failed=$(count 's/.*, \([0-9]*\) tests failed out of .*/\1/p' "$log")
  skipped=$(grep -c '(Skipped)$' "$log")
  [ "$state" != passed ] || [ "$skipped" -eq 0 ] || [ "$skipped" -ne "$total" ] || state="skipped: each of its tests; see the log"
  printf '| %s | %s | %d | %d | %d | %d:%02d | %s, %s | `%s` |\n' "$1" "$state" $((total - failed - skipped)) "$failed" "$skipped" \
    $(($3 / 3600)) $(($3 / 60 % 60)) "$commit" "$(date --utc +%Y-%m-%d)" "$(basename "$log")"
}

# The row of each part. A row that was made from uncommitted changes counts for no commit, so its part runs again.
declare -A rows=()
if [ -n "$continues" ]; then
  for part in "${every_part[@]}"; do rows[$part]=$(grep -sm1 "^| $part |" "$table"); done
fi
if [ $# -eq 0 ]; then
  for part in "${every_part[@]}"; do
    [[ $commit != *-dirty && ${rows[$part]-} == *"| $commit, "* ]] || set -- "$@" "$part"
  done
fi

# write_table: writes the table of all rows, in the order of the parts.
write_table() {
  {
    echo "# $(nproc) cores"
    echo
    echo "| part | result | tests passed | failed | skipped | hours | commit, day | log |"
    echo "| --- | --- | --- | --- | --- | --- | --- | --- |"
    for part in "${every_part[@]}"; do [ -z "${rows[$part]-}" ] || echo "${rows[$part]}"; done
  } >"$table"
}

write_table
trap 'echo "stopped; so far:"; cat "$table"; exit 130' INT TERM
for part in "$@"; do
  log=$out/$part.log
  echo "$part …"
  begun=$SECONDS
  ("part_$part") >"$log" 2>&1 </dev/null
  status=$?
  rows[$part]=$(row "$part" "$status" $((SECONDS - begun)) "$log")
  echo "${rows[$part]}"
  write_table
done
echo
cat "$table"
! grep -q '^| [^|]* | failed |' "$table"
