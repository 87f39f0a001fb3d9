// What a scan leaves out because its world does not need it, against the scan that leaves nothing out.
#include "lobe.hpp"

namespace thicket {
namespace {

/// A hall far taller than a lobe sees: walls around, a slanted partition and a round post.
HandMadeWorld hall(double attenuation_db_per_m = infinity, double height = 30.0) {
  HandMadeWorld made;
  made.material("matter", 0.3, attenuation_db_per_m);
  made.world.materials.back().roughness = 0.3;
  made.add(Wall{{{-4.0, -5.0}, {8.0, -5.0}, {8.0, 5.0}, {-4.0, 5.0}, {-4.0, -5.0}}, 0.2, height}, {0.0, 0.0, -0.5 * height});
  made.add(Box{{0.1, 2.5, height}}, {5.0, 2.0, 0.0}, radians(25.0));
  made.add(Cylinder{0.2, height}, {3.0, -1.0, 0.0});
  return made;
}

LobeRadarSpec hall_lobe(const std::string& sampling, const std::string& rows) {
  LobeRadarSpec spec = bare_lobe();
  spec.gain = "gaussian";
  spec.scattering = "lambert";
  spec.sampling = sampling;
  spec.rows = rows;
  spec.bandwidth_ghz = 1.5;
  return spec;
}

}  // namespace

TEST_CASE("one row: in a pure extrusion it gives the profile of all rows") {
  const Scene scene = traced(hall());
  for (const char* scattering : {"lambert", "material"}) {
    CAPTURE(scattering);
    LobeRadarSpec one = hall_lobe("regular", "auto"), all = hall_lobe("regular", "all");
    one.scattering = all.scattering = scattering;
    one.radial_velocity = all.radial_velocity = true;
    const auto few = measured(one, scene), many = measured(all, scene);
    CHECK(few.rays == 58);
    CHECK(many.rays == 58 * 58);
    const auto a = few.profiles.amplitude_of(0), b = many.profiles.amplitude_of(0);
    REQUIRE(a.size() == b.size());
    double top = 0.0, worst = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) {
      top = std::max(top, static_cast<double>(b[i]));
      worst = std::max(worst, std::abs(static_cast<double>(a[i]) - static_cast<double>(b[i])));
    }
    CHECK(top > 0.0);
    CHECK(worst < 1e-5 * top);
    REQUIRE(few.echoes.size() == many.echoes.size());
    for (std::size_t i = 0; i < few.echoes.size(); ++i) CHECK(few.echoes[i].range == many.echoes[i].range);
  }
}

TEST_CASE("one row: jittered, its mean profile is that of all rows within 0.1 dB") {
  const Scene scene = traced(hall());
  constexpr int scans = 600;
  struct Bin {
    double mean = 0.0, error = 0.0;  // of its power
  };
  const auto profile = [&](const std::string& rows) {
    const auto sensor = make_sensor(hall_lobe("jitter", rows), 0);
    Scan scan;
    std::vector<double> sum, squares;
    for (std::uint64_t number = 0; number < scans; ++number) {
      sensor->measure(scene, Pose{}, 0.0, number, Random(1, 0), scan);
      const auto amplitude = scan.profiles.amplitude_of(0);
      sum.resize(amplitude.size());
      squares.resize(amplitude.size());
      for (std::size_t i = 0; i < sum.size(); ++i) {
        const double power = static_cast<double>(amplitude[i]) * static_cast<double>(amplitude[i]);
        sum[i] += power;
        squares[i] += power * power;
      }
    }
    std::vector<Bin> bins(sum.size());
    for (std::size_t i = 0; i < sum.size(); ++i) {
      bins[i].mean = sum[i] / scans;
      bins[i].error = std::sqrt(std::max(0.0, squares[i] / scans - bins[i].mean * bins[i].mean) / (scans - 1));
    }
    return bins;
  };
  const auto one = profile("one"), all = profile("all");
  const double top = std::ranges::max_element(all, {}, &Bin::mean)->mean;
  int sharp = 0;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (all[i].mean < 0.001 * top) continue;
    CAPTURE(i);
    const double error = std::hypot(one[i].error, all[i].error), difference = std::abs(one[i].mean - all[i].mean);
    CHECK(difference < 5.0 * error + 1e-4 * all[i].mean);
    // Where the means are known to 0.02 dB they are the same to 0.1 dB.
    if (error > 0.0046 * all[i].mean) continue;
    CHECK(std::abs(10.0 * std::log10(one[i].mean / all[i].mean)) < 0.1);
    ++sharp;
  }
  CHECK(sharp > 50);
}

TEST_CASE("one row: not where the world ends in sight, is tilted, lets the wave through, or is looked at askew") {
  const LobeRadarSpec spec = hall_lobe("regular", "auto");
  const auto rays = [&](HandMadeWorld made, const Pose& pose = {}) { return measured(spec, traced(std::move(made)), pose).rays; };
  CHECK(rays(hall()) == 58);
  CHECK(rays(hall(infinity, 10.0)) == 58 * 58);
  CHECK(rays(hall(27.0)) == 58 * 58);
  HandMadeWorld with_ball = hall();
  with_ball.add(Sphere{0.3}, {4.0, 0.0, 1.0});
  CHECK(rays(with_ball) == 58 * 58);
  CHECK(rays(hall(), Pose{{0.0, 0.0, 0.0}, glm::angleAxis(radians(5.0), glm::dvec3(0.0, 1.0, 0.0))}) == 58 * 58);
  CHECK(rays(hall(), Pose{{0.0, 0.0, 0.0}, glm::angleAxis(radians(50.0), glm::dvec3(0.0, 0.0, 1.0))}) == 58);
}

TEST_CASE("surfaces: what is left out by itself changes nothing, mirrors or none") {
  for (const char* scattering : {"lambert", "material"}) {
    CAPTURE(scattering);
    LobeRadarSpec some = hall_lobe("regular", "all");
    some.scattering = scattering;
    some.bounces_max = 3;
    LobeRadarSpec all = some;
    all.surfaces = "all";
    for (const double attenuation : {infinity, 156.0, 27.0}) {
      CAPTURE(attenuation);
      const Scene scene = traced(hall(attenuation, 10.0));
      CHECK(measured(some, scene).profiles.amplitude == measured(all, scene).profiles.amplitude);
    }
  }
}

}  // namespace thicket
