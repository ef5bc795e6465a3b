#!/usr/bin/env bash
# Writes scene.md, the reference of the scene file, from the comments of scene.proto.
# Usage: proto/reference.sh [--check]    --check writes nothing and fails if scene.md is not up to date
set -euo pipefail
cd "$(dirname "$0")"

reference() {
  # kind[d]: "message", "enum" or "oneof", the kind of the block that is open at depth d. open[d]: the name of this block.
  # pending: the comment above the next field or message. order[i]: the name of message or enum i of the file.
  # about[name]: the text about a message or enum. is_enum[name]: 1 for an enum. count[name]: the number of its fields or words.
  # rows[name, k]: the name of field k of a message, or the start of the table row for word k of an enum.
  # row_words[name, k]: the text about the field or word. row_type[name, k]: the type of the field, and 1 if the field is repeated.
  # row_one[name, k]: 1 if the field is in a oneof.
  awk '
    function escaped(text) { gsub(/\|/, "\\|", text); return text }
    function joined(a, b) { return a == "" ? b : b == "" ? a : a " " b }
    function anchor(name) { name = tolower(name); gsub(/\./, "", name); return name }
    function scope(  i, name) {
      for (i = 1; i <= depth; ++i) if (kind[i] != "oneof") name = name (name == "" ? "" : ".") open[i]
      return name
    }
    function type_text(type, inside) {
      if (type ~ /^[A-Z]/) {
        return (inside "." type) in about ? "[" type "](#" anchor(inside "." type) ")" : "[" type "](#" anchor(type) ")"
      }
      return type == "double" || type == "float" ? "number" : type ~ /^u?int/ ? "whole number" : \
             type == "string" ? "text" : type == "bool" ? "`true` or `false`" : type
    }
    function begin(what, name) {
      kind[++depth] = what
      open[depth] = name
      if (what != "oneof") {
        name = scope()
        order[++names] = name
        about[name] = pending
        is_enum[name] = what == "enum"
      }
      pending = ""
    }
    function add_row(name, row, words) {
      rows[name, ++count[name]] = row
      row_words[name, count[name]] = words
    }
    # A comment line belongs to the following field, so a trailing comment must not continue on the next line. A line that continues
    # a trailing comment is recognised by its indentation: it is deeper than that of the fields.
    match($0, /^ *\/\//) && RLENGTH > 2 * depth + 2 {
      print "proto/scene.proto:" NR ": a comment of several lines must stand above its field" > "/dev/stderr"
      exit bad = 1
    }
    { sub(/^ +/, "") }
    /^\/\// { sub(/^\/\/ ?/, ""); pending = depth == 0 ? pending $0 "\n" : joined(pending, $0); next }
    /^$/ { if (depth == 0 && intro == "") intro = pending; pending = ""; next }
    /^(syntax|package)/ { if (intro == "") intro = pending; pending = ""; next }
    /^(message|enum|oneof) / { begin($1, $2); next }
    /^}/ { --depth; pending = ""; next }
    {
      words = ""
      at = index($0, "//")
      if (at > 0) { words = substr($0, at + 2); sub(/^ /, "", words); $0 = substr($0, 1, at - 1) }
      sub(/ *=.*/, "")
      words = joined(pending, words)
      pending = ""
      n = split($0, part, " ")
      name = scope()
      if (is_enum[name]) {
        if (part[1] !~ /_UNSPECIFIED$/) add_row(name, "| `" part[1] "` | ", words)
        next
      }
      type = part[n - 1] SUBSEP (part[1] == "repeated")
      add_row(name, part[n], words)
      row_type[name, count[name]] = type
      row_one[name, count[name]] = kind[depth] == "oneof"
    }
    END {
      if (bad) exit 1
      print "# The scene file\n"
      print "`proto/reference.sh` makes this file from the comments in `scene.proto`. Change the comments, not this file.\n"
      print intro
      for (i = 1; i <= names; ++i) {
        name = order[i]
        print "## " name "\n"
        if (about[name] != "") print about[name] (about[name] ~ /\n$/ ? "" : "\n")
        if (is_enum[name]) {
          print "| word | meaning |\n| --- | --- |"
          for (k = 1; k <= count[name]; ++k) print rows[name, k] escaped(row_words[name, k]) " |"
        } else {
          print "| field | holds | |\n| --- | --- | --- |"
          for (k = 1; k <= count[name]; ++k) {
            split(row_type[name, k], parts, SUBSEP)
            print "| `" rows[name, k] "` | " (parts[2] ? "a list: " : "") type_text(parts[1], name) \
                  (row_one[name, k] ? ", one of these" : "") " | " escaped(row_words[name, k]) " |"
          }
        }
        print ""
      }
    }' scene.proto | sed -e :a -e '/^\n*$/{$d;N;ba' -e '}'
}

if [ "${1:-}" = --check ]; then
  reference | diff -u scene.md - || { echo "proto/scene.md is not up to date: run proto/reference.sh" >&2; exit 1; }
else
  made=$(reference)
  echo "$made" > scene.md
fi
