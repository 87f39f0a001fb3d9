// path.png, read back: what is drawn where.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "temporary_folder.hpp"
#include "thicket/base/files.hpp"
#include "thicket/base/image.hpp"
#include "thicket/sim/outputs.hpp"
#include "thicket/sim/run.hpp"

namespace thicket {
namespace {

struct Drawn {
  Simulation simulation;
  Trajectory trajectory;
};

/// A box, 2 m x 4 m, about the origin of a stated field of 20 m x 10 m, and smoke before the goal; the robot drives around the box from (-8, 0) to (8, 0).
Drawn around_a_box(const TemporaryFolder& folder, const std::string& hand) {
  folder.write("w.toml", R"(name = "box"
bounds_m = [-10.0, -5.0, 10.0, 5.0]
[material.wall]
[[solid]]
type = "box"
material = "wall"
position_m = [0.0, 0.0, 0.5]
size_m = [2.0, 4.0, 1.0]
[[solid]]
type = "box"
material = "smoke"
position_m = [-5.0, 4.0, 0.5]
size_m = [2.0, 1.0, 1.0]
)");
  const auto mission = read_mission(folder.write("m.toml", R"(world = "w.toml"
[start]
x_m = -8.0
[vehicle]
preset = "small"
[[sensor]]
preset = "bumpers"
[planner]
goal_m = [8.0, 0.0]
clearance_m = 0.35
[map]
enabled = false
)"),
                                    {{"planner.hand", hand, "test"}});
  if (!mission) FAIL(mission.error().message);
  auto simulation = Simulation::create(*mission);
  if (!simulation) FAIL(simulation.error().message);
  Drawn drawn{*simulation, {}};
  run(drawn.simulation, drawn.trajectory, {});
  return drawn;
}

/// The part of the picture that shows the world is its frame, as wide as the picture without margins of 16 pixels, and begins 50 pixels below the top; 20 m are as wide as the field is.
struct Picture {
  GreyImage image;
  double scale() const { return (image.width - 32.0) / 20.0; }
  int grey(double x_m, double y_m) const { return image.at(static_cast<int>(16.0 + (x_m + 10.0) * scale()), static_cast<int>(50.0 + (5.0 - y_m) * scale())); }
  /// The darkest pixel within 4 of a place: of a line, for grey of words and marks is darker.
  int darkest(double x_m, double y_m) const {
    int least = 255;
    for (double dx = -4.0; dx <= 4.0; ++dx)
      for (double dy = -4.0; dy <= 4.0; ++dy) least = std::min(least, grey(x_m + dx / scale(), y_m + dy / scale()));
    return least;
  }
};

Picture picture_of(const TemporaryFolder& folder, const Drawn& drawn) {
  const auto file = folder.path() / "path.png";
  const auto written = write_path_picture(file, drawn.simulation, drawn.trajectory);
  if (!written) FAIL(written.error().message);
  const auto image = read_image(file);
  REQUIRE(image);
  return {*image};
}

}  // namespace

TEST_CASE("path picture: matter, the band around it, smoke and free ground are where they are") {
  const TemporaryFolder folder;
  const Drawn drawn = around_a_box(folder, "left");
  REQUIRE(drawn.simulation.verdict()->kind == Verdict::Kind::reached);
  const Picture picture = picture_of(folder, drawn);
  // Bounds of 20 m x 10 m are more than the margin of 1.5 times hull and clearance around the way.
  CHECK(picture.image.width == 932);
  const int matter = picture.grey(0.5, 1.0), band = picture.grey(0.5, 2.25), free = picture.grey(3.0, 3.5), smoke = picture.grey(-5.5, 4.2);
  CHECK(matter == 65);
  CHECK(free == 255);
  CHECK(band < 235);
  CHECK(band > 200);
  // In grey smoke looks like the band; there is none where it is.
  CHECK(smoke < 235);
  CHECK(smoke > 200);
  CHECK(picture.grey(-7.5, 4.2) == 255);
  // To two pixels the matter ends at 2 m, the band at 2.5 m.
  const double two = 2.0 / picture.scale();
  CHECK(picture.grey(0.5, 2.0 - two) == matter);
  CHECK(picture.grey(0.5, 2.0 + two) == band);
  CHECK(picture.grey(0.5, 2.5 - two) == band);
  CHECK(picture.grey(0.5, 2.5 + two) >= 250);
}

TEST_CASE("path picture: the way is where it was driven, and not on the other side") {
  const TemporaryFolder folder;
  for (const std::string hand : {"left", "right"}) {
    CAPTURE(hand);
    const Drawn drawn = around_a_box(folder, hand);
    const Picture picture = picture_of(folder, drawn);
    // The left hand on the wall turns right: south of the box.
    const double side = hand == "left" ? -1.0 : 1.0;
    std::size_t seen = 0, driven = 0, following = 0, straight_in_orange = 0, following_in_orange = 0;
    for (const auto& p : drawn.trajectory.points()) {
      const glm::dvec2& at = p.pose.position;
      if (at.x < -6.0 || at.x > 6.0) continue;
      ++driven;
      seen += picture.grey(at.x, at.y) < 180;
      // The mean of the channels is 98 of the blue of straight ways and 128 of the orange along boundaries.
      const bool orange = std::abs(picture.grey(at.x, at.y) - 128) < 10, follows = p.state.starts_with("following");
      following += follows;
      (follows ? following_in_orange : straight_in_orange) += orange;
      if (std::abs(at.x) < 1.0) {
        CHECK(at.y * side > 2.3);
        CHECK(picture.darkest(at.x, -at.y) >= 200);
      }
    }
    CHECK(driven > 100);
    // But for the marks, which are white inside.
    CHECK(static_cast<double>(seen) > 0.9 * static_cast<double>(driven));
    CHECK(following > 50);
    CHECK(driven - following > 50);
    CHECK(static_cast<double>(following_in_orange) > 0.9 * static_cast<double>(following));
    CHECK(static_cast<double>(straight_in_orange) < 0.1 * static_cast<double>(driven - following));
    // The goal is a cross, and the start a disc.
    CHECK(picture.grey(8.0, 0.0) < 120);
    CHECK(picture.grey(-8.0, 0.0) < 40);
  }
}

TEST_CASE("path picture: the same run gives the same bytes, another run others") {
  const TemporaryFolder folder;
  const auto bytes = [&](const std::string& hand) {
    const Drawn drawn = around_a_box(folder, hand);
    picture_of(folder, drawn);
    return *read_text_file(folder.path() / "path.png");
  };
  const std::string first = bytes("left");
  CHECK(bytes("left") == first);
  CHECK(bytes("right") != first);
}

TEST_CASE("path picture: a world without matter, a goal far away and a run of no length have one, too") {
  const TemporaryFolder folder;
  folder.write("w.toml", "name = \"nothing\"\n[material.wall]\n");
  const auto mission = read_mission(folder.write("m.toml", "world = \"w.toml\"\n[planner]\ngoal_m = [20000.0, 10.0]\n[map]\nenabled = false\n[limits]\ntime_s = 0.5\n"), {});
  if (!mission) FAIL(mission.error().message);
  auto simulation = Simulation::create(*mission);
  if (!simulation) FAIL(simulation.error().message);
  Drawn drawn{*simulation, {}};
  drawn.trajectory.note(drawn.simulation);
  const Picture picture = picture_of(folder, drawn);
  CHECK(picture.image.width < 1000);
  CHECK(picture.image.height < 1000);
}

}  // namespace thicket
