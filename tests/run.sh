#!/bin/sh
# The test suite: installs what is missing, builds preset `release` as quickstart.sh does, runs ctest. Can be run from any folder.
#   sh tests/run.sh [--full | --fuzz] [ctest arguments …]
#   --fuzz   with the fuzz targets, a minute each (tests/fuzz/run.sh), and the compiler that they need
#   --full   with the fuzz targets, the tests of label `long` (whole cities; needs ../shared/data) and foreign viewers,
#            which it installs; without them their tests skip
# Ends with ctest's summary, what was skipped and why, and ctest's exit code.
set -eu
root=$(CDPATH='' cd -- "$(dirname -- "$0")/.." && pwd)
full=no
fuzz=no
while [ $# -gt 0 ]; do
  case $1 in
    --full) full=yes fuzz=yes; shift ;;
    --fuzz) fuzz=yes; shift ;;
    -h | --help) sed -n '2,7p' "$0"; exit 0 ;;
    *) break ;;
  esac
done

sections='build test package'
[ $full = no ] || sections="$sections viewers picture"
[ $fuzz = no ] || sections="$sections fuzz"
# shellcheck disable=SC2086 # a list
sh "$root/samples/setup.sh" $sections

cd "$root"
. samples/build_settings.sh
build=build/release
mkdir -p "$build"

# Khronos' validator and viewers of 3D Tiles, where the tests look for them; CesiumJS (130 MB) comes with --full alone.
# Without them they skip: say so, but test the rest.
if command -v npm >/dev/null 2>&1; then
  omit=--omit=optional
  [ $full = no ] || omit=
  if ! cmp -s tests/validators/package.json "$build/package.json" || [ ! -d "$build/node_modules" ] ||
    { [ $full = yes ] && [ ! -d "$build/node_modules/cesium" ]; }; then
    echo "tests: installing the npm packages of tests/validators/package.json into $build/node_modules"
    cp tests/validators/package.json "$build/package.json"
    # shellcheck disable=SC2086 # none or one
    if ! (cd "$build" && npm install --no-audit --no-fund --loglevel=error --fetch-retries=1 --fetch-timeout=60000 $omit); then
      rm -f "$build/package.json"
      echo "tests: WARNING: npm could not install them; the Khronos checks and 3d-tiles-renderer will be SKIPPED" >&2
    fi
  fi
else
  echo "tests: WARNING: no npm; the Khronos checks and 3d-tiles-renderer will be SKIPPED" >&2
fi

echo "tests: configuring and building ($jobs at a time)"
# -U: whether warnings are errors is decided by the compiler, not by what an older tree remembers.
cmake --preset release -UBLOCKRAND_WERROR -DBLOCKRAND_TESTS=ON
cmake --build --preset release --parallel "$jobs"

[ -d ../shared/data ] || echo "tests: no ../shared/data: tests on real extracts skip"
without=
[ $full = yes ] || without=long
[ $fuzz = yes ] || without=${without:+$without|}fuzz
if [ -n "$without" ]; then set -- -LE "^($without)\$" "$@"; fi
log=$build/Testing/Temporary/LastTest.log
rm -f "$log"
code=0
ctest --preset release -j2 "$@" || code=$?
python3 tests/skipped_tests.py "$log"
exit "$code"
