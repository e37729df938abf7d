# shellcheck shell=sh
# Sourced by quickstart.sh and tests/run.sh in the repository's root: sets `jobs` for the compiler, and a place for caches.

# A CGAL source takes up to 1.7 GB to compile: as many at a time as memory holds, at most one per core.
# CMAKE_BUILD_PARALLEL_LEVEL says otherwise.
jobs=${CMAKE_BUILD_PARALLEL_LEVEL:-$(nproc 2>/dev/null || echo 1)}
memory_kb=$(awk '/^MemAvailable:/ { print $2 }' /proc/meminfo 2>/dev/null || true)
if [ -n "$memory_kb" ]; then
  fitting=$((memory_kb / 1800000))
  [ "$fitting" -ge 1 ] || fitting=1
  [ "$fitting" -ge "$jobs" ] || jobs=$fitting
fi

# ccache and npm write below HOME, which some machines do not have.
if [ ! -d "${HOME:-}" ] || [ ! -w "${HOME:-}" ]; then
  mkdir -p build/home
  HOME=$PWD/build/home
  export HOME
fi
