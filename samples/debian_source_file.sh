#!/bin/sh
# Fetches one file out of a Debian source package, with apt and from wherever this machine gets its packages.
#   sh samples/debian_source_file.sh PACKAGE PATH TARGET     PATH: inside the source tree, for example doc/README
# Needs no root and changes nothing of apt's: entries for sources are derived from the machine's own package sources and
# live, like everything that apt downloads, in a temporary folder. apt checks signatures and checksums.
set -eu
case ${1:-} in -h | --help) sed -n '2,5p' "$0"; exit 0 ;; esac
[ $# -eq 3 ] || { echo "debian_source_file: three arguments are needed, see --help" >&2; exit 1; }
package=$1 path=$2 target=$3

say() { printf 'debian_source_file: %s\n' "$*"; }
fail() { say "error: $*" >&2; exit 1; }

for tool in apt-get apt-cache apt-config; do
  command -v "$tool" >/dev/null 2>&1 || fail "no $tool here: this needs Debian or a system made from it"
done

mkdir -p "$(dirname -- "$target")"
work=$(mktemp -d "${TMPDIR:-/tmp}/blockrand-apt-XXXXXX")
trap 'rm -rf "$work"' EXIT
trap 'exit 130' INT
trap 'exit 143' TERM
mkdir -p "$work/lists/partial" "$work/cache/archives/partial" "$work/parts" "$work/source"
# As root, apt downloads as the user _apt, who must reach these folders.
chmod -R a+rX "$work"
if [ "$(id -u)" = 0 ] && id _apt >/dev/null 2>&1; then
  chown -R _apt "$work/lists/partial" "$work/cache/archives/partial" "$work/source"
fi

# ---- entries for sources, from the entries for packages

sources_list=/dev/null sources_parts=/nonexistent # for shellcheck; apt-config sets both
eval "$(apt-config shell sources_list Dir::Etc::sourcelist/f sources_parts Dir::Etc::sourceparts/d)"

# "deb [options] uri suite components" becomes deb-src; discs hold no sources that could be fetched.
from_lines() {
  awk '/^[ \t]*deb(-src)?[ \t]/ && !/cdrom:/ { sub(/^[ \t]*deb(-src)?/, "deb-src"); if (!seen[$0]++) print }' "$1"
}
# Stanzas of key and value: `Types: deb` becomes deb-src; the rest, signing keys and `Enabled: no` included, stays.
from_stanzas() {
  awk 'tolower($0) ~ /^types:/ { print "Types: deb-src"; continued = 1; next }
       continued && /^[ \t]/ { next }
       { continued = 0; print }' "$1"
}

count=0
for file in "$sources_list" "$sources_parts"/*.list "$sources_parts"/*.sources; do
  if [ ! -f "$file" ] || [ ! -r "$file" ]; then continue; fi
  count=$((count + 1))
  case $file in
    *.sources) from_stanzas "$file" >"$work/parts/$count.sources" ;;
    *) from_lines "$file" >"$work/parts/$count.list" ;;
  esac
done
[ "$count" -gt 0 ] || fail "this machine names no package sources (looked at $sources_list and $sources_parts)"

# Hooks of the system's own apt configuration (cleaning its caches, telling its package manager) are none of our business.
cat >"$work/apt.conf" <<CONF
Dir::Etc::sourcelist "/dev/null";
Dir::Etc::sourceparts "$work/parts";
Dir::State::lists "$work/lists";
Dir::Cache "$work/cache";
Dir::Cache::pkgcache "";
Dir::Cache::srcpkgcache "";
Acquire::Languages "none";
Acquire::Retries "2";
#clear APT::Update::Pre-Invoke;
#clear APT::Update::Post-Invoke;
#clear APT::Update::Post-Invoke-Success;
CONF

# ---- fetching

say "asking the package sources of this machine for $package"
# A source of packages alone has no list of sources, and apt ends with an error: whether ours came is what counts.
apt-get -q -c "$work/apt.conf" update >"$work/log" 2>&1 || true
if [ -z "$(apt-cache -c "$work/apt.conf" showsrc --only-source "$package" 2>/dev/null)" ]; then
  sed 's/^/  /' "$work/log" >&2
  fail "no package source offers the source package $package. Offline? What apt said stands above"
fi
if ! (cd "$work/source" && apt-get -q -c "$work/apt.conf" source --download-only --tar-only --only-source "$package") \
  >"$work/log" 2>&1; then
  sed 's/^/  /' "$work/log" >&2
  fail "apt could not fetch the source of $package; what it said stands above"
fi

for archive in "$work/source"/*.tar.*; do
  [ -f "$archive" ] || continue
  # The name of the top folder is the archive's own.
  member=$(tar -tf "$archive" | awk -v wanted="$path" '{ name = $0; sub(/^(\.\/)?[^\/]*\//, "", name) } name == wanted { print; exit }')
  [ -n "$member" ] || continue
  if ! tar -xOf "$archive" "$member" >"$target.part"; then
    rm -f "$target.part"
    fail "$path could not be taken out of $(basename "$archive"): is the disk full?"
  fi
  mv -f "$target.part" "$target"
  say "$path of $(basename "$archive"), checked by apt, is now $target"
  exit 0
done
fail "the source of $package holds no $path"
