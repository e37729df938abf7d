#!/bin/sh
# Installs the Debian packages that are missing, with apt-get, as root or through sudo. Says what it installs.
#   sh samples/setup.sh [SECTION …]     sections of cmake/packages.txt; default: build
# Where apt or the rights are missing it says what to install and ends with 1. BLOCKRAND_SKIP_SETUP=1 skips everything:
# for machines whose libraries come from elsewhere.
set -eu
root=$(CDPATH='' cd -- "$(dirname -- "$0")/.." && pwd)
list=$root/cmake/packages.txt

case ${1:-} in -h | --help) sed -n '2,5p' "$0"; exit 0 ;; esac
[ $# -gt 0 ] || set -- build

say() { printf 'setup: %s\n' "$*"; }

if [ "${BLOCKRAND_SKIP_SETUP:-}" = 1 ]; then
  say "skipped (BLOCKRAND_SKIP_SETUP=1)"
  exit 0
fi

# packages_of SECTION: one package per line
packages_of() {
  awk -v wanted="[$1]" '
    { sub(/#.*/, ""); gsub(/[ \t\r]/, "") }
    /^\[/ { here = ($0 == wanted); found = found || here; next }
    here && $0 != "" { print }
    END { exit !found }' "$list"
}

has_node() {
  command -v node >/dev/null 2>&1 && command -v npm >/dev/null 2>&1 &&
    [ "$(node -p 'process.versions.node.split(".")[0]' 2>/dev/null || echo 0)" -ge 18 ]
}

installed() {
  case $1 in nodejs | npm) has_node && return 0 ;; esac
  [ "$(dpkg-query -W -f '${db:Status-Status}' "$1" 2>/dev/null || true)" = installed ]
}

wanted=
for section in "$@"; do
  names=$(packages_of "$section") || { say "error: cmake/packages.txt has no section [$section]"; exit 1; }
  wanted="$wanted $names"
done

if ! command -v apt-get >/dev/null 2>&1 || ! command -v dpkg-query >/dev/null 2>&1; then
  say "error: no apt-get here. Install these Debian packages, or what your system calls them:"
  # shellcheck disable=SC2086 # the list is meant to be split
  say $wanted
  say "and run again with BLOCKRAND_SKIP_SETUP=1."
  exit 1
fi

missing=
for package in $wanted; do
  installed "$package" || missing="$missing $package"
done
if [ -z "$missing" ]; then
  say "all packages are there ($*)"
  exit 0
fi

if [ "$(id -u)" = 0 ]; then
  as_root=
elif command -v sudo >/dev/null 2>&1 && { sudo -n true 2>/dev/null || [ -t 0 ]; }; then
  as_root=sudo
else
  say "error: packages are missing, and installing them needs root. Run as root:"
  say "  apt-get update && apt-get install --no-install-recommends$missing"
  exit 1
fi

say "installing:$missing"
apt() { $as_root env DEBIAN_FRONTEND=noninteractive apt-get -q -o Acquire::Retries=3 "$@"; }
apt update || say "warning: apt-get update failed; trying with the package lists that are there"
# shellcheck disable=SC2086
if ! apt install -y --no-install-recommends $missing; then
  say "error: apt-get could not install:$missing"
  exit 1
fi
say "installed:$missing"
