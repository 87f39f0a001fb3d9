#!/usr/bin/env bash
# Renews the list of keys in docs/worlds.md, as the program tells them.
set -euo pipefail
root=$(cd -- "$(dirname -- "${BASH_SOURCE[0]}")/.." && pwd)
program=${THICKET_PROGRAM:-$root/thicket}
page=$root/docs/worlds.md
keys=$(mktemp) new=$(mktemp)
trap 'rm -f -- "$keys" "$new"' EXIT
"$program" help world --markdown > "$keys"
awk -v keys="$keys" '
  /^<!-- end of keys -->$/ { inside = 0 }
  !inside { print }
  /^<!-- keys: thicket help world --markdown -->$/ {
    inside = 1
    print ""
    while ((getline line < keys) > 0) print line
    print ""
  }' "$page" > "$new"
cat -- "$new" > "$page"
