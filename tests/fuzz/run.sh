#!/bin/sh
# Builds the fuzz targets with clang 16 (preset `fuzz`: ASan, UBSan) and runs each on its corpus.
#   tests/fuzz/run.sh [--seconds N] [--runs N] [--jobs N] [TARGET …]
#   --seconds N   for each target, default 60; 0: until --runs is reached
#   --runs N      inputs for each target at most; default: as many as fit
#   --jobs N      targets that run at a time, default 2 where memory allows
#   TARGET        as tests/fuzz/CMakeLists.txt names them; default: all
# BLOCKRAND_PROGRAM makes the seeds, default build/release/blockrand. Corpora stay in build/fuzz/corpus and grow; inputs
# that fail are written to build/fuzz/found, logs to build/fuzz/logs.
# Ends with 0; 1 where an input failed; 77, "skipped", where clang++-16 or the program is absent.
set -eu
root=$(CDPATH='' cd -- "$(dirname -- "$0")/../.." && pwd)
cd "$root"
. samples/build_settings.sh
[ "$jobs" -le 2 ] || jobs=2
seconds=60 runs=-1
while [ $# -gt 0 ]; do
  case $1 in
    --seconds) seconds=$2; shift 2 ;;
    --runs) runs=$2; shift 2 ;;
    --jobs) jobs=$2; shift 2 ;;
    -h | --help) sed -n '2,10p' "$0"; exit 0 ;;
    -*) echo "fuzz: unknown option $1" >&2; exit 1 ;;
    *) break ;;
  esac
done
command -v clang++-16 >/dev/null 2>&1 ||
  { echo "fuzz: no clang++-16 (sh samples/setup.sh fuzz installs it): skipped"; exit 77; }
program=${BLOCKRAND_PROGRAM:-build/release/blockrand}
[ -x "$program" ] || { echo "fuzz: no $program, which makes the seeds: skipped"; exit 77; }

cmake --preset fuzz >/dev/null
targets=$*
if [ -z "$targets" ]; then
  targets=$(cat build/fuzz/tests/fuzz/targets.txt)
  cmake --build --preset fuzz --parallel "$jobs" --target fuzz_targets
else
  # shellcheck disable=SC2046,SC2086 # a list
  cmake --build --preset fuzz --parallel "$jobs" --target $(printf 'fuzz_%s ' $targets)
fi

corpus=build/fuzz/corpus
mkdir -p "$corpus/reference" build/fuzz/found build/fuzz/logs
python3 tests/fuzz/seeds.py "$program" "$corpus"
sh tests/fuzz/reference_seeds.sh "$corpus/reference"
for name in $targets; do
  [ -n "$(ls -A "$corpus/$name" 2>/dev/null)" ] || { echo "fuzz: no seeds for $name: add them to tests/fuzz/seeds.py" >&2; exit 1; }
done

# One target. Inputs are as long as the seeds at most: what is larger is slower and finds nothing else.
cat >build/fuzz/run_target.sh <<'TARGET'
set -eu
name=$1
longest=$(find "build/fuzz/corpus/$name" -type f -size +4 -printf '%s\n' | sort -n | tail -1)
set -- -max_total_time="$seconds" -runs="$runs" -max_len="${longest:-4096}" -timeout=20 -rss_limit_mb=2048 \
  -print_final_stats=1 -artifact_prefix="build/fuzz/found/$name-"
[ ! -f "build/fuzz/corpus/$name.dict" ] || set -- "$@" -dict="build/fuzz/corpus/$name.dict"
if UBSAN_OPTIONS=print_stacktrace=1 "build/fuzz/tests/fuzz_$name" "$@" "build/fuzz/corpus/$name" \
  >"build/fuzz/logs/$name.log" 2>&1; then
  verdict='no failure'
else
  verdict=FAILED
  touch build/fuzz/logs/failed
fi
awk -v name="$name" -v verdict="$verdict" '
  /^stat::number_of_executed_units:/ { inputs = $2 }
  /^stat::average_exec_per_sec:/ { rate = $2 }
  /^stat::peak_rss_mb:/ { memory = $2 }
  END { printf "fuzz: %-14s%10d inputs%8d a second%6d MB   %s\n", name, inputs, rate, memory, verdict }' \
  "build/fuzz/logs/$name.log"
if [ "$verdict" = FAILED ]; then tail -n 40 "build/fuzz/logs/$name.log"; fi
TARGET
rm -f build/fuzz/logs/failed
export seconds runs
# shellcheck disable=SC2086 # a list
printf '%s\n' $targets | xargs -P "$jobs" -n 1 sh build/fuzz/run_target.sh
if [ -e build/fuzz/logs/failed ]; then
  echo "fuzz: FAILED; the inputs are in build/fuzz/found (run: build/fuzz/tests/fuzz_NAME FILE)"
  exit 1
fi
echo "fuzz: no crash, leak or hang"
