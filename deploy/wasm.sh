#!/usr/bin/env bash
# Builds the renderer as a WebAssembly module, which browsers load when they join a farm as workers. The results are in build/wasm:
# bandsaw.wasm, its compressed copy bandsaw.wasm.br, and bandsaw_test.wasm for the tests with the label wasm. The first two are copied
# to build/release/share/bandsaw/browser. The coordinator of the release build finds them in this folder, and an installation copies them
# from it.
# The script first installs the compiler and tools (deploy/install.sh wasm), and unpacks Debian's source packages of Abseil and protobuf
# into build/wasm/sources.
# Usage: deploy/wasm.sh
set -euo pipefail
cd "$(dirname "$0")/.."

deploy/install.sh wasm
# get_sources: downloads the source packages of the Debian release that runs here. It gives apt a separate list of package sources, so
# that the system's list does not change.
sources=$PWD/build/wasm/sources
get_sources() {
  local release mirror
  release=$(. /etc/os-release && echo "$VERSION_CODENAME")
  mirror=$(apt-cache policy libprotobuf-dev | grep -om1 'https\?://[^ ]*')
  rm -rf "$sources"
  mkdir -p "$sources/lists/partial"
  echo "deb-src [signed-by=/usr/share/keyrings/debian-archive-keyring.gpg] $mirror $release main" >"$sources/apt.list"
  local apt=(apt-get -qq -o Dir::Etc::sourcelist="$sources/apt.list" -o Dir::Etc::sourceparts=/dev/null -o Dir::State::lists="$sources/lists"
    -o APT::Sandbox::User=root)
  "${apt[@]}" update
  # apt checks both archives of a package by the signed index, so the .dsc file, which some mirrors lack, is not needed.
  for package in abseil protobuf; do
    (cd "$sources" && "${apt[@]}" source --download-only --tar-only "$package" && "${apt[@]}" source --download-only --diff-only "$package")
    mkdir "$sources/$package"
    tar -xf "$sources/${package}"_*.orig.tar.* --strip-components=1 -C "$sources/$package"
    tar -xf "$sources/${package}"_*.debian.tar.* -C "$sources/$package"
    dpkg-source --before-build "$sources/$package" >/dev/null  # apply Debian's patches
  done
  touch "$sources/complete"
}
[ -e "$sources/complete" ] || get_sources

cmake --preset wasm -DBANDSAW_WASM_SOURCES="$sources"
cmake --build --preset wasm
brotli --force --best build/wasm/bandsaw.wasm
mkdir -p build/release/share/bandsaw/browser
cp build/wasm/bandsaw.wasm build/wasm/bandsaw.wasm.br build/release/share/bandsaw/browser/
ls -l build/wasm/bandsaw.wasm build/wasm/bandsaw.wasm.br
