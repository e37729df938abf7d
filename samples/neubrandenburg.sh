#!/bin/sh
# A whole real town: Neubrandenburg with 15,339 buildings, from the test data in the Debian source package josm. Fetches
# it (once, into out/data), builds the program, builds the town into out/neubrandenburg. Can be run again at any time,
# from any folder; needs no root where the packages of setup.sh are installed.
#   sh samples/neubrandenburg.sh [PROGRAM]     PROGRAM: a blockrand that is there already
set -eu
root=$(CDPATH='' cd -- "$(dirname -- "$0")/.." && pwd)
case ${1:-} in -h | --help) sed -n '2,5p' "$0"; exit 0 ;; esac
[ $# -le 1 ] || { echo "neubrandenburg: unknown argument $2" >&2; exit 1; }
program=${1:-}
if [ -n "$program" ]; then
  command -v "$program" >/dev/null 2>&1 || { echo "neubrandenburg: $program is no program" >&2; exit 1; }
  program=$(command -v "$program")
  case $program in /*) ;; *) program=$PWD/$program ;; esac
fi
# shellcheck disable=SC2154
trap 'code=$?; [ "$code" -eq 0 ] || echo "neubrandenburg: FAILED with code $code; the reason stands above" >&2' EXIT

cd "$root"
extract=out/data/neubrandenburg.osm.bz2
if [ -s "$extract" ]; then
  echo "neubrandenburg: the extract is there already: $extract"
else
  sh samples/debian_source_file.sh josm nodist/data/neubrandenburg.osm.bz2 "$extract" || {
    echo "neubrandenburg: without apt, put nodist/data/neubrandenburg.osm.bz2 of JOSM's source there by hand: $extract" >&2
    exit 1
  }
fi

if [ -z "$program" ]; then
  sample=neubrandenburg
  . samples/build_program.sh
  program=build/release/blockrand
fi

echo "neubrandenburg: building the town"
# The town lies at about 20 m above sea level. Facades (--lod 3) would take ten times the disk.
"$program" build "$extract" -o out/neubrandenburg --lod 2 --ground-height 20 --force

cat <<TEXT

To look at it:
  * out/neubrandenburg/buildings.qgz in QGIS: a coloured map, with every attribute and where it comes from
  * out/neubrandenburg/report.html in a browser: what was built, what was inferred, what fell back and why
  * 3D Tiles: serve the folder (cd out/neubrandenburg && python3 -m http.server) and load
    http://localhost:8000/tileset.json in CesiumJS or 3d-tiles-renderer
The data: OpenStreetMap contributors, ODbL 1.0.

neubrandenburg: done, the town stands in $root/out/neubrandenburg
TEXT
