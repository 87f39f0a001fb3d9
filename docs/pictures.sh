#!/usr/bin/env bash
# Makes every picture of the docs anew, with the program.
set -euo pipefail
root=$(cd -- "$(dirname -- "${BASH_SOURCE[0]}")/.." && pwd)
program=${THICKET_PROGRAM:-$root/thicket}
runs=$(mktemp -d)
trap 'rm -rf -- "$runs"' EXIT

# Maps of missions.
map() {
  "$program" run "$1" --out "$runs/run" --quiet || [[ $? == 3 ]] # closed: there is no way
  cp -- "$runs/run/map.png" "$root/docs/pictures/${2:-${1##*/}}.png"
}
# Worlds as they look: the solids, each from where it is seen best, and the thicket.
look() {
  "$program" picture "$1" --out "$root/docs/pictures/worlds/$2.png" --size 640x400 "${@:3}"
}

if [[ ${1:-all} != worlds ]]; then
  for mission in foliage_wall/{bug1,bug2,closed,smoke,map_radar,map_lidar} rooms/{convex,u,spiral}; do map "$mission"; done
  map thicket/look_through thicket_radar
  map thicket/look_through_lidar thicket_lidar
fi
mkdir -p -- "$root/docs/pictures/worlds"
for solid in box sphere cylinder wall prism map mesh tree hedge tilted instances smoke; do look "solids/$solid" "$solid"; done
look solids/motion motion --time 2
"$program" picture thicket/thicket --out "$root/docs/pictures/worlds/thicket.png"
