// Four lobes with gaps of 25 degrees between them drive a robot around a box.
#include <doctest/doctest.h>

#include <fstream>

#include "finished.hpp"
#include "temporary_folder.hpp"

namespace thicket {

TEST_CASE("with four lobes a small robot goes around a box to its goal, without collision, though it does not see between them") {
  const TemporaryFolder folder;
  folder.write("w.toml", R"(name = "box"
[material.wall]
roughness = 1.0
[[solid]]
type = "box"
material = "wall"
position_m = [2.5, 0.1, 0.5]
size_m = [1.0, 1.6, 1.0]
)");
  std::string text = R"(world = "w.toml"
[vehicle]
preset = "small"
[planner]
name = "bug2"
goal_m = [5.0, 0.0]
clearance_m = 0.3
[map]
enabled = false
[limits]
time_s = 400.0
)";
  for (const char* yaw : {"0", "90", "180", "270"})
    text += std::string("[[sensor]]\npreset = \"x4m05\"\nname = \"lobe") + yaw + "\"\nyaw_deg = " + yaw + ".0\nposition_m = [0.0, 0.0, 0.4]\nrate_hz = 10.0\nazimuth_rays = 20\nelevation_rays = 20\n";
  for (const char* hand : {"left", "right"}) {
    auto mission = read_mission(folder.write("m.toml", text), {{"planner.hand", hand, "test"}});
    if (!mission) FAIL(mission.error().message);
    const Simulation simulation = finished(*mission);
    CAPTURE(hand);
    CAPTURE(simulation.verdict()->reason);
    CHECK(std::string(to_string(simulation.verdict()->kind)) == "reached");
    CHECK(simulation.totals().least_clearance > 0.05);
  }
}

}  // namespace thicket
