#!/bin/sh
# Is every source laid out as .clang-format says? Names each file that is not.
#   sh tests/format.sh          (ends with 77, "skipped", where clang-format or git's list of files is missing)
# To lay out: git ls-files '*.h' '*.cpp' | xargs clang-format -i
set -eu
cd "$(dirname -- "$0")/.."
command -v clang-format >/dev/null 2>&1 || { echo "format: no clang-format (apt-get install clang-format): skipped"; exit 77; }
sources=$(git ls-files '*.h' '*.cpp' 2>/dev/null) || sources=
[ -n "$sources" ] || { echo "format: no git repository to list the sources: skipped"; exit 77; }
wrong=$(git ls-files -z '*.h' '*.cpp' | xargs -0 clang-format --dry-run --Werror 2>&1 | sed -n 's/^\([^:]*\):[0-9].*error:.*/\1/p' | sort -u)
[ -z "$wrong" ] && { echo "format: all sources are laid out as .clang-format says"; exit 0; }
echo "$wrong"
echo "format: these files are not laid out as .clang-format says: clang-format -i FILE"
exit 1
