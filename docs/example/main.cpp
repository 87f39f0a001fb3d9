// A radar looks at a bush before a wall; Bug2 decides what to do about it.
#include <cstdio>

#include <thicket/nav/planner.hpp>
#include <thicket/radar/sensor.hpp>

using namespace thicket;

int main() {
  World world;
  world.materials = {{.name = "wall"}, {.name = "foliage", .reflectivity = 0.05, .attenuation_db_per_m = 4.0}};
  world.solids = {{"wall", 0, {6.0, 0.0, 1.0}, 0.0, Box{{0.2, 8.0, 2.0}}}, {"bush", 1, {3.0, 0.0, 0.3}, 0.0, Sphere{0.8}}};
  const auto scene = Scene::build(world);
  if (!scene) return 1;

  const auto radar = make_sensor(ScanningRadarSpec{}, 0);
  Scan scan;
  radar->measure(*scene, Pose{}, 0.0, 0, Random(1, 0), scan);
  for (const Echo& echo : scan.echoes_of(scan.beams[180])) std::printf("echo at %.2f m, amplitude %.3f\n", echo.range, static_cast<double>(echo.amplitude));

  const PlannerSpec spec{.name = "bug2", .goal_m = glm::dvec2(8.0, 0.0)};
  const VehicleLimits vehicle;
  Contour contour;
  read_contour(scan, contour);
  BumperRing bumpers({}, vehicle.hull_radius, press_distance({}, spec, vehicle));
  bumpers.read(contour);
  const auto planner = make_planner(spec, vehicle, Pose2{});
  const Decision decision = (*planner)->decide({0.0, Pose2{}, 0.0, 0.0, contour, bumpers});
  std::printf("%s: %.2f m/s, %.2f rad/s\n", decision.state.c_str(), decision.command.speed, decision.command.turn_rate);
}
