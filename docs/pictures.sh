#!/usr/bin/env bash
# Makes every picture of the docs anew, with the program.
set -euo pipefail
root=$(cd -- "$(dirname -- "${BASH_SOURCE[0]}")/.." && pwd)
runs=$(mktemp -d)
trap 'rm -rf -- "$runs"' EXIT
for mission in foliage_wall/{bug1,bug2,closed,smoke,map_radar,map_lidar} rooms/{convex,u,spiral}; do
  "$root/thicket" run "$mission" --out "$runs/run" --quiet || [[ $? == 3 ]] # closed: there is no way
  cp -- "$runs/run/map.png" "$root/docs/pictures/${mission##*/}.png"
done
