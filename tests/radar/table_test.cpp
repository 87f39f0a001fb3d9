// Tables of points, and the noise of a lidar that is given by one.
#include "table.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <vector>

#include "../hand_made_world.hpp"
#include "one_beam.hpp"

using namespace thicket;

TEST_CASE("a table is straight between its points and level beyond them") {
  const std::vector<glm::dvec2> table = {{1.0, 10.0}, {3.0, 20.0}, {3.0, 50.0}, {4.0, 40.0}};
  CHECK(value_at(table, -5.0) == 10.0);
  CHECK(value_at(table, 1.0) == 10.0);
  CHECK(value_at(table, 1.5) == 12.5);
  CHECK(value_at(table, 3.0) == 20.0);  // at a step the former
  CHECK(value_at(table, std::nextafter(3.0, 4.0)) == doctest::Approx(50.0));
  CHECK(value_at(table, 3.75) == 42.5);
  CHECK(value_at(table, 4.0) == 40.0);
  CHECK(value_at(table, 1e9) == 40.0);
  CHECK(value_at(std::vector<glm::dvec2>{{2.0, 7.0}}, 0.0) == 7.0);
  CHECK(value_at(std::vector<glm::dvec2>{{2.0, 7.0}}, 2.0) == 7.0);
  CHECK(value_at(std::vector<glm::dvec2>{{2.0, 7.0}}, 3.0) == 7.0);
}

TEST_CASE("a lidar's noise goes by the range of each beam") {
  // One wall 4 m to the left, one 16 m to the right.
  HandMadeWorld w;
  w.add(Box{{100.0, 1.0, 5.0}}, {0.0, 4.5, 0.0});
  w.add(Box{{100.0, 1.0, 5.0}}, {0.0, -16.5, 0.0});
  const Scene scene = traced(std::move(w));
  LidarSpec spec;
  spec.position_m = {0.0, 0.0, 0.0};
  spec.fov_deg = 180.0;
  spec.step_deg = 180.0;  // two beams, at -90 and 90 degrees
  spec.range_noise_m = 5.0;  // the table counts
  spec.range_noise_table_m = {{0.0, 0.0}, {8.0, 0.02}, {8.0, 0.05}};
  const auto sensor = make_sensor(spec, 0);
  constexpr int scans = 4000;
  double near = 0.0, far = 0.0;
  Scan scan;
  for (int i = 0; i < scans; ++i) {
    sensor->measure(scene, {}, 0.0, static_cast<std::uint64_t>(i), Random(1, 0), scan);
    REQUIRE(scan.echoes.size() == 2);
    far += std::pow(scan.echoes_of(scan.beams[0])[0].range - 16.0, 2);
    near += std::pow(scan.echoes_of(scan.beams[1])[0].range - 4.0, 2);
  }
  // (A standard deviation from 4000 draws is good to 1.1 %.)
  CHECK(std::sqrt(near / scans) == doctest::Approx(0.01).epsilon(0.05));
  CHECK(std::sqrt(far / scans) == doctest::Approx(0.05).epsilon(0.05));
}
