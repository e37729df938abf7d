#!/bin/sh
# The synthetic orthophotos that evaluate.py, fit.py and ghosts.py are run on, of both sets, each with its truth.
#   tests/bench/imagery/render_all.sh IMAGES_FOLDER [SET …]       sets: tuning judging; default both
# Needs the data folder beside the repository, build/release/blockrand, python3-numpy, python3-gdal, osmium-tool. About two CPU minutes
# a picture; those that are there already are kept. Writes IMAGES_FOLDER/SET/PLACE.tif and .truth.json, and estate.osm.
set -eu
root=$(CDPATH='' cd -- "$(dirname -- "$0")/../../.." && pwd)
case ${1:-} in '' | -h | --help) sed -n '2,5p' "$0"; exit 0 ;; esac
images=$1
shift
[ $# -gt 0 ] || set -- tuning judging
bench=$root/tests/bench/imagery
program=${BLOCKRAND_PROGRAM:-$root/build/release/blockrand}
osm=$root/../shared/data/osm
mkdir -p "$images"
[ -f "$images/estate.osm" ] || /usr/bin/python3 "$bench/estate.py" "$images/estate.osm"
for set in "$@"; do
  mkdir -p "$images/$set"
  for extract in "$osm"/husum_altstadt.osm.pbf "$osm"/berlin-zionskirchplatz-2020.osm "$osm"/karlsruhe-suedweststadt-2026.osm.pbf \
    "$osm"/london-soho-2025.osm.gz "$osm"/zuerich-niederdorf-2025.osm.pbf "$osm"/piestany-2025.osm.gz "$images/estate.osm"; do
    place=$(basename "$extract" | sed 's/\.osm.*//')
    [ ! -f "$images/$set/$place.truth.json" ] || continue
    model=$images/models/$place
    [ -d "$model" ] || "$program" build "$extract" -o "$model" --lod 2 --ground-height 0 --formats cityjson --progress none -q
    /usr/bin/python3 "$bench/render.py" "$model" -o "$images/$set/$place.tif" --seed 1 --set "$set" --extract "$extract"
  done
done
