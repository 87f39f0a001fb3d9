// What maps take: bytes in all and for each cell that was seen, for each way to keep cells; and what a quadtree saves where nearly nothing is, and what that costs.
#include <fmt/format.h>

#include "map_work.hpp"
#include "study_mapping.hpp"
#include "study_tables.hpp"
#include "thicket/nav/occupancy_map.hpp"
#include "thicket/sim/map_score.hpp"

namespace thicket::study {
namespace {

using namespace map_work;

const std::vector<std::string> stores = {"tiles", "dense", "quadtree"};

OccupancyMap make_map(const std::vector<Step>& steps, double resolution, int bits, const std::string& store) {
  MapSpec spec;
  spec.resolution_m = resolution;
  spec.cell_bits = bits;
  spec.store = store;
  OccupancyMap map(spec);
  for (const Step& step : steps)
    for (const Scan& scan : step.scans) map.integrate(scan, step.pose_in_space());
  return map;
}

double per_cell(const OccupancyMap& map) { return static_cast<double>(map.memory_bytes()) / static_cast<double>(map.known_cells()); }
std::string kilobytes(double bytes) { return fmt::format("{:.0f}", bytes / 1e3); }
std::string size_of(const OccupancyMap& map) { return fmt::format("{} ({:.2f})", kilobytes(static_cast<double>(map.memory_bytes())), per_cell(map)); }

/// The hold of a barge, 200 x 200 m: four walls of steel with a frame every 3 m, 0.2 m wide and 0.5 m deep, and nothing else.
constexpr double hold_half_side = 100.0;
Hall hold() {
  constexpr double outer = hold_half_side, inner = outer - 0.4, depth = 0.5, half_width = 0.1;
  Hall hold{{{-outer, -outer, outer, -inner}, {-outer, inner, outer, outer}, {-outer, -outer, -inner, outer}, {inner, -outer, outer, outer}}};
  for (double at = 3.0 - inner; at < inner; at += 3.0) {
    const double low = at - half_width, high = at + half_width;
    hold.blocks.insert(hold.blocks.end(), {{low, -inner, high, depth - inner}, {low, inner - depth, high, inner}, {-inner, low, depth - inner, high}, {inner - depth, low, inner, high}});
  }
  return hold;
}

/// To and fro in lanes 20 m apart, a look each metre.
std::vector<Pose2> lanes() {
  std::vector<Pose2> way;
  constexpr double end = 90.0;
  for (int lane = 0; lane < 10; ++lane) {
    const bool forth = lane % 2 == 0;
    const double y = -end + 20.0 * lane + 0.0077;
    for (int i = 0; i <= 180; ++i) way.push_back({{(forth ? i - end : end - i) + 0.0123, y}, forth ? 0.0 : pi});
    // Over to the next lane.
    for (int i = 1; i < 20 && lane < 9; ++i) way.push_back({{(forth ? end : -end) + 0.0123, y + i}, 0.5 * pi});
  }
  return way;
}

std::vector<Step> steps_in_hold(const Instrument& instrument) {
  const auto way = lanes();
  Source source(instrument, {}, hold(), way);
  std::vector<Step> list;
  for (std::size_t i = 0; i < way.size(); ++i) list.push_back(source.next());
  return list;
}

void tell_hall() {
  std::vector<Row> rows;
  // As the source of 2018 states them, of a rectangle of 50 x 50 m with 64 bits a cell; and with the 8 bits that it then took.
  const std::vector<std::pair<double, std::string>> resolutions = {{0.5, "80 (10)"}, {0.2, "500 (63)"}, {0.1, "2000 (250)"}, {0.05, "8000 (1000)"}};
  for (const Instrument& instrument : {Instrument::radar4x58(), Instrument::lidar1440()}) {
    const std::vector<Step> steps = map_work::steps(instrument);
    for (const auto& [resolution, stated] : resolutions)
      for (const int bits : {8, 16}) {
        Row row = {instrument.name, fmt::format("{:g}", resolution), std::to_string(bits), ""};
        for (const std::string& store : stores) {
          const OccupancyMap map = make_map(steps, resolution, bits, store);
          row[3] = std::to_string(map.known_cells());
          row.push_back(size_of(map));
        }
        row.push_back(stated);
        rows.push_back(row);
      }
  }
  fmt::print("kB (bytes a known cell) after one way through the hall; 2018: as stated there for 50 x 50 m with cells of 64 bits (with 8 bits):\n\n{}\n",
             markdown({"work", "cell, m", "bits", "known cells", "tiles", "dense", "quadtree", "2018"}, rows));
}

void tell_many_cells() {
  std::vector<Row> rows;
  const auto tell = [&](const std::string& place, const std::vector<Step>& steps, double resolution) {
    for (const int bits : {8, 16}) {
      const OccupancyMap map = make_map(steps, resolution, bits, "tiles");
      rows.push_back({place, fmt::format("{:g}", resolution), std::to_string(bits), fmt::format("{:.2f}", static_cast<double>(map.known_cells()) / 1e6), fixed(static_cast<double>(map.memory_bytes()) / 1e6), fixed(per_cell(map), 3)});
    }
  };
  for (const Instrument& instrument : {Instrument::radar4x58(), Instrument::lidar1440()}) {
    const std::vector<Step> steps = map_work::steps(instrument);
    for (const double resolution : {0.04, 0.03, 0.02}) tell("hall, " + instrument.name, steps, resolution);
    tell("hold, " + instrument.name, steps_in_hold(instrument), 0.1);
  }
  fmt::print("Tiles with a million known cells and more:\n\n{}\n", markdown({"work", "cell, m", "bits", "known cells, million", "MB", "bytes a known cell"}, rows));
}

void tell_hold() {
  constexpr double resolution = 0.1;
  const glm::dvec2 corner(hold_half_side);
  const TruthGrid truth = or_exit(occupancy(hold().world(), -corner, corner, resolution, 1.0, 1.0, Convention::cell_centre, false));
  const std::vector<std::string> dense_first = {"dense", "tiles", "quadtree"};
  std::vector<Row> rows;
  std::size_t scans = 0;
  for (const Instrument& instrument : {Instrument::radar4x58(), Instrument::lidar1440()}) {
    const std::vector<Step> steps = steps_in_hold(instrument);
    scans = steps.size();
    for (const int bits : {8, 16}) {
      const double bare = 4.0 * hold_half_side * hold_half_side / (resolution * resolution) * bits / 8.0;
      double dense = 0.0, tiles_f1 = 0.0;
      for (const std::string& store : dense_first) {
        const OccupancyMap map = make_map(steps, resolution, bits, store);
        const MapScore score = or_exit(score_map(map.to_probabilities(), truth));
        const auto bytes = static_cast<double>(map.memory_bytes());
        if (store == "dense") dense = bytes;
        if (store == "tiles") tiles_f1 = score.f1;
        rows.push_back({instrument.name, store, std::to_string(bits), std::to_string(map.known_cells()), kilobytes(bytes), fixed(bytes / bare, 3), fixed(bytes / dense, 3), fixed(score.f1, 4),
                        store == "quadtree" ? fmt::format("{:+.4f}", score.f1 - tiles_f1) : "", fixed(score.claimed_nll, 3)});
      }
    }
  }
  fmt::print("A hold of 200 x 200 m, nearly empty, cells of {:g} m, {} scans along 10 lanes, truth cell_centre:\n\n{}", resolution, scans,
             markdown({"work", "store", "bits", "known cells", "kB", "of bare cells", "of dense", "F1 @ 0.2 m", "against tiles", "NLL of claimed"}, rows, 2));
}

}  // namespace

void study_memory() {
  tell_hall();
  tell_many_cells();
  tell_hold();
}

}  // namespace thicket::study
