# shellcheck shell=sh
# Sourced by quickstart.sh and neubrandenburg.sh, in the repository's root: installs what is missing and builds the
# program as build/release/blockrand. `$sample` is the name of the script, for what it says.

sh samples/setup.sh build
. samples/build_settings.sh
# shellcheck disable=SC2154
echo "$sample: configuring and building the program ($jobs at a time; the first time takes some minutes)"
# Tests need more packages. A tree that is configured already stays as it is.
if [ -f build/release/CMakeCache.txt ]; then
  cmake --preset release
else
  cmake --preset release -DBLOCKRAND_TESTS=OFF
fi
cmake --build --preset release --parallel "$jobs" --target blockrand
