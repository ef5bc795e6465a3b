#!/usr/bin/env bash
# Tests the table that deploy/nightly.sh writes: its counts, failures and skips, and the rows of earlier runs, which --continue keeps. A run
# consists of parts, such as `default` or `arm64`, and the table has a row for each part. Scripts that only print the last lines of a test run
# stand in for the parts.
# Usage: nightly.sh SOURCE-FOLDER
set -euo pipefail
source=$(cd "$1" && pwd)
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
fail() { echo "nightly.sh: $*" >&2; cat out/nightly/table.md >&2; exit 1; }

mkdir "$scratch/deploy" "$scratch/out"
cd "$scratch"
cp "$source/deploy/nightly.sh" deploy/
echo 'bare_possible() { return 1; }' > deploy/bare.sh
cat > deploy/test.sh << 'SCRIPT'
echo " 3/7 Test #9: something .....***Skipped (Skipped)"
echo "71% tests passed, 1 tests failed out of 7"
exit 8
SCRIPT
printf 'echo ran >> out/arm64\necho "100%% tests passed, 0 tests failed out of 4"\n' > deploy/arm64.sh
chmod +x deploy/*.sh
echo /out/ > .gitignore
commit() { git add . && git -c user.name=test -c user.email=test@localhost commit --quiet --allow-empty -m "$1"; }
git init --quiet
commit first

# row PART TEXT: the row of PART must have TEXT after the name. rows N: there must be N rows.
row() { grep -qF "| $1 | $2 |" out/nightly/table.md || fail "no row of $1 with: $2"; }
rows() { [ "$(grep -c '^| [a-z0-9-]* | [pfs][a-z:]*' out/nightly/table.md)" -eq "$1" ] || fail "not $1 rows"; }

! deploy/nightly.sh default arm64 > out/log || fail "a failed part did not fail the run"
row default "failed | 5 | 1 | 1"
row arm64 "passed | 4 | 0 | 0"
rows 2

! deploy/nightly.sh --continue debian13 > out/log || fail "the run passed although it kept the row of a failed part"
row debian13 "skipped: no root or no debootstrap | 0 | 0 | 0"
rows 3
[ "$(wc -l < out/arm64)" -eq 1 ] || fail "a part with a row ran again"
[ "$(sed -n 's/^| \(default\|debian13\|arm64\) .*/\1/p' out/nightly/table.md | tr '\n' ' ')" = "default debian13 arm64 " ] ||
  fail "the rows are not in the order of the parts"

first=$(git describe --always)
commit second
! deploy/nightly.sh --continue arm64 > out/log || fail "the run passed although it kept the row of a failed part of an older commit"
rows 3
grep -qF "| $(git describe --always), " <(grep '^| arm64 ' out/nightly/table.md) || fail "the row does not name its commit"
[ "$(grep -cF "| $first, " out/nightly/table.md)" -eq 2 ] || fail "the kept rows do not name their commit"

deploy/nightly.sh arm64 > out/log || fail "the run failed although its part passed"
rows 1
printf 'echo "100%% tests passed, 0 tests failed out of 2"; echo "1/2 ***Skipped"; printf "\\t 5 - a (Skipped)\\n\\t 6 - b (Skipped)\\n"\n' > deploy/arm64.sh
deploy/nightly.sh arm64 > out/log || fail "a part whose tests were all skipped fails the run"
row arm64 "skipped: each of its tests; see the log | 0 | 0 | 2"
echo "the table is as expected"
