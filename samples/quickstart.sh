#!/bin/sh
# From a clone to a first result: installs what is missing, builds the program, builds the sample quarter into
# out/quickstart. Can be run again at any time, from any folder.
#   sh samples/quickstart.sh
set -eu
root=$(CDPATH='' cd -- "$(dirname -- "$0")/.." && pwd)
case ${1:-} in
  '') ;;
  -h | --help) sed -n '2,4p' "$0"; exit 0 ;;
  *) echo "quickstart: unknown argument $1" >&2; exit 1 ;;
esac
# shellcheck disable=SC2154
trap 'code=$?; [ "$code" -eq 0 ] || echo "quickstart: FAILED with code $code; the reason stands above" >&2' EXIT

cd "$root"
sample=quickstart
. samples/build_program.sh

echo "quickstart: building the sample quarter"
# The quarter lies on a field at about 150 m above sea level.
build/release/blockrand build samples/blockrand-viertel.osm -o out/quickstart --single-glb --ground-height 150 --force

cat <<TEXT

To look at it: build/release/blockrand view out/quickstart
Or:
  * drag out/quickstart/model.glb into any glTF viewer or editor (Blender, https://gltf-viewer.donmccurdy.com)
  * 3D Tiles: serve the folder (cd out/quickstart && python3 -m http.server) and load
    http://localhost:8000/tileset.json in CesiumJS or 3d-tiles-renderer
  * out/quickstart/citygml/*.gml in a GIS; out/quickstart/report.json says what was built simpler, and why
Your own extract: build/release/blockrand build YOUR.osm.pbf -o out/yours

quickstart: done, the sample quarter stands in $root/out/quickstart
TEXT
