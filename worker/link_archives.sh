#!/bin/sh
# Links a program with static archives instead of shared libraries where an archive exists.
# Usage: link_archives.sh LIBRARIES COMPILER ARGUMENT...
# LIBRARIES: names, in one argument, of libraries that the archives need besides those on the command line.
# The script is needed because Debian's CMake packages name shared libraries only.
# The order of the libraries on the command line is right for archives too.
set -eu
libraries=$1 compiler=$2
shift 2
for library in $libraries; do
  set -- "$@" "-l$library"
done
for argument; do
  shift
  case $argument in
    -lc | -lm | -ldl | -lrt | -lpthread) name= ;;  # glibc's own libraries stay shared
    -l[!:]*) name=${argument#-l} ;;
    /*/lib*.so | /*/lib*.so.*) name=${argument##*/lib} name=${name%%.so*} ;;
    *) name= ;;
  esac
  archive=lib$name.a
  # The compiler prints the name unchanged if it finds no such file.
  if [ -n "$name" ] && [ "$("$compiler" -print-file-name="$archive")" != "$archive" ]; then
    argument=-l:$archive
  fi
  set -- "$@" "$argument"
done
exec "$compiler" "$@"
