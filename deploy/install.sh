#!/usr/bin/env bash
# Installs the packages of Debian 12 or 13 that building, testing, packing or the demo need, if any is missing.
# Usage: deploy/install.sh build|demo|packages|test|browser|blender|clang|old_cpu|arm64|wasm
#   build    what building the programs needs
#   demo     the list `build`, and the models of deploy/demo.sh
#   packages the list `build`, and what making Debian packages needs in addition
#   test     the list `demo`, and what the tests need in addition
#   browser  the list `test`, and what the tests with the label browser need in addition, 700 MB
#   blender  the list `test`, and what the tests with the label blender need in addition, 700 MB
#   clang    the list `test`, and what the presets clang and fuzz need in addition
#   old_cpu  the list `test`, and the emulator for the test with the label old_cpu
#   arm64    the cross compiler, Debian's libraries for ARM64 and an emulator, 800 MB; it adds the architecture to this system,
#            and updates the system's libraries that must have the same version in all architectures
#   wasm     clang and the C++ library for WebAssembly, and node for the tests, 500 MB
set -euo pipefail

build=(g++ cmake ninja-build pkg-config libgrpc++-dev protobuf-compiler protobuf-compiler-grpc libprotobuf-dev
  libabsl-dev libre2-dev libc-ares-dev zlib1g-dev libzstd-dev libssl-dev libassimp-dev libstb-dev libspdlog-dev libsqlite3-dev
  libcli11-dev libtinyexr-dev libboost-dev libdraco-dev libmeshoptimizer-dev libwebp-dev nlohmann-json3-dev libopenvdb-dev
  libimath-dev libtbb-dev libpugixml-dev libqrencode-dev)
demo=("${build[@]}" assimp-testmodels)
packages=("${build[@]}" dpkg-dev file fakeroot)
test=("${demo[@]}" libgtest-dev libgmock-dev git iproute2 curl python3 python3-numpy ffmpeg)
browser=("${test[@]}" chromium chromium-driver firefox-esr)
blender=("${test[@]}" blender xvfb xdotool imagemagick jupyter-nbconvert python3-ipykernel)
clang=("${test[@]}" clang libclang-rt-dev)
old_cpu=("${test[@]}" qemu-user-static)
wasm=("${test[@]}" clang-19 lld-19 wasi-libc libc++-19-dev-wasm32 libc++abi-19-dev-wasm32 libclang-rt-19-dev-wasm32
  brotli dpkg-dev nodejs)
arm64=("${test[@]}" g++-aarch64-linux-gnu qemu-user-static)
for package in "${test[@]}"; do
  case $package in
    libcli11-dev) ;;    # headers alone, for all architectures
    libopenvdb-dev) ;;  # only for one architecture at a time (renderlib/CMakeLists.txt)
    lib*-dev) arm64+=("$package:arm64") ;;
  esac
done

case "${1:-}" in
  build) wanted=("${build[@]}") ;;
  demo) wanted=("${demo[@]}") ;;
  packages) wanted=("${packages[@]}") ;;
  test) wanted=("${test[@]}") ;;
  browser) wanted=("${browser[@]}") ;;
  blender) wanted=("${blender[@]}") ;;
  clang) wanted=("${clang[@]}") ;;
  old_cpu) wanted=("${old_cpu[@]}") ;;
  arm64) wanted=("${arm64[@]}") ;;
  wasm) wanted=("${wasm[@]}") ;;
  *) echo "usage: deploy/install.sh build|demo|packages|test|browser|blender|clang|old_cpu|arm64|wasm" >&2; exit 2 ;;
esac

# installed PACKAGE: succeeds if the package is installed. A package may be installed for several
# architectures at once. If PACKAGE ends in :ARCHITECTURE, it must be installed for this one,
# otherwise for this machine's architecture.
architecture=$(dpkg --print-architecture)
installed() {
  local wanted=$architecture
  [[ $1 != *:* ]] || wanted=${1#*:}
  dpkg-query -W -f='${db:Status-Status} ${Architecture}\n' "$1" 2>/dev/null | grep -qE "^installed ($wanted|all)\$"
}
missing=()
for package in "${wanted[@]}"; do
  installed "$package" || missing+=("$package")
done
[ ${#missing[@]} -eq 0 ] && exit 0

sudo=()
if [ "$(id -u)" -ne 0 ]; then
  command -v sudo >/dev/null || { echo "install.sh: run as root, or install: ${missing[*]}" >&2; exit 1; }
  sudo=(sudo)
fi
echo "installing ${#missing[@]} packages: ${missing[*]}"
[ "$1" != arm64 ] || "${sudo[@]}" dpkg --add-architecture arm64
"${sudo[@]}" apt-get update -qq
"${sudo[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends "${missing[@]}" >/dev/null
