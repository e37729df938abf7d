#!/bin/sh
# Builds the fuzz targets with clang 16 and runs each for some seconds on the sample as seed corpus.
#   tests/fuzz/run.sh [SECONDS]     (default 20; ends with 77, "skipped", where clang++-16 is absent)
set -eu
root=$(CDPATH='' cd -- "$(dirname -- "$0")/../.." && pwd)
seconds=${1:-20}
command -v clang++-16 >/dev/null 2>&1 || { echo "fuzz: no clang++-16 (apt-get install clang-16 libclang-rt-16-dev): skipped"; exit 77; }
cd "$root"
cmake --preset fuzz >/dev/null
cmake --build --preset fuzz --target fuzz_osm_import fuzz_reference fuzz_tag_values fuzz_grammar
corpus=build/fuzz/corpus
mkdir -p "$corpus/osm" "$corpus/tags" "$corpus/reference" "$corpus/grammar"
# The first byte chooses the format: every one sees the sample.
for first in 0 1 2 3; do { printf "\\$first"; cat samples/blockrand-viertel.osm; } >"$corpus/osm/sample$first"; done
for value in "12 m" "40'6\"" "3;4" "NNE" "#a33" "1,5"; do printf '%s' "$value" >"$corpus/tags/$(printf '%s' "$value" | cksum | cut -d' ' -f1)"; done
# The rule texts of the unit tests: what stands between R"( and )".
awk -v folder="$corpus/grammar" '/R"\(/ { n++; sub(/.*R"\(/, ""); on = 1 } on && /^\)",?$/ { on = 0 } on { print > (folder "/sample" n ".cga") }' tests/unit/grammar/sample_rules.h
# Small models of every format behind the byte that chooses its reader.
sh tests/fuzz/reference_seeds.sh "$corpus/reference"
build/fuzz/tests/fuzz_tag_values -max_total_time="$seconds" -print_final_stats=1 "$corpus/tags"
build/fuzz/tests/fuzz_osm_import -max_total_time="$seconds" -max_len=200000 -rss_limit_mb=4096 -print_final_stats=1 "$corpus/osm"
build/fuzz/tests/fuzz_reference -max_total_time="$seconds" -max_len=20000 -rss_limit_mb=4096 -print_final_stats=1 "$corpus/reference"
build/fuzz/tests/fuzz_grammar -max_total_time="$seconds" -max_len=20000 -timeout=10 -rss_limit_mb=4096 -print_final_stats=1 "$corpus/grammar"
echo "fuzz: no crash in $seconds s each"
