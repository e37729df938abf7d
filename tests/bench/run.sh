#!/bin/sh
# Whole runs on the extracts of ../shared/data/osm: the table of objects, models, fallbacks, speed, memory and size.
#   tests/bench/run.sh [--program build/release/blockrand] [--out DIR] [--jobs N] [NAME-PART …]
# Prints Markdown to stdout. Times are of this machine on this day: compare rows of one run with each other only.
set -eu
root=$(cd "$(dirname "$0")/../.." && pwd)
program=$root/build/release/blockrand
out=$root/build/bench
jobs=0
names=
while [ $# -gt 0 ]; do
  case $1 in
    --program) program=$2; shift 2 ;;
    --out) out=$2; shift 2 ;;
    --jobs) jobs=$2; shift 2 ;;
    -h|--help) sed -n '2,4p' "$0"; exit 0 ;;
    *) names="$names $1"; shift ;;
  esac
done
data=$root/../shared/data/osm
[ -d "$data" ] || { echo "bench: no real data at $data; nothing measured" >&2; exit 0; }
[ -x "$program" ] || { echo "bench: $program is not built; run samples/quickstart.sh first" >&2; exit 1; }
mkdir -p "$out"
echo "| extract | buildings | parts | LoD0/1/2 | represented (dupl.) | reported | fallbacks and reports by code | s | buildings/s | peak MB (store) | output MB | bytes/building |"
echo "|---|---|---|---|---|---|---|---|---|---|---|---|"
status=0
for file in "$data"/*.pbf "$data"/*.osm "$data"/*.gz; do
  name=$(basename "$file")
  if [ -n "$names" ]; then
    wanted=no
    for n in $names; do case $name in *"$n"*) wanted=yes ;; esac; done
    [ $wanted = yes ] || continue
  fi
  target=$out/${name%%.*}
  if ! "$program" build "$file" -o "$target" --force --lod 2 --progress=none --jobs "$jobs" >"$out/log.txt" 2>&1; then
    echo "| $name | failed: $(tail -n 1 "$out/log.txt") |"; status=1; continue
  fi
  python3 - "$name" "$target" <<'PY'
import json, sys
name, folder = sys.argv[1], sys.argv[2]
b, r, rep = (json.load(open(f"{folder}/{f}.json")) for f in ("build", "run", "report"))
c = b["counts"]
assert c["buildings_in"] + c["parts_in"] == c["models"] + c["represented"] + c["reported"], c
notices = {n["code"] for n in rep["notices"]}
codes = ", ".join(f"{k} {v}" for k, v in sorted(b["issues"].items(), key=lambda kv: -kv[1]) if k not in notices)
size = sum(f["bytes"] for f in b["files"].values())
n = c["buildings_in"] + c["parts_in"]
print(f"| {name} | {c['buildings_in']:,} | {c['parts_in']:,} | {c['models_lod0']}/{c['models_lod1']}/{c['models_lod2']:,} "
      f"| {c['represented']:,} ({c['represented_as_duplicates']:,}) | {c['reported']:,} | {codes} | {r['seconds']:.2f} "
      f"| {n / r['seconds']:,.0f} | {r['peak_rss_bytes'] / 1e6:.0f} ({r['store_bytes'] / 1e6:.0f}) | {size / 1e6:.1f} | {size / max(n, 1):,.0f} |")
PY
done
exit $status
