# To be sourced in the root folder of the checkout: sets `build` to the build folder of the programs. This is the folder that
# BANDSAW_BUILD names. If BANDSAW_BUILD is not set, installs the packages of LIST (one of the lists of deploy/install.sh, such as demo),
# and builds in build/release.
# Usage: . deploy/build.sh LIST
build=${BANDSAW_BUILD:-}
if [ -z "$build" ]; then
  build=$PWD/build/release
  deploy/install.sh "$1"
  [ -f "$build/build.ninja" ] || cmake --preset release -DBANDSAW_TESTS=OFF
  cmake --build --preset release --target bandsaw bandsaw-worker bandsaw-import
fi
