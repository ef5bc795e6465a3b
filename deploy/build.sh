# To be sourced in the root folder of the checkout: sets `build` to the build folder of the programs. Unless BANDSAW_BUILD
# names one, installs the packages of install.sh's LIST and builds.
# Usage: . deploy/build.sh LIST
build=${BANDSAW_BUILD:-}
if [ -z "$build" ]; then
  build=$PWD/build/release
  deploy/install.sh "$1"
  [ -f "$build/build.ninja" ] || cmake --preset release -DBANDSAW_TESTS=OFF
  cmake --build --preset release --target bandsaw bandsaw-worker bandsaw-import
fi
