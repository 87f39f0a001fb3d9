// What comes back along one beam, against closed forms.
#include <doctest/doctest.h>
#include <rapidcheck.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "../hand_made_world.hpp"
#include "../worlds/brute_force.hpp"
#include "one_beam.hpp"

using namespace thicket;

namespace {

/// Power that is left of 1 after a loss in dB.
double after(double db) {
  return std::pow(10.0, -0.1 * db);
}

/// A slab across the x axis whose faces it meets at x = from and x = to, turned by yaw.
Solid slab(double from, double to, std::uint32_t material, double yaw = 0.0) {
  Solid solid;
  solid.name = "slab";
  solid.material = material;
  solid.position = {0.5 * (from + to), 0.0, 0.0};
  solid.yaw = yaw;
  solid.shape = Box{{(to - from) * std::cos(yaw), 50.0, 50.0}};
  return solid;
}

/// Materials by index: 0 wall, 1 foliage, 2 wood, 3 smoke.
struct SlabWorld : HandMadeWorld {
  static constexpr std::uint32_t wall = 0, foliage = 1, wood = 2, smoke = 3;
  SlabWorld() {
    material("wall", 0.5, infinity);
    material("foliage", 0.05, 7.5);
    material("wood", 0.1, 46.0);
    material("smoke", 1e-7, 0.05, true, false);
  }
  SlabWorld& put(double from, double to, std::uint32_t of, double yaw = 0.0) {
    world.solids.push_back(slab(from, to, of, yaw));
    return *this;
  }
};

std::vector<Edge> edges_of(const OneBeam& b) {
  std::vector<Edge> edges;
  for (const Echo& e : b.echoes) edges.push_back(e.edge);
  return edges;
}
std::vector<double> ranges_of(const OneBeam& b) {
  std::vector<double> ranges;
  for (const Echo& e : b.echoes) ranges.push_back(e.range);
  return ranges;
}
using Edges = std::vector<Edge>;
using Ranges = std::vector<double>;

}  // namespace

TEST_CASE("an opaque wall returns its reflectivity times the cosine of incidence") {
  for (const double degrees : {0.0, 15.0, 30.0, 45.0, 60.0, 80.0, -45.0}) {
    CAPTURE(degrees);
    SlabWorld w;
    w.put(10.0, 12.0, SlabWorld::wall, radians(degrees));
    const OneBeam b = looked(one_beam_radar(), traced(w));
    REQUIRE(b.echoes.size() == 1);
    CHECK(b.echoes[0].range == doctest::Approx(10.0).epsilon(1e-14));
    CHECK(b.power(0) == as_power(0.5 * std::cos(radians(degrees))));
    CHECK(b.echoes[0].incidence_cosine == doctest::Approx(std::cos(radians(degrees))).epsilon(1e-6));
    CHECK(b.echoes[0].edge == Edge::front);
    CHECK(b.beam.end == BeamEnd::stopped);
    CHECK(b.beam.sensed_range == b.echoes[0].range);
    CHECK_FALSE(b.beam.starts_inside);
  }
}

TEST_CASE("what is round returns less off its middle, what is tilted upward too") {
  HandMadeWorld w;
  w.material("metal", 1.0, infinity);
  w.add(Sphere{2.0}, {10.0, 1.0, 0.0});
  const OneBeam ball = looked(one_beam_radar(), traced(w));
  REQUIRE(ball.echoes.size() == 1);
  CHECK(ball.echoes[0].range == doctest::Approx(10.0 - std::sqrt(3.0)).epsilon(1e-14));
  CHECK(ball.power(0) == as_power(std::sqrt(0.75)));

  // A floor under a beam that looks down by 30 degrees: 60 degrees from its normal.
  HandMadeWorld floor;
  floor.material("metal", 1.0, infinity);
  floor.add(Box{{100.0, 100.0, 1.0}}, {0.0, 0.0, -0.5});
  const Pose looking_down{{0.0, 0.0, 2.0}, glm::dquat(std::cos(pi / 12), 0.0, std::sin(pi / 12), 0.0)};
  const OneBeam down = looked(one_beam_radar(), traced(floor), looking_down);
  REQUIRE(down.echoes.size() == 1);
  CHECK(down.echoes[0].range == doctest::Approx(4.0).epsilon(1e-14));
  CHECK(down.power(0) == as_power(0.5));
}

TEST_CASE("a slab of foliage returns its front and its back, and what is behind it is weaker by both and by its matter") {
  const double rho = 0.05, passed = 0.95;
  SUBCASE("squarely, 1 m") {
    SlabWorld w;
    w.put(5.0, 6.0, SlabWorld::foliage).put(20.0, 21.0, SlabWorld::wall);
    const OneBeam b = looked(one_beam_radar(), traced(w));
    CHECK(ranges_of(b) == Ranges{5.0, 6.0, 20.0});
    CHECK(edges_of(b) == Edges{Edge::front, Edge::back, Edge::front});
    REQUIRE(b.echoes.size() == 3);
    CHECK(b.power(0) == as_power(rho));
    CHECK(b.power(1) == as_power(rho * passed * passed * after(2.0 * 7.5)));
    CHECK(b.power(2) == as_power(0.5 * std::pow(passed, 4) * after(2.0 * 7.5)));
    CHECK(b.beam.end == BeamEnd::stopped);
    CHECK(b.beam.sensed_range == 20.0);
  }
  SUBCASE("at 60 degrees, 0.5 m thick, 1 m on the way") {
    SlabWorld w;
    w.put(5.0, 6.0, SlabWorld::foliage, pi / 3);
    const OneBeam b = looked(one_beam_radar(), traced(w));
    REQUIRE(b.echoes.size() == 2);
    CHECK(b.power(0) == as_power(rho * 0.5));
    CHECK(b.power(1) == as_power(rho * 0.5 * passed * passed * after(2.0 * 7.5)));
    CHECK(b.beam.end == BeamEnd::open);
    CHECK(b.beam.sensed_range == 100.0);
  }
}

TEST_CASE("slabs one behind the other: losses add, whatever they are made of") {
  CHECK(rc::check("slabs", [] {
    Dice dice(*rc::gen::arbitrary<std::uint64_t>());
    HandMadeWorld w;
    struct Layer {
      double rho, db_per_m, from, to, cosine;
    };
    std::vector<Layer> layers;
    double x = 1.0;
    for (int i = *rc::gen::inRange(1, 6); i > 0; --i) {
      // Turned by no more than 60 degrees; what they do off the axis does not matter.
      const double yaw = dice.between(-pi / 3, pi / 3);
      const Layer layer{dice.between(0.0, 0.5), dice.between(0.0, 10.0), x, x + dice.between(0.01, 1.0), std::cos(yaw)};
      const std::uint32_t material = w.material("layer", layer.rho, layer.db_per_m);
      w.world.solids.push_back(slab(layer.from, layer.to, material, yaw));
      layers.push_back(layer);
      x = layer.to + 1.0;
    }
    const OneBeam b = looked(one_beam_radar(), traced(w));
    RC_ASSERT(b.echoes.size() == 2 * layers.size());
    double passed = 1.0, db = 0.0;
    const auto right = [&](std::size_t echo, double range, const Layer& layer) {
      const double power = layer.rho * layer.cosine * passed * passed * after(2.0 * db);
      return std::abs(b.echoes[echo].range - range) < 1e-12 * 20.0 && std::abs(b.power(echo) - power) <= 2.0 * single_precision * power;
    };
    for (std::size_t i = 0; i < layers.size(); ++i) {
      RC_ASSERT(right(2 * i, layers[i].from, layers[i]));
      passed *= 1.0 - layers[i].rho;
      db += layers[i].db_per_m * (layers[i].to - layers[i].from);
      RC_ASSERT(right(2 * i + 1, layers[i].to, layers[i]));
      passed *= 1.0 - layers[i].rho;
    }
  }));
}

TEST_CASE("a ray is exhausted where its loss inside matter reaches the budget") {
  ScanningRadarSpec spec = one_beam_radar();
  spec.penetration_budget_db = 10.0;
  SUBCASE("in one slab") {
    SlabWorld w;
    w.put(5.0, 9.0, SlabWorld::foliage).put(20.0, 21.0, SlabWorld::wall);
    const OneBeam b = looked(spec, traced(w));
    CHECK(ranges_of(b) == Ranges{5.0});
    CHECK(b.beam.end == BeamEnd::exhausted);
    CHECK(b.beam.sensed_range == 5.0 + 10.0 / 7.5);
  }
  SUBCASE("in the second of two, and not in what is open between them") {
    SlabWorld w;
    w.put(5.0, 6.0, SlabWorld::foliage).put(10.0, 14.0, SlabWorld::foliage);
    const OneBeam b = looked(spec, traced(w));
    CHECK(ranges_of(b) == Ranges{5.0, 6.0, 10.0});
    CHECK(b.beam.end == BeamEnd::exhausted);
    CHECK(b.beam.sensed_range == doctest::Approx(10.0 + 2.5 / 7.5).epsilon(1e-15));
  }
  SUBCASE("in the denser of two that overlap") {
    SlabWorld w;
    w.put(5.0, 9.0, SlabWorld::foliage).put(5.5, 9.0, SlabWorld::wood);
    const OneBeam b = looked(spec, traced(w));
    CHECK(ranges_of(b) == Ranges{5.0, 5.5});
    CHECK(b.beam.sensed_range == doctest::Approx(5.5 + (10.0 - 3.75) / 46.0).epsilon(1e-15));
  }
  SUBCASE("just thin enough, just too thick, and exactly as thick as the budget") {
    // 8 dB/m: 1.25 m is 10 dB to the last bit.
    for (const auto& [thickness, seen] : {std::pair{1.25 - 0x1p-30, 3}, {1.25 + 0x1p-30, 1}, {1.25, 1}}) {
      CAPTURE(thickness);
      HandMadeWorld w;
      w.material("wall", 0.5, infinity);
      w.material("hedge", 0.05, 8.0);
      w.world.solids = {slab(5.0, 5.0 + thickness, 1), slab(20.0, 21.0, 0)};
      const OneBeam b = looked(spec, traced(w));
      CHECK(static_cast<int>(b.echoes.size()) == seen);
      CHECK(b.beam.end == (seen == 3 ? BeamEnd::stopped : BeamEnd::exhausted));
      CHECK(b.beam.sensed_range == (seen == 3 ? 20.0 : 6.25));
    }
  }
  SUBCASE("with no budget at all: at the first surface of what weakens it") {
    spec.penetration_budget_db = 0.0;
    SlabWorld w;
    w.put(5.0, 9.0, SlabWorld::foliage);
    const OneBeam b = looked(spec, traced(w));
    CHECK(ranges_of(b) == Ranges{5.0});
    CHECK(b.beam.end == BeamEnd::exhausted);
    CHECK(b.beam.sensed_range == 5.0);
  }
  SUBCASE("only within its range") {
    spec.range_max_m = 6.0;
    SlabWorld w;
    w.put(5.0, 9.0, SlabWorld::foliage);
    const OneBeam b = looked(spec, traced(w));
    CHECK(b.beam.end == BeamEnd::open);
    CHECK(b.beam.sensed_range == 6.0);
  }
}

TEST_CASE("matter as thick as the budget ends a ray or lets it pass, but never hides that there is a wall") {
  // Rounding may settle it either way. What must not be is that the list of solids ends at the one and the ray goes on as if nothing were
  // behind it.
  Dice dice(31);
  int exhausted = 0;
  for (int i = 0; i < 2500; ++i) {
    HandMadeWorld w;
    w.material("wall", 0.5, infinity);
    const double db_per_m = dice.between(0.5, 50.0), budget = dice.between(1.0, 20.0),
                 from = dice.chance(0.5) ? 0.001 : dice.between(0.1, 10.0);
    w.material("hedge", 0.05, db_per_m);
    // To a few last places.
    const double to = (from + budget / db_per_m) * (1.0 + 0x1p-52 * dice.pick(5));
    w.world.solids = {slab(from, to, 1), slab(80.0, 81.0, 0)};
    // Thinner matter across it cuts the sum of its losses into pieces, and so rounds it otherwise.
    w.material("haze", 0.0, 0.001);
    for (std::uint32_t piece = dice.pick(12); piece > 0; --piece) {
      const double middle = dice.between(from, to), half = dice.between(0.0, 0.5 * std::min(middle - from, to - middle));
      w.world.solids.push_back(slab(middle - half, middle + half, 2));
    }
    ScanningRadarSpec spec = one_beam_radar();
    spec.penetration_budget_db = budget;
    const OneBeam b = looked(spec, traced(w));
    REQUIRE(b.beam.end != BeamEnd::open);
    if (b.beam.end == BeamEnd::exhausted) {
      ++exhausted;
      REQUIRE(std::abs(b.beam.sensed_range - to) < 1e-9);
    } else {
      REQUIRE(b.beam.sensed_range == doctest::Approx(80.0).epsilon(1e-12));
      REQUIRE(b.echoes.size() == 3);
    }
  }
  CHECK(exhausted > 300);
}

TEST_CASE("where solids of one material overlap or touch there is no surface") {
  const double rho = 0.05, passed = 0.95;
  HandMadeWorld w;
  w.material("foliage", rho, 7.5);
  SUBCASE("overlapping spheres: one front, one back, and their common length counted once") {
    w.add(Sphere{1.0}, {5.0, 0.0, 0.0});
    w.add(Sphere{1.0}, {6.0, 0.0, 0.0});
    w.add(Sphere{0.25}, {5.5, 0.0, 0.0});
    const OneBeam b = looked(one_beam_radar(), traced(w));
    CHECK(ranges_of(b) == Ranges{4.0, 7.0});
    CHECK(edges_of(b) == Edges{Edge::front, Edge::back});
    REQUIRE(b.echoes.size() == 2);
    CHECK(b.power(0) == as_power(rho));
    CHECK(b.power(1) == as_power(rho * passed * passed * after(2.0 * 7.5 * 3.0)));
  }
  SUBCASE("boxes that share a face, wherever and however turned: their numbers meet only to rounding") {
    Dice dice(32);
    for (int i = 0; i < 500; ++i) {
      HandMadeWorld hedge;
      hedge.material("foliage", rho, 7.5);
      const double yaw = dice.between(-1.0, 1.0), first = dice.between(0.1, 2.0), second = dice.between(0.1, 2.0),
                   x = dice.between(5.0, 50.0);
      const glm::dvec3 along(direction(yaw), 0.0);
      hedge.add(Box{{first, 10.0, 10.0}}, glm::dvec3(x, 0.0, 0.0), yaw);
      hedge.add(Box{{second, 10.0, 10.0}}, glm::dvec3(x, 0.0, 0.0) + 0.5 * (first + second) * along, yaw);
      const OneBeam b = looked(one_beam_radar(), traced(hedge));
      REQUIRE(edges_of(b) == Edges{Edge::front, Edge::back});
      const double way = (first + second) / std::cos(yaw);
      REQUIRE(b.echoes[1].range - b.echoes[0].range == doctest::Approx(way).epsilon(1e-12));
      REQUIRE(b.power(1) == doctest::Approx(rho * std::cos(yaw) * passed * passed * after(2.0 * 7.5 * way)).epsilon(1e-6).scale(0.0));
    }
  }
  SUBCASE("two materials that touch have one surface, of the denser one") {
    Dice dice(33);
    for (int i = 0; i < 500; ++i) {
      SlabWorld two;
      const double x = dice.between(5.0, 50.0), middle = x + dice.between(0.1, 0.3), end = middle + dice.between(0.1, 0.3);
      const bool wood_first = dice.chance(0.5);
      two.put(x, middle, wood_first ? SlabWorld::wood : SlabWorld::foliage)
          .put(middle, end, wood_first ? SlabWorld::foliage : SlabWorld::wood);
      const OneBeam b = looked(one_beam_radar(), traced(two));
      REQUIRE(edges_of(b) == Edges{Edge::front, Edge::inner, Edge::back});
      const double before = wood_first ? 46.0 * (middle - x) : 7.5 * (middle - x), passed_front = wood_first ? 0.9 : 0.95;
      REQUIRE(b.power(1) == doctest::Approx(0.1 * passed_front * passed_front * after(2.0 * before)).epsilon(1e-6).scale(0.0));
    }
  }
}

TEST_CASE("wood inside foliage: front, into the wood, out of it, back") {
  SlabWorld w;
  w.put(5.0, 8.0, SlabWorld::foliage).put(6.0, 6.5, SlabWorld::wood);
  const OneBeam b = looked(one_beam_radar(), traced(w));
  CHECK(ranges_of(b) == Ranges{5.0, 6.0, 6.5, 8.0});
  CHECK(edges_of(b) == Edges{Edge::front, Edge::inner, Edge::inner, Edge::back});
  REQUIRE(b.echoes.size() == 4);
  CHECK(b.power(0) == as_power(0.05));
  CHECK(b.power(1) == as_power(0.1 * std::pow(0.95, 2) * after(2.0 * 7.5)));
  CHECK(b.power(2) == as_power(0.1 * std::pow(0.95 * 0.9, 2) * after(2.0 * (7.5 + 23.0))));
  CHECK(b.power(3) == as_power(0.05 * std::pow(0.95 * 0.9 * 0.9, 2) * after(2.0 * (7.5 + 23.0 + 11.25))));

  // The less dense one changes nothing inside the denser one.
  SlabWorld inside_out;
  inside_out.put(5.0, 6.0, SlabWorld::wood).put(5.25, 5.75, SlabWorld::foliage);
  const OneBeam only_wood = looked(one_beam_radar(), traced(inside_out));
  CHECK(ranges_of(only_wood) == Ranges{5.0, 6.0});
  REQUIRE(only_wood.echoes.size() == 2);
  CHECK(only_wood.power(1) == as_power(0.1 * 0.81 * after(2.0 * 46.0)));
}

TEST_CASE("smoke gives no echo, but weakens what is behind it") {
  ScanningRadarSpec spec = one_beam_radar();
  spec.detection_floor_db = -60.0;
  SlabWorld w;
  w.put(2.0, 6.0, SlabWorld::smoke).put(8.0, 8.5, SlabWorld::foliage).put(20.0, 21.0, SlabWorld::wall);
  const OneBeam b = looked(spec, traced(w));
  CHECK(ranges_of(b) == Ranges{8.0, 8.5, 20.0});
  CHECK(edges_of(b) == Edges{Edge::front, Edge::back, Edge::front});
  REQUIRE(b.echoes.size() == 3);
  CHECK(b.power(0) == as_power(0.05 * std::pow(1.0 - 1e-7, 4) * after(2.0 * 0.2)));

  SUBCASE("foliage in smoke has a front and a back, as in the open") {
    SlabWorld inside;
    inside.put(2.0, 6.0, SlabWorld::smoke).put(3.0, 3.5, SlabWorld::foliage);
    const OneBeam in_smoke = looked(spec, traced(inside));
    CHECK(ranges_of(in_smoke) == Ranges{3.0, 3.5});
    CHECK(edges_of(in_smoke) == Edges{Edge::front, Edge::back});
  }
  SUBCASE("a radar in smoke is not inside anything") {
    SlabWorld around;
    around.put(-2.0, 6.0, SlabWorld::smoke);
    const OneBeam from_smoke = looked(spec, traced(around));
    CHECK(from_smoke.echoes.empty());
    CHECK_FALSE(from_smoke.beam.starts_inside);
    CHECK(from_smoke.beam.end == BeamEnd::open);
  }
  SUBCASE("enough of it exhausts a ray") {
    spec.penetration_budget_db = 0.1;
    const OneBeam exhausted = looked(spec, traced(w));
    CHECK(exhausted.echoes.empty());
    CHECK(exhausted.beam.end == BeamEnd::exhausted);
    CHECK(exhausted.beam.sensed_range == doctest::Approx(4.0).epsilon(1e-15));
  }
  SUBCASE("a better receiver sees it") {
    spec.detection_floor_db = -80.0;
    const OneBeam seen = looked(spec, traced(w));
    REQUIRE(seen.echoes.size() == 5);
    CHECK(seen.power(0) == as_power(1e-7));
  }
}

TEST_CASE("a beam that starts inside foliage sees its back, and no front") {
  SlabWorld w;
  w.put(-1.0, 2.0, SlabWorld::foliage).put(20.0, 21.0, SlabWorld::wall);
  const OneBeam b = looked(one_beam_radar(), traced(w));
  CHECK(b.beam.starts_inside);
  CHECK(ranges_of(b) == Ranges{2.0, 20.0});
  CHECK(edges_of(b) == Edges{Edge::back, Edge::front});
  REQUIRE(b.echoes.size() == 2);
  CHECK(b.power(0) == as_power(0.05 * after(2.0 * 15.0)));
  CHECK(b.power(1) == as_power(0.5 * 0.95 * 0.95 * after(2.0 * 15.0)));

  ScanningRadarSpec weak = one_beam_radar();
  weak.penetration_budget_db = 10.0;
  const OneBeam exhausted = looked(weak, traced(w));
  CHECK(exhausted.echoes.empty());
  CHECK(exhausted.beam.starts_inside);
  CHECK(exhausted.beam.end == BeamEnd::exhausted);
  CHECK(exhausted.beam.sensed_range == doctest::Approx(10.0 / 7.5).epsilon(1e-15));
}

TEST_CASE("a beam that starts inside opaque matter senses nothing") {
  const auto check = [](const SlabWorld& w, double budget) {
    ScanningRadarSpec spec = one_beam_radar();
    spec.penetration_budget_db = budget;
    const OneBeam b = looked(spec, traced(w));
    CHECK(b.echoes.empty());
    CHECK(b.beam.starts_inside);
    CHECK(b.beam.end != BeamEnd::open);
    CHECK(b.beam.sensed_range == 0.0);
  };
  for (const double budget : {0.0, 10.0, infinity}) {
    CAPTURE(budget);
    check(SlabWorld().put(-1.0, 2.0, SlabWorld::wall), budget);
    check(SlabWorld().put(-1.0, 2.0, SlabWorld::wall).put(20.0, 21.0, SlabWorld::wall), budget);
    check(SlabWorld().put(-1.0, 2.0, SlabWorld::wall).put(-0.5, 1.0, SlabWorld::foliage), budget);
    // Something else begins or ends in it at the very place of the sensor.
    check(SlabWorld().put(-1.0, 2.0, SlabWorld::wall).put(0.0, 1.0, SlabWorld::foliage), budget);
    check(SlabWorld().put(-1.0, 2.0, SlabWorld::wall).put(0.0, 3.0, SlabWorld::wood).put(20.0, 21.0, SlabWorld::wall), budget);
    check(SlabWorld().put(-1.0, 2.0, SlabWorld::wall).put(0.0, 1.0, SlabWorld::wall), budget);
  }
}

TEST_CASE("the receiver sees what reaches its floor") {
  SlabWorld w;
  w.put(5.0, 6.0, SlabWorld::foliage).put(20.0, 21.0, SlabWorld::wall);
  const double back_db = 10.0 * std::log10(0.05 * std::pow(0.95, 2)) - 15.0, wall_db = 10.0 * std::log10(0.5 * std::pow(0.95, 4)) - 15.0;
  const auto seen = [&](double floor_db) {
    ScanningRadarSpec spec = one_beam_radar();
    spec.detection_floor_db = floor_db;
    return ranges_of(looked(spec, traced(w)));
  };
  CHECK(seen(back_db - 1e-6) == Ranges{5.0, 6.0, 20.0});
  CHECK(seen(back_db + 1e-6) == Ranges{5.0, 20.0});
  CHECK(seen(wall_db - 1e-6) == Ranges{5.0, 20.0});
  CHECK(seen(wall_db + 1e-6) == Ranges{5.0});
  CHECK(seen(10.0 * std::log10(0.05) - 1e-6) == Ranges{5.0});
  CHECK(seen(10.0 * std::log10(0.05) + 1e-6).empty());
}

TEST_CASE("a ray ends where not even a perfect reflector would be seen") {
  ScanningRadarSpec spec = one_beam_radar();
  spec.detection_floor_db = -60.0;
  const double depth = (60.0 + 20.0 * std::log10(0.95)) / (2.0 * 7.5);  // (1 - rho)^2 10^(-2 L / 10) = 10^-6
  SUBCASE("inside matter whose back is far") {
    SlabWorld w;
    w.put(5.0, 30.0, SlabWorld::foliage).put(40.0, 41.0, SlabWorld::wall);
    const OneBeam b = looked(spec, traced(w));
    CHECK(ranges_of(b) == Ranges{5.0});
    CHECK(b.beam.end == BeamEnd::exhausted);
    CHECK(b.beam.sensed_range == doctest::Approx(5.0 + depth).epsilon(1e-12));
  }
  SUBCASE("inside matter whose back is out of range") {
    SlabWorld w;
    w.put(5.0, 200.0, SlabWorld::foliage);
    const OneBeam b = looked(spec, traced(w));
    CHECK(b.beam.end == BeamEnd::exhausted);
    CHECK(b.beam.sensed_range == doctest::Approx(5.0 + depth).epsilon(1e-12));
  }
  SUBCASE("at a surface that passes next to nothing") {
    HandMadeWorld w;
    w.material("foil", 0.9999, 0.0);
    w.material("wall", 0.5, infinity);
    w.world.solids = {slab(5.0, 6.0, 0), slab(20.0, 21.0, 1)};
    const OneBeam b = looked(spec, traced(w));
    CHECK(ranges_of(b) == Ranges{5.0});
    CHECK(b.power(0) == as_power(0.9999));
    CHECK(b.beam.end == BeamEnd::exhausted);
    CHECK(b.beam.sensed_range == 5.0);
  }
  SUBCASE("the budget may be used up before") {
    spec.penetration_budget_db = 10.0;
    SlabWorld w;
    w.put(5.0, 30.0, SlabWorld::foliage);
    CHECK(looked(spec, traced(w)).beam.sensed_range == 5.0 + 10.0 / 7.5);
  }
}

TEST_CASE("only the first echo, for a radar that sees through nothing") {
  ScanningRadarSpec spec = one_beam_radar();
  spec.first_echo_only = true;
  SlabWorld w;
  w.put(2.0, 3.0, SlabWorld::smoke).put(5.0, 6.0, SlabWorld::foliage).put(20.0, 21.0, SlabWorld::wall);
  spec.detection_floor_db = -60.0;
  const OneBeam b = looked(spec, traced(w));
  CHECK(ranges_of(b) == Ranges{5.0});
  CHECK(b.beam.end == BeamEnd::stopped);
  CHECK(b.beam.sensed_range == 5.0);
  // Without one it is as it was.
  SlabWorld smoke;
  smoke.put(2.0, 3.0, SlabWorld::smoke);
  const OneBeam open = looked(spec, traced(smoke));
  CHECK(open.echoes.empty());
  CHECK(open.beam.end == BeamEnd::open);
  CHECK(open.beam.sensed_range == 100.0);
}

TEST_CASE("nearer than range_min nothing is seen, though it weakens, farther than range_max there is nothing") {
  ScanningRadarSpec spec = one_beam_radar();
  SlabWorld w;
  w.put(5.0, 6.0, SlabWorld::foliage).put(20.0, 21.0, SlabWorld::wall);
  const Scene scene = traced(w);
  const auto seen = [&](double range_min, double range_max) {
    spec.range_min_m = range_min;
    spec.range_max_m = range_max;
    return looked(spec, scene);
  };
  CHECK(ranges_of(seen(5.0, 20.0)) == Ranges{5.0, 6.0, 20.0});
  CHECK(ranges_of(seen(5.5, 100.0)) == Ranges{6.0, 20.0});
  const OneBeam near = seen(7.0, 100.0);
  CHECK(ranges_of(near) == Ranges{20.0});
  CHECK(near.power(0) == as_power(0.5 * std::pow(0.95, 4) * after(15.0)));
  const OneBeam short_of = seen(0.0, 19.999);
  CHECK(ranges_of(short_of) == Ranges{5.0, 6.0});
  CHECK(short_of.beam.end == BeamEnd::open);
  CHECK(short_of.beam.sensed_range == 19.999);
  const OneBeam too_near = seen(30.0, 100.0);
  CHECK(too_near.echoes.empty());
  CHECK(too_near.beam.end == BeamEnd::stopped);
  CHECK(too_near.beam.sensed_range == 20.0);
}

namespace {

struct ExpectedEcho {
  double range, power;
  Edge edge;
};
struct ExpectedBeam {
  std::vector<ExpectedEcho> echoes;
  double loss_db = 0.0;
  BeamEnd end = BeamEnd::open;
  double sensed_range = 0.0;
};

/// The law once more, from the middle of each stretch between two surfaces: there the densest solid counts. For worlds without two surfaces
/// in one place and without two materials of one attenuation.
ExpectedBeam expected_beam(const World& world, const std::vector<Crossing>& crossings, const glm::dvec3& along,
                           const ScanningRadarSpec& spec) {
  struct Surface {
    double range;
    glm::dvec3 normal;
  };
  std::vector<Surface> surfaces;
  for (const Crossing& c : crossings) {
    if (!c.starts_inside) surfaces.push_back({c.enter, c.enter_normal});
    surfaces.push_back({c.leave, c.leave_normal});
  }
  std::sort(surfaces.begin(), surfaces.end(), [](const Surface& a, const Surface& b) { return a.range < b.range; });
  static const Material open{"open", 0.0, 0.0, 1.0, false, false};
  const auto medium = [&](double range) {
    const Material* densest = &open;
    for (const Crossing& c : crossings)
      if (c.enter < range && range < c.leave &&
          (densest == &open || world.material_of(c.solid).attenuation_db_per_m > densest->attenuation_db_per_m))
        densest = &world.material_of(c.solid);
    return densest;
  };
  const double floor = std::pow(10.0, 0.1 * spec.detection_floor_db);
  const auto visible = [&](const Material* m) { return m->reflectivity > 0.0 && m->reflectivity >= floor; };

  ExpectedBeam beam;
  beam.sensed_range = spec.range_max_m;
  double at = 0.0, passed = 1.0, most = std::min(spec.penetration_budget_db, -0.5 * spec.detection_floor_db);
  for (std::size_t i = 0; i < surfaces.size(); ++i) {
    const double range = surfaces[i].range;
    const Material* here = medium(0.5 * (at + range));
    const double loss = here->attenuation_db_per_m * (std::min(range, spec.range_max_m) - at);
    if (here->attenuation_db_per_m > 0.0 && beam.loss_db + loss >= most) {
      beam.end = BeamEnd::exhausted;
      beam.sensed_range = here->opaque() ? at : at + (most - beam.loss_db) / here->attenuation_db_per_m;
      return beam;
    }
    if (range > spec.range_max_m) return beam;
    beam.loss_db += here->attenuation_db_per_m > 0.0 ? loss : 0.0;
    const Material* next = i + 1 < surfaces.size() ? medium(0.5 * (range + surfaces[i + 1].range)) : &open;
    at = range;
    if (next == here) continue;
    const Material* dense = next->attenuation_db_per_m > here->attenuation_db_per_m || here == &open ? next : here;
    const double power = dense->reflectivity * std::abs(glm::dot(surfaces[i].normal, along)) * passed * passed * after(2.0 * beam.loss_db);
    if (power >= floor && range >= spec.range_min_m && (visible(here) || visible(next)))
      beam.echoes.push_back({range, power, !visible(here) ? Edge::front : visible(next) ? Edge::inner : Edge::back});
    if (next->opaque()) {
      beam.end = BeamEnd::stopped;
      beam.sensed_range = range;
      return beam;
    }
    passed *= 1.0 - dense->reflectivity;
    most = std::min(spec.penetration_budget_db, -0.5 * spec.detection_floor_db + 10.0 * std::log10(passed));
    if (beam.loss_db > most) {
      beam.end = BeamEnd::exhausted;
      beam.sensed_range = range;
      return beam;
    }
  }
  return beam;
}

/// Overlapping and nested solids of every kind of matter about the origin.
HandMadeWorld thicket_of(Dice& dice, int solids) {
  HandMadeWorld w;
  w.material("wall", 0.5, infinity);
  w.material("foliage", 0.05, 7.5);
  w.material("wood", 0.1, 46.0);
  w.material("smoke", 1e-7, 0.05, true, false);
  w.material("plaster", 0.3, 2.0);
  w.material("mirror", 0.98, 30.0);
  w.material("gas", 0.0, 0.5);
  for (int i = 0; i < solids; ++i) {
    const glm::dvec3 position(dice.point(glm::dvec2(-10.0), glm::dvec2(10.0)), dice.between(-0.5, 0.5));
    const auto material = i % 10 == 0 ? 0 : 1 + dice.pick(6);
    switch (dice.pick(3)) {
      case 0:
        w.add(Sphere{dice.between(0.1, 2.0)}, position, 0.0, material);
        break;
      case 1:
        w.add(Box{dice.point(glm::dvec3(0.1), glm::dvec3(3.0))}, position, dice.between(-pi, pi), material);
        break;
      default:
        w.add(Cylinder{dice.between(0.05, 1.5), dice.between(0.2, 3.0)}, position, 0.0, material);
    }
  }
  return w;
}

}  // namespace

TEST_CASE("random thickets return what the law says, echo by echo") {
  Dice dice(34);
  std::size_t compared = 0, wrong = 0, ends[3] = {0, 0, 0};
  for (int i = 0; i < 60; ++i) {
    const HandMadeWorld w = thicket_of(dice, 40);
    const Scene scene = traced(w);
    const auto pieces = brute::pieces_of(w.world);
    ScanningRadarSpec spec;
    spec.position_m = {0.0, 0.0, 0.0};
    spec.step_deg = 5.0;
    spec.range_max_m = dice.between(5.0, 20.0);
    spec.range_min_m = dice.chance(0.5) ? 0.0 : 1.0;
    spec.penetration_budget_db = i % 3 == 0 ? infinity : dice.between(0.1, 30.0);
    spec.detection_floor_db = dice.between(-90.0, -20.0);
    const Pose vehicle = Pose::planar(dice.between(-3.0, 3.0), dice.between(-3.0, 3.0), 0.0, dice.between(-pi, pi));
    const Scan scan = measured(spec, scene, vehicle);
    for (const Beam& beam : scan.beams) {
      const glm::dvec3 along = vehicle.orientation * glm::dvec3(direction(beam.azimuth), 0.0);
      const ExpectedBeam expected = expected_beam(w.world, brute::crossings(pieces, Ray{vehicle.position, along}), along, spec);
      const auto echoes = scan.echoes_of(beam);
      ++ends[static_cast<std::size_t>(expected.end)];
      if (beam.end != expected.end || std::abs(beam.sensed_range - expected.sensed_range) > 1e-9 ||
          echoes.size() != expected.echoes.size()) {
        ++wrong;
        continue;
      }
      for (std::size_t e = 0; e < echoes.size(); ++e, ++compared) {
        const double power = static_cast<double>(echoes[e].amplitude) * static_cast<double>(echoes[e].amplitude);
        wrong += std::abs(echoes[e].range - expected.echoes[e].range) > 1e-9 || echoes[e].edge != expected.echoes[e].edge ||
                 std::abs(power - expected.echoes[e].power) > 1e-6 * expected.echoes[e].power;
      }
    }
  }
  CHECK(wrong == 0);
  CHECK(compared > 3000);
  for (const std::size_t of_this_end : ends) CHECK(of_this_end > 100);
}

TEST_CASE("no beam returns more than was sent, its echoes are in order and in range, and it senses as far as its last") {
  CHECK(rc::check("energy", [] {
    Dice dice(*rc::gen::arbitrary<std::uint64_t>());
    HandMadeWorld w;
    for (int i = 0; i < 8; ++i)
      w.material("stuff", dice.between(0.0, 1.0), dice.chance(0.2) ? infinity : dice.chance(0.2) ? 0.0 : dice.between(0.0, 20.0));
    for (int i = *rc::gen::inRange(0, 60); i > 0; --i)
      w.add(Sphere{dice.between(0.1, 3.0)}, {dice.point(glm::dvec2(-8.0), glm::dvec2(8.0)), 0.0}, 0.0, dice.pick(8));
    ScanningRadarSpec spec;
    spec.position_m = {0.0, 0.0, 0.0};
    spec.step_deg = 10.0;
    spec.range_min_m = dice.between(0.0, 1.0);
    spec.range_max_m = dice.between(2.0, 20.0);
    spec.penetration_budget_db = dice.chance(0.5) ? infinity : dice.between(0.0, 30.0);
    spec.detection_floor_db = dice.between(-100.0, 0.0);
    spec.first_echo_only = dice.chance(0.2);
    const Scan scan = measured(spec, traced(w));
    const double floor = std::pow(10.0, 0.1 * spec.detection_floor_db);
    for (const Beam& beam : scan.beams) {
      double sum = 0.0, last = 0.0;
      for (const Echo& echo : scan.echoes_of(beam)) {
        const double power = static_cast<double>(echo.amplitude) * static_cast<double>(echo.amplitude);
        RC_ASSERT(power >= floor * (1.0 - single_precision));
        RC_ASSERT(echo.range >= std::max(last, spec.range_min_m));
        RC_ASSERT(echo.range <= spec.range_max_m);
        RC_ASSERT(echo.incidence_cosine >= 0.0f);
        RC_ASSERT(echo.incidence_cosine <= 1.0f);
        sum += power;
        last = echo.range;
      }
      RC_ASSERT(sum <= 1.0 + 1e-6);
      RC_ASSERT(beam.sensed_range >= last);
      RC_ASSERT(beam.sensed_range <= spec.range_max_m);
      RC_ASSERT(beam.end != BeamEnd::open || beam.sensed_range == spec.range_max_m);
    }
  }));
}
