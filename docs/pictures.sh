#!/usr/bin/env bash
# Makes every picture of the docs anew, with the program; or those of one kind: bugs, maps, radar, sar, window, worlds.
set -euo pipefail
root=$(cd -- "$(dirname -- "${BASH_SOURCE[0]}")/.." && pwd)
program=${THICKET_PROGRAM:-$root/thicket}
runs=$(mktemp -d)
trap 'rm -rf -- "$runs"' EXIT

# Maps of missions.
map() {
  "$program" run "$1" --out "$runs/run" --quiet "${@:3}" || [[ $? == 3 ]] # closed: there is no way
  cp -- "$runs/run/map.png" "$root/docs/pictures/${2:-${1##*/}}.png"
}
# Ways of runs, of a file and under a name, and how long they are.
path() {
  "$program" run "$1" --out "$runs/run" --quiet "${@:3}" || [[ $? == 3 ]]
  cp -- "$runs/run/path.png" "$root/docs/pictures/bugs/$2.png"
  printf '%-28s %s\n' "$2" "$(awk -F '[:,] *' '/"verdict"|"path_length_m"/ { printf "%s ", $2 }' "$runs/run/result.json")"
}
# A problem of a family. A run that is stopped at once is wrong, and kept as a mission.
family() {
  "$program" reachability --families "$1" --first "$2" --problems 1 --planners bug2 --time-limit 0.1 --quiet --keep-failures "$runs/families" > "$runs/log" || [[ $? == 6 ]]
  path "$runs/families/$1-$2"-bug2-*.toml "family_$1" --set limits.time_s=3600
}
# Worlds as they look: the solids, each from where it is seen best, and the thicket.
look() {
  "$program" picture "$1" --out "$root/docs/pictures/worlds/$2.png" --size 640x400 "${@:3}"
}

# What sensors see.
scan() {
  "$program" scan "$2" "${@:3}" --png "$root/docs/pictures/radar/$1.png"
}

# Views of the window.
view() {
  "$program" render "$2" --view "$1" --at "$3" --out "$root/docs/pictures/window/$1.png" --size "$4" "${@:5}"
}

cd -- "$root" # files of sensors are named from here
if [[ ${1:-all} == all || $1 == window ]]; then
  mkdir -p -- docs/pictures/window
  view all foliage_wall/bug2 30 1280x800
  view world thicket/look_through 10 640x400
  view 3d thicket/look_through 10 640x400
  view map thicket/look_through 25 640x400
  view radar findings/lobes 10 640x400
  for name in planner plots profiler mission edit; do view "$name" foliage_wall/bug2 30 640x400; done
fi
if [[ ${1:-all} == all || $1 == radar ]]; then
  mkdir -p -- docs/pictures/radar
  scan penetration foliage_wall/divided_room --pose -2.6,1.475,0.4,0 --sensor usarsim2012 --sensor utm30lx --set fov_deg=180
  scan side_rays rooms/u_room --pose -2,0,0.4,180 --sensor usarsim2012 --sensor radar/presets/usarsim2012.toml \
    --set usarsim2012.side_offset_m=0.4 --set 'divergence="side_rays"' --set fov_deg=170 --set range_max_m=10
  scan ghost strafe/mirror --pose 0,0,0.4,0 --sensor usarsim2012 --set bounces_max=2 --set 'scattering="material"' --compare usarsim2012
  scan room_of_mirrors test_room/test_room --pose -1,0.5,1,0 --sensor usarsim2012 --set bounces_max=2 --set 'scattering="material"' --set fov_deg=180
  awk 'BEGIN { print "x_m,y_m,z_m,yaw_deg,label"
    for (t = 0; t <= 80; ++t) { a = t * 3.14159265 / 180; printf "%.6f,%.6f,1,%d,%d\n", 3 - 3 * cos(a), -3 * sin(a), t, t } }' > "$runs/tilt.csv"
  scan tilt strafe/plate_alone --poses "$runs/tilt.csv" --x-label "tilt, deg" --sensor x4m05 --sensor radar/presets/x4m05.toml \
    --set 'x4m05.scattering="lambert"' --set noise=0 --set bin_count=768
  scan wire strafe/wire --pose 0,-1.2,1,0 --to 0,1.2,1,0 --steps 121 --sensor x4m05 --sensor radar/presets/x4m05.toml \
    --set 'x4m05.sampling="regular"' --set 'scattering="lambert"' --set noise=0 --set elevation_opening_deg=20 --set elevation_rays=18 --set bin_count=768
  for world in plate pole wire; do
    scan "strafe_$world" "strafe/$world" --pose 0,-2,1,0 --to 0,2,1,0 --steps 81 --sensor x4m05 --set bin_count=96 --set bin_size_m=0.0514
  done
  scan strafe_plate45 strafe/plate45 --pose 0,-2,1,0 --to 0,2,1,0 --steps 61 --sensor x4m05 --sensor radar/presets/x4m05.toml \
    --set 'x4m05.scattering="lambert"' --set noise=0 --set bin_count=96 --set bin_size_m=0.0514
  scan lobe strafe/mirror --pose 0,0,0.5,0 --sensor x4m05 --set 'detection="all"' --set bin_count=192 --set bin_size_m=0.0514
  scan smoothing strafe/mirror --pose 0,0,0.5,0 --sensor x4m05 --set smoothing_bins=15 --set noise=0.008 --compare x4m05
  scan cfar test_room/test_room --pose 1,2.6,1,0 --sensor x4m05 --set 'detector="ca_cfar"' --set cfar_guard_bins=25 --set cfar_training_bins=50 --set floor_gate=false --compare x4m05
  scan floor_gate test_room/test_room --pose 0,2.5,1,180 --sensor x4m05 --set floor_gate=false --compare x4m05
fi
if [[ ${1:-all} == all || $1 == sar ]]; then
  mkdir -p -- docs/pictures/sar
  "$program" run sar/strafe --out "$runs/sar" --quiet
  cp -- "$runs/sar/sar.png" docs/pictures/sar/back_projection.png
  "$program" sar "$runs/sar" --method simple_sum --set sar.fuse=false --out "$runs/summed"
  cp -- "$runs/summed/sar.png" docs/pictures/sar/simple_sum.png
fi
if [[ ${1:-all} == all || $1 == maps ]]; then
  for mission in foliage_wall/{bug1,bug2,closed,smoke,map_radar,map_first_echo,map_lidar} rooms/{convex,u,spiral}; do map "$mission"; done
  "$program" run foliage_wall/map_radar --out "$runs/run" --quiet --set 'output.map_formats="picture"'
  cp -- "$runs/run/map_probability.png" "$root/docs/pictures/map_probability.png"
  # What 2018 missed: the room as it is, and its maps in cells of two sizes and by lobes.
  "$program" picture findings/room --out "$root/docs/pictures/found_room.png" --size 640x400 --from 0.5,-6,7 --at 5,3,0.3 --hide ceiling
  map findings/beams found_beams_005 --set map.resolution_m=0.05
  map findings/beams found_beams_05 --set map.resolution_m=0.5
  map findings/lobes found_lobes_01 --set map.resolution_m=0.1
  map thicket/look_through thicket_radar
  map thicket/look_through_lidar thicket_lidar
fi
if [[ ${1:-all} == all || $1 == bugs ]]; then
  mkdir -p -- docs/pictures/bugs
  for mission in bug{1,2}_{success,failure} bug2_2012_{wrong,right} two_combs_bug{1,2} comb_bug{1,2}; do path "bugs/$mission" "$mission"; done
  path bugs/bug2_success drift --set odometry.turn_scale=1.01 --set odometry.speed_noise_m_s=0.1 --set odometry.turn_noise_rad_s=0.05
  for mission in wall_then_inside bounce center_out explore; do path "explorers/$mission" "$mission"; done
  for problem in convex,2 spiral,2 maze,0 comb,0 enclosed,2 goal,2 m_line,0 thin,4 twins,1 random,4; do family "${problem%,*}" "${problem#*,}"; done
fi
[[ ${1:-all} == all || $1 == worlds ]] || exit 0
mkdir -p -- "$root/docs/pictures/worlds"
for solid in box sphere cylinder wall prism map tilted smoke; do look "solids/$solid" "$solid"; done
look solids/mesh mesh --from -4.9,-7.1,3.3 --at 0,-0.9,0.5 --fov-deg 43
look solids/tree tree --from -5.5,-11,3.6 --at 0.2,0,3.4
look solids/hedge hedge --from -2.8,-5,2.3 --at 0.1,-0.1,0.7
look solids/instances instances --from -7,-12,5.5 --at 0.3,2,1.3
look solids/motion motion --time 2 --at -0.3,-0.2,0.6 --from -4.5,-7,4.4
"$program" picture thicket/thicket --out "$root/docs/pictures/worlds/thicket.png" --size 800x500 --from -10.5,-11.5,5.2 --at 0.4,0,1.4
