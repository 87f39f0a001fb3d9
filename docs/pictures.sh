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
for solid in box sphere cylinder wall prism map tilted smoke; do look "solids/$solid" "$solid"; done
look solids/mesh mesh --from -4.9,-7.1,3.3 --at 0,-0.9,0.5 --fov-deg 43
look solids/tree tree --from -5.5,-11,3.6 --at 0.2,0,3.4
look solids/hedge hedge --from -2.8,-5,2.3 --at 0.1,-0.1,0.7
look solids/instances instances --from -7,-12,5.5 --at 0.3,2,1.3
look solids/motion motion --time 2 --at -0.3,-0.2,0.6 --from -4.5,-7,4.4
"$program" picture thicket/thicket --out "$root/docs/pictures/worlds/thicket.png" --size 800x500 --from -10.5,-11.5,5.2 --at 0.4,0,1.4
