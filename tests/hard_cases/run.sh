#!/usr/bin/env bash
# Runs every hard case with its full number of tries and writes the figures into README.md's table.
# Usage: tests/hard_cases/run.sh [BUILD_FOLDER [IDS]]      (default build/release; built with BANDSAW_TESTS=ON)
# IDS: run only these cases, for example "A4|A5". The other cases keep their figures of the previous run in this build folder.
set -euo pipefail
cd "$(dirname "$0")/../.."
build=${1:-build/release}
folder=tests/hard_cases
kept=$build/hard_case_figures
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# Runs the tests whose names contain an id. The program hard_cases has two entries in CTest. The entry with few tries is excluded.
ids=${2:-[STQBOCXMLVRAPY][0-9]+|TX[0-9]+}
status=0
ctest --test-dir "$build" --no-tests=error --parallel "$(nproc)" --extra-verbose \
  --tests-regex "\.([A-Z]+[0-9]+)*($ids)([^0-9]|$)" --label-exclude '^hard_cases$' > "$work/log" || status=$?
# Tests end in any order. So the figures are sorted by the numbers of the tests.
sed -n 's/^\([0-9]*\): \(\[ case .*\)$/\1 \2/p' "$work/log" | sort --stable --numeric-sort --key=1,1 | cut -d ' ' -f 2- > "$work/new"
cp "$work/new" "$work/figures"
tail -n 3 "$work/log"
if [ $# -ge 2 ] && [ -f "$kept" ]; then
  # If a test ran, its new figures replace its previous figures. The figures of removed tests are dropped.
  awk -v new="$work/new" '
    function says(file, id,   line) {
      if (!(file in text)) while ((getline line < file) > 0) text[file] = text[file] line
      return index(text[file], "\"" id "\"") > 0
    }
    BEGIN { while ((getline < new) > 0) ran[$3 " " $5] = 1 }
    !(($3 " " $5) in ran) && says($5, $3)' "$kept" >> "$work/figures"
fi
cp "$work/figures" "$kept"

sed '/<!-- table/q' "$folder/README.md" > "$work/readme"
awk -v figures="$work/figures" '
  function ask(name,   list, n, i, out) {  # each file once
    n = split(name, list, "\n"); out = ""
    for (i = 1; i <= n; ++i) if (list[i] != "" && index(out, "`" list[i] "`") == 0) out = out (out == "" ? "" : "<br>") "`" list[i] "`"
    return out
  }
  BEGIN {
    while ((getline line < figures) > 0) {
      split(line, words, " "); id = words[3]
      rest = line; sub(/^\[ case [A-Z0-9]+ \] /, "", rest)
      file = rest; sub(/ \| .*/, "", file); sub(/^tests\//, "", file)
      figure = rest; sub(/^[^|]*\| /, "", figure)
      if (!(id in figured)) figured[id] = figure
      else if (index("\n" figured[id] "\n", "\n" figure "\n") == 0) figured[id] = figured[id] "\n" figure
      files[id] = files[id] "\n" file
    }
    print "\n| id | case | to pass | our figures | the naive way | test |\n| --- | --- | --- | --- | --- | --- |"
    FS = " \\| "
  }
  {
    figure = figured[$1]; gsub(/\n/, "; ", figure); gsub(/\|/, "\\|", figure)
    for (i = 2; i <= 5; ++i) gsub(/\|/, "\\|", $i)
    if ($5 != "") figure = figure (figure == "" ? "" : "; ") "**" $5 "**"
    if (figure == "") figure = "**not there yet**"
    print "| " $1 " | " $2 " | " $3 " | " figure " | " $4 " | " ask(files[$1]) " |"
  }' "$folder/cases.txt" >> "$work/readme"
cp "$work/readme" "$folder/README.md"
[ "$status" -eq 0 ] || grep -E '\((Failed|Timeout|Not Run)\)' "$work/log" || true
exit "$status"
