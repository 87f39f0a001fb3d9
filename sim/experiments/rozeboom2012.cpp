// The experiments of Rozeboom 2012, "Navigation using a radar sensor in USARSim".
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include "context.hpp"
#include "thicket/sim/outputs.hpp"

namespace thicket {
namespace {

/// The laser that the radar is held against: its range and beams, so that nothing but the medium tells the two apart.
LidarSpec equal_laser() {
  LidarSpec laser;
  laser.range_max_m = 30.0;
  return laser;
}

double observed(const FinishedRun& run) {
  const auto& region = run.simulation.mission().output.observed_region_m;
  return region ? observed_share(run.simulation, *region).value_or(NAN) : NAN;
}

std::string verdict_of(const FinishedRun& run) { return to_string(run.simulation.verdict()->kind); }

// --- figures 1 to 5: the clearing

/// Whether a scan has an echo within 0.25 m of the plan of what is called so ("bush 1" is also "bush 1/leaves").
bool is_seen(const World& world, const std::string& name, const Scan& scan, const ScanPose& pose) {
  std::optional<Bounds> box;
  for (const Solid& solid : world.solids)
    if (solid.name == name || solid.name.starts_with(name + "/")) box = box ? join(*box, extent(solid)) : extent(solid);
  if (!box) throw ExperimentFailure(fmt::format("there is no solid '{}' in '{}'", name, world.name));
  for (const Beam& beam : scan.beams)
    for (const Echo& echo : scan.echoes_of(beam)) {
      const double angle = radians(pose.yaw_deg) + beam.azimuth;
      const glm::dvec2 at = glm::dvec2(pose.position) + echo.range * glm::dvec2(std::cos(angle), std::sin(angle));
      const glm::dvec2 off = glm::max(glm::max(glm::dvec2(box->low) - at, at - glm::dvec2(box->high)), glm::dvec2(0.0));
      if (glm::length(off) < 0.25) return true;
    }
  return false;
}

/// Share of the beams whose first echo is where it is in another scan of the same beams, to 0.1 m.
double same_first(const Scan& scan, const Scan& other) {
  std::size_t same = 0;
  for (std::size_t i = 0; i < scan.beams.size(); ++i) {
    const auto a = scan.echoes_of(scan.beams[i]), b = other.echoes_of(other.beams[i]);
    same += a.empty() == b.empty() && (a.empty() || std::abs(a[0].range - b[0].range) < 0.1);
  }
  return static_cast<double>(same) / static_cast<double>(scan.beams.size());
}

std::string clearing(ExperimentContext& context) {
  const ScanPose pose{{-10.0, 0.0, 0.4}, 0.0, 0.0, {}};
  const Scene clear = context.scene("clearing/clearing"), dust = context.scene("clearing/clearing_in_dust"), rain = context.scene("clearing/clearing_in_rain");
  const SensorSpec radar = context.sensor("", "usarsim2012").spec, laser = equal_laser();
  std::string text = "Four bushes of leaves, four steel poles and four boxes in a fenced clearing of 32 × 28 m (`worlds/data/clearing/`; which, where and how large is ours). Dust is a cloud 14 m wide before the robot, in which a person sees 8 m far: an extinction of light of 0.5 per metre (Koschmieder 1924), and at most 0.001 dB/m for radar (ours). Heavy rain is "
                     "50 mm/h everywhere: 0.0034 per metre (ITU-R P.1814), and 0.007 dB/m for radar at 24 GHz (ITU-R P.838-3). Two of the things stand behind others. The laser has the range and the beams of the radar: 360 of them, 30 m.\n\n";
  const PictureView view{glm::dvec3(-15.0, -9.0, 6.0), glm::dvec3(1.0, 0.0, 0.2), 50.0, 480, 270, {}};
  text += context.world_picture("scene", clear, view, "The scene (its figure 1).");
  text += context.world_picture("dust", dust, view, "The same with the cloud of dust. The camera sees as light does.");

  RayPicture readings;
  readings.low = {-16.3, -14.3};
  readings.high = {16.3, 14.3};
  readings.scale = 13.0;
  std::vector<TableRow> rows;
  const std::vector<std::string> things = {"bush 1", "bush 2", "bush 3", "bush 4", "pole 1", "pole 2", "pole 3", "pole 4", "box 1", "box 2", "box 3", "box 4"};
  for (const auto& [name, spec] : {std::pair<std::string, SensorSpec>{"radar", radar}, {"laser", laser}}) {
    const Scan reference = context.look(clear, spec, pose)[0];
    for (const auto& [air, scene, mission] : {std::tuple{"clear air", &clear, "clear"}, {"dust", &dust, "dust"}, {"heavy rain", &rain, "rain"}}) {
      const Scan scan = context.look(*scene, spec, pose)[0];
      const auto seen = std::count_if(things.begin(), things.end(), [&](const std::string& thing) { return is_seen(clear.world(), thing, scan, pose); });
      const FinishedRun run = context.run(fmt::format("clearing/{}_{}", name, mission), context.brief() ? std::vector<std::string>{"sensor.rate_hz=2"} : std::vector<std::string>{});
      rows.push_back({name, air, fmt::format("{} of {}", seen, things.size()), percent(same_first(scan, reference)), fixed(static_cast<double>(run.simulation.map().known_cells()) * 0.01, 0)});
      if (air != std::string("heavy rain")) readings.panels.push_back({fmt::format("{}, {}", name, air), scene, glm::dvec2(pose.position), 0.0, {scan}, false, 0.0, 0.0});
    }
  }
  text += context.ray_picture("readings", readings, "Readings of one place: the radar in clear air and dust (its figures 2 and 3), and the laser (4 and 5).");
  text += table({"sensor", "air", "things seen from one place", "beams whose first echo is that of clear air, within 0.1 m", "area mapped in a drive of 6 m, m²"}, rows, 2);
  text += "**What differs.** The radar has the same echoes in dust as in clear air, as the source says. The laser sees the front of the cloud as a wall, 2 m deep in it (where the optical depth is 1), and nothing in or behind it. Real "
          "dust is ragged; ours is even. *Heavy rain*: the source says that it shows similar results. Ours does not: with 0.0034 per metre even the "
          "laser loses nearly nothing over 30 m. What disturbs a real laser in rain, echoes of single drops near it and water on its window, is not modelled. Our radar gives all echoes of a beam, so that it "
          "also sees the fence behind leaves.\n";
  return text;
}

// --- figures 6 to 8: the room

std::string foliage_room(ExperimentContext& context) {
  std::string text = "`worlds/data/foliage_wall/`: a room of 24 × 16 m, spheres of radius 1.5 m every 2.95 m across it, foliage of 8 dB/m and a budget of 10 dB, so that a ray passes 1.25 m of it. All of that is ours; the text prints no sizes.\n\n";
  const Scene scene = context.scene("foliage_wall/divided_room");
  text += context.world_picture("room", scene, {{}, {}, 50.0, 480, 300, {}}, "The room (its figure 6).");
  const ScanPose pose{{-4.0, 1.475, 0.4}, 0.0, 0.0, {}};
  const SensorSpec radar = context.sensor("", "usarsim2012").spec, hokuyo = context.sensor("", "urg04lx").spec, laser = equal_laser();
  RayPicture readings;
  readings.low = {-12.3, -8.3};
  readings.high = {12.3, 8.3};
  readings.scale = 17.0;
  for (const auto& [title, spec] : {std::pair<const char*, SensorSpec>{"Hokuyo URG-04LX, 4 m (figure 7)", hokuyo}, {"radar, 30 m (figure 8)", radar}, {"laser of the radar's range, 30 m", laser}})
    readings.panels.push_back({title, &scene, glm::dvec2(pose.position), 0.0, context.look(scene, spec, pose), false, 0.0, 0.0});
  auto short_radar = std::get<ScanningRadarSpec>(radar);
  short_radar.range_max_m = 4.0;
  readings.panels.push_back({"radar of the Hokuyo's range, 4 m", &scene, glm::dvec2(pose.position), 0.0, context.look(scene, short_radar, pose), false, 0.0, 0.0});
  text += context.ray_picture("readings", readings, "Readings of one place. With equal ranges, long or short, it is the foliage and nothing else that tells radar and laser apart.");

  const FinishedRun by_radar = context.run("foliage_wall/map_radar"), by_laser = context.run("foliage_wall/map_lidar"), first = context.run("foliage_wall/map_first_echo");
  const FinishedRun by_hokuyo = context.run("foliage_wall/map_lidar", {"sensor.range_max_m=4", "sensor.fov_deg=240"}), near = context.run("foliage_wall/map_radar", {"sensor.range_max_m=4"});
  std::vector<TableRow> rows;
  for (const auto& [name, range, run] : {std::tuple{"radar", "30 m", &by_radar}, {"radar, first echoes only", "30 m", &first}, {"radar", "4 m", &near}, {"laser", "30 m", &by_laser}, {"laser over 240°, as the Hokuyo's", "4 m", &by_hokuyo}})
    rows.push_back({name, range, percent(observed(*run))});
  text += table({"sensor", "range", "of the free area behind the foliage, mapped in a drive before it"}, rows, 2);
  text += cost_table({"sensor", "range"}, {{{"radar", "30 m"}, &by_radar}, {{"laser", "30 m"}, &by_laser}});
  text += "**What differs.** As in the source, the laser sees a closed wall and the radar sees holes, and the room behind through them. In its figure 8 a beam that is used up inside a bush still gives a range, inside the bush; here that is "
          "no echo: the bush's surface is the obstacle, what was passed is *sensed through*, and beyond nothing is known. Its radar gives the one range of a beam, ours every echo of it (rings: backs of bushes).\n";
  return text;
}

// --- figures 9 to 12: beam divergence

ScanningRadarSpec with_sides(const ScanningRadarSpec& radar, double offset, const std::string& geometry) {
  ScanningRadarSpec spec = radar;
  if (offset > 0.0) spec.divergence = "side_rays";
  spec.side_offset_m = offset;
  spec.side_geometry = geometry;
  return spec;
}

/// How far the first echoes of many scans lie from those without side rays.
struct Smear {
  double mean = 0.0, p95 = 0.0, far = 0.0;  ///< m, m, share of more than 0.5 m
};
Smear smear_of(const std::vector<Scan>& scans, const Scan& plain) {
  std::vector<double> off;
  for (const Scan& scan : scans)
    for (std::size_t i = 0; i < scan.beams.size(); ++i) {
      const auto a = scan.echoes_of(scan.beams[i]), b = plain.echoes_of(plain.beams[i]);
      if (!a.empty() && !b.empty()) off.push_back(std::abs(a[0].range - b[0].range));
    }
  if (off.empty()) return {};
  std::sort(off.begin(), off.end());
  Smear smear;
  for (const double o : off) smear.mean += o / static_cast<double>(off.size());
  smear.p95 = off[off.size() * 95 / 100];
  smear.far = static_cast<double>(off.end() - std::upper_bound(off.begin(), off.end(), 0.5)) / static_cast<double>(off.size());
  return smear;
}

std::string side_beams(ExperimentContext& context) {
  const Scene scene = context.scene("foliage_wall/divided_room");
  const auto radar = std::get<ScanningRadarSpec>(context.sensor("", "usarsim2012").spec);
  const ScanPose pose{{-4.0, 1.475, 0.4}, 0.0, 0.0, {}};
  const int scans = context.unless_brief(100, 10);
  std::string text = "`divergence = \"side_rays\"`: a beam is its middle, left or right ray, one of three by equal chance. 250 UDK units are a metre, so N = 50 is 0.2 m and N = 100 is 0.4 m. The text does not say where N is measured: it may be "
                     "the offset at the end of the range (`side_geometry = \"diverging\"`, ours where nothing else is said) or at the sensor (`\"parallel\"`). Both are here.\n\n";
  RayPicture readings;
  readings.low = {-12.3, -8.3};
  readings.high = {12.3, 8.3};
  readings.scale = 17.0;
  std::vector<TableRow> rows;
  const Scan plain = context.look(scene, radar, pose)[0];
  readings.panels.push_back({"no side rays (figure 8)", &scene, glm::dvec2(pose.position), 0.0, {plain}, false, 0.0, 0.0});
  for (const auto& [name, offset] : {std::pair{"N = 50", 0.2}, {"N = 100", 0.4}})
    for (const char* geometry : {"parallel", "diverging"}) {
      const auto many = context.look(scene, with_sides(radar, offset, geometry), pose, scans);
      const Smear smear = smear_of(many, plain);
      rows.push_back({name, geometry, fixed(smear.mean, 3), fixed(smear.p95), percent(smear.far)});
      if (geometry == std::string("parallel")) readings.panels.push_back({fmt::format("{} (figure {})", name, offset < 0.3 ? 9 : 10), &scene, glm::dvec2(pose.position), 0.0, {many[0]}, false, 0.0, 0.0});
    }
  readings.panels.push_back({"N = 100, diverging to the range of 30 m", &scene, glm::dvec2(pose.position), 0.0, context.look(scene, with_sides(radar, 0.4, "diverging"), pose), false, 0.0, 0.0});
  text += context.ray_picture("readings", readings, "Readings in the room (its figures 9 and 10); parallel side rays but in the last picture.");
  text += fmt::format("First echoes of {} scans from there, against those without side rays:\n\n", scans);
  text += table({"N", "side rays are", "mean difference, m", "95 % within, m", "more than 0.5 m off"}, rows, 2);

  // Its figures 11 and 12: all three rays of each beam. Which of them a scan takes is chance: those of enough scans.
  RayPicture fan;
  fan.low = {-5.0, -1.2};
  fan.high = {0.8, 4.2};
  fan.scale = 48.0;
  fan.hull_radius = 0.356;
  for (const char* geometry : {"parallel", "diverging"})
    for (const auto& [name, offset] : {std::pair{"N = 50 (figure 11)", 0.2}, {"N = 100 (figure 12)", 0.4}}) {
      ScanningRadarSpec spec = with_sides(radar, offset, geometry);
      spec.fov_deg = 60.0;
      spec.step_deg = 4.0;
      spec.range_max_m = 8.0;
      const bool parallel = geometry == std::string("parallel");
      fan.panels.push_back({fmt::format("{}, {}", name, geometry), &scene, glm::dvec2(pose.position), 0.0, context.look(scene, spec, pose, 30), true, parallel ? 0.0 : std::atan(offset / spec.range_max_m), parallel ? offset : 0.0});
    }
  text += context.ray_picture("fans", fan, "The side rays of a P3-AT's radar before the bushes (its figures 11 and 12), here every 4° over 60° and to 8 m so that single ones can be told apart. A ray ends where its budget is used up.");
  text += "**What differs.** As the text says, the noise becomes visible: walls become ragged, more so for N = 100, and at both ends the fans of the two sides stand out beyond each other. With N at the end of a range of 30 m the "
          "side rays turn by 0.4° and 0.8°, less than the step of 1°, and the noise is small; with N at the sensor walls are ragged by as much as N. Its future work is here too: chances by the angle of the surface "
          "(`side_choice = \"incidence\"`), the strongest or the sum of all three, and beams that widen in all directions (`divergence = \"cone\"`).\n";
  return text;
}

// --- figures 13 and 14

std::string bugs(ExperimentContext& context) {
  std::string text = "The same shapes as missions; `path.png` of each is in [navigation.md](navigation.md), which has the whole family with bounds and an oracle.\n\n";
  std::vector<TableRow> rows;
  for (const auto& [figure, mission] : {std::pair{"13, top", "bugs/bug1_success"}, {"13, bottom", "bugs/bug1_failure"}, {"14, top", "bugs/bug2_success"}, {"14, bottom", "bugs/bug2_failure"}, {"14, the text's own rule of failure", "bugs/bug2_2012_wrong"}}) {
    const FinishedRun run = context.run(mission);
    rows.push_back({figure, fmt::format("`{}`", mission), verdict_of(run), fixed(run.simulation.totals().path_length, 1), fixed(run.simulation.totals().least_clearance)});
  }
  text += table({"figure", "mission", "verdict", "path, m", "least clearance, m"}, rows, 3);
  text += "**What differs.** The text describes both algorithms and builds neither; here they drive by the bumpers that it describes. Its rule for the failure of Bug2 (it gives up when it comes back to the line no nearer to the goal) is wrong: the last row is a goal that can "
          "be reached, which it gives up. Bug2 proper goes on along the boundary (Lumelsky & Stepanov).\n";
  return text;
}

// --- figure 15

std::string explored(ExperimentContext& context) {
  const std::vector<std::string> sets = context.brief() ? std::vector<std::string>{"planner.explore_m=40"} : std::vector<std::string>{};
  const FinishedRun by_radar = context.run("foliage_wall/explored", sets);
  std::vector<std::string> first_sets = sets;
  first_sets.emplace_back("sensor.first_echo_only=true");
  const FinishedRun first = context.run("foliage_wall/explored", first_sets);
  std::string text = "`foliage_wall/explored`: a P3-AT explores its side of the room by itself, once along the wall and then in lanes, as section 5 of the text sketches it. The pose is the true one, for there is no SLAM yet.\n\n";
  text += context.map_picture("map", by_radar, "The map in the colours of its figure 15.");
  // A core of a bush: within 0.3 m of its middle.
  std::size_t core = 0, core_known = 0;
  const OccupancyMap& map = by_radar.simulation.map();
  for (const Solid& solid : by_radar.simulation.scene().world().solids) {
    if (!solid.name.starts_with("bush") || std::abs(solid.position.y) > 6.0) continue;
    for (double x = 0.3; x < 0.8; x += 0.1)
      for (double y = -0.15; y < 0.2; y += 0.1, ++core) core_known += map.view(map.cell_at(glm::dvec2(solid.position) + glm::dvec2(x, y))).known;
  }
  text += table({"", "radar, all echoes", "first echoes only, as other sensors"},
                {{"verdict", verdict_of(by_radar), verdict_of(first)},
                 {"driven, m", fixed(by_radar.simulation.totals().path_length, 1), fixed(first.simulation.totals().path_length, 1)},
                 {"least clearance, m", fixed(by_radar.simulation.totals().least_clearance), fixed(first.simulation.totals().least_clearance)},
                 {"of the free area behind the foliage, mapped", percent(observed(by_radar)), percent(observed(first))},
                 {"cells in the cores of bushes known, of " + std::to_string(core), std::to_string(core_known), "-"}});
  text += cost_table({"run"}, {{{"radar"}, &by_radar}});
  text += "**What differs.** As in the source: behind the foliage the map is mostly white or grey, small cores of blue stay in the bushes where no ray gets through, the bushes' insides are clear to the sensor and not to the robot (here green, the "
          "source has its grey), and black dots stand around them. Blue wedges behind the cores are their shadows; the text tells of none; its robot was driven by hand on a way that it does not tell. With first echoes only all of the right side "
          "stays blue. The source's poses came from SLAM; ours are true.\n";
  return text;
}

// --- its future work: real leaves

/// The world with each of its meshes replaced by the box around it, and all of that by what a box of USARSim is: opaque.
World as_boxes(World world) {
  Material box = world.materials.at(0);
  box.name = "box of a collision model";
  box.attenuation_db_per_m = INFINITY;
  for (Solid& solid : world.solids) {
    if (!std::holds_alternative<MeshSolid>(solid.shape)) continue;
    const Bounds around = extent(solid);
    solid.shape = Box{around.high - around.low};
    solid.position = 0.5 * (around.low + around.high);
    solid.yaw = solid.pitch = solid.roll = 0.0;
    solid.material = static_cast<std::uint32_t>(world.materials.size());
  }
  world.materials.push_back(box);
  return world;
}

std::string leaves(ExperimentContext& context) {
  const std::vector<std::string> sets = context.brief() ? std::vector<std::string>{"planner.waypoints_m=[[-2.2,-4.8],[-2.2,4.8]]", "sensor.rate_hz=5"} : std::vector<std::string>{};
  const FinishedRun radar = context.run("thicket/look_through", sets), laser = context.run("thicket/look_through_lidar", sets);
  const Simulation prepared = context.prepare("thicket/look_through", sets);
  Simulation boxes = or_fail(Simulation::create(prepared.mission(), as_boxes(prepared.scene().world())));
  while (boxes.step()) {
  }
  std::string text = "`worlds/data/thicket/`: a garden with brush and young trees from wall to wall, of leaves and twigs of two triangles each, about 8 m² of leaf in a cubic metre. A small robot drives along it.\n\n";
  text += context.world_picture("thicket", context.scene("thicket/closed_thicket"), {glm::dvec3(-10.5, -11.5, 5.2), glm::dvec3(0.4, 0.0, 1.4), 50.0, 400, 230, {}}, "The thicket.");
  text += context.map_picture("radar", radar, "The map by radar.");
  text += table({"plants are", "sensor", "of the free area behind them, mapped"},
                {{"leaves", "radar", percent(observed(radar))}, {"leaves", "laser of the same range", percent(observed(laser))}, {"the boxes around them, as in USARSim", "radar", percent(observed_share(boxes, *prepared.mission().output.observed_region_m).value_or(NAN))}}, 2);
  text += cost_table({"plants", "sensor"}, {{{"leaves", "radar"}, &radar}, {{"leaves", "laser"}, &laser}});
  text += "**What differs.** The source could not do this: *trees and other foliage exist in the UDK environment, however the collision models are not very detailed*, so that a tree reads as a box. With leaves the radar looks between them and "
          "through them. Laser rays find some gaps between leaves too, but few.\n";
  return text;
}

}  // namespace

std::vector<Experiment> rozeboom2012_experiments() {
  const std::string text = "Rozeboom 2012, ";
  return {
      {"rozeboom2012/clearing", "Plants, poles and boxes in clear air, dust and rain", text + "figures 1 to 5 (after Peynot, Scheding & Terho 2010)",
       "Figure 1 is a scene with plants, poles and boxes. Figures 2 and 3 are a radar's readings of it in clear air and in heavy dust: little to no interference. Figures 4 and 5 are a laser's, which dust influences much. Heavy rain, it says, shows similar results.", clearing},
      {"rozeboom2012/foliage_room", "A room divided by foliage", text + "figures 6 to 8",
       "Figure 6 is the test room in UDK: a wall of foliage spheres divides it. Figure 7 is what a Hokuyo laser reads: a closed wall. Figure 8 is the ground truth of the radar: through the thin edges of the spheres it sees holes and part of the room behind; "
       "through their middles it does not.", foliage_room},
      {"rozeboom2012/side_beams", "Side beams, N = 50 and N = 100", text + "figures 9 to 12",
       "Figures 9 and 10 are the radar's readings with side beams of N = 50 and N = 100 units: the noise becomes visible. Figures 11 and 12 show the beams on the P3-AT, red to the left and blue to the right of the original ones: in the middle they "
       "overlap, at both ends they exceed each other. N = 100 is for show; 50 and less is recommended.", side_beams},
      {"rozeboom2012/bugs", "Bug1 and Bug2", text + "figures 13 and 14", "Drawings of Bug1 (figure 13) and Bug2 (figure 14): above, each finds a way to the goal; below, it reports that there is none.", bugs},
      {"rozeboom2012/explored", "The explored map", text + "figure 15",
       "The test room from above as USARCommander mapped it: blue where the sensor cannot sense, white where it can, grey what is clear to it, black dots for walls and around the foliage. The part right of the foliage is mostly white; small cores of blue are in "
       "the middle of the foliage. Other sensors leave the right side blue.", explored},
      {"rozeboom2012/leaves", "Leaves instead of spheres", text + "section 7 (future work)", "No figure: collision models of plants are boxes in UDK, and better ones 'would allow for more realistic scenes and readings'.", leaves},
  };
}

}  // namespace thicket
