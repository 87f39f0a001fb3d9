#include "view_memory.hpp"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

namespace thicket {
namespace {

double yaw_of(const glm::dquat& orientation) {
  const glm::dvec3 forward = orientation * glm::dvec3(1.0, 0.0, 0.0);
  return std::atan2(forward.y, forward.x);
}

/// Beams that differ in bearing alone: a scanner's.
bool is_scanner(const Scan& scan) {
  if (scan.azimuth_opening > 0.0 || scan.beams.size() < 3) return false;
  return std::all_of(scan.beams.begin() + 1, scan.beams.end(), [&](const Beam& b) { return std::abs(b.elevation - scan.beams.front().elevation) < 1e-6; });
}

/// As many bins around as beams of the spacing fit.
std::size_t bins_of(const Scan& scan) {
  double least = 2.0 * pi;
  for (std::size_t i = 1; i < std::min<std::size_t>(scan.beams.size(), 4); ++i) least = std::min(least, std::abs(wrap_angle(scan.beams[i].azimuth - scan.beams[i - 1].azimuth)));
  return static_cast<std::size_t>(std::clamp(std::round(2.0 * pi / std::max(1e-4, least)), 8.0, 36000.0));
}

void add(Scan& to, const Beam& beam, const Echo* echoes) {
  Beam copy = beam;
  copy.first_echo = static_cast<std::uint32_t>(to.echoes.size());
  to.echoes.insert(to.echoes.end(), echoes, echoes + beam.echo_count);
  to.beams.push_back(copy);
}

void begin(Scan& scan, const Scan& like) {
  scan.range_noise = like.range_noise;
  scan.azimuth_opening = like.azimuth_opening;
  scan.elevation_opening = like.elevation_opening;
  scan.beams.clear();
  scan.echoes.clear();
}

}  // namespace

ViewMemory::Views ViewMemory::take(const Scan& scan, const Pose& sensor, double same_place) {
  Place& place = places_[scan.sensor];
  auto look = std::make_shared<Look>();
  look->sensor = sensor;
  look->yaw = yaw_of(sensor.orientation);
  look->beams = scan.beams;
  look->echoes = scan.echoes;
  if (glm::distance(sensor.position, place.position) > same_place || place.looks.empty()) {
    place.position = sensor.position;
    place.looks.clear();
    place.looks.push_back(std::move(look));
    return {&scan, {}};
  }
  const double tolerance = scan.azimuth_opening > 0.0 ? scan.azimuth_opening / 8.0 : radians(0.25);
  const bool turned = std::any_of(place.looks.begin(), place.looks.end(), [&](const auto& old) { return old->beams.size() != scan.beams.size() || std::abs(wrap_angle(old->yaw - look->yaw)) > tolerance; });
  const bool by_bearing = turned && is_scanner(scan);
  if (turned && !by_bearing) place.looks.clear();
  const std::size_t bins = by_bearing ? bins_of(scan) : 0;
  const auto bin_of = [&](double yaw, const Beam& beam) {
    const double turns = (yaw + beam.azimuth) / (2.0 * pi);
    return static_cast<std::size_t>((turns - std::floor(turns)) * static_cast<double>(bins)) % std::max<std::size_t>(1, bins);
  };
  if (by_bearing)
    for (auto& old : place.looks) {
      if (old->at_bin.size() == bins) continue;
      auto indexed = std::make_shared<Look>(*old);
      indexed->at_bin.assign(bins, -1);
      for (std::size_t b = 0; b < old->beams.size(); ++b) indexed->at_bin[bin_of(old->yaw, old->beams[b])] = static_cast<std::int32_t>(b);
      old = std::move(indexed);
    }
  begin(fresh_, scan);
  std::vector<std::pair<const Look*, std::size_t>> medians;
  struct Seen {
    double range;
    const Look* look;
    std::size_t beam;
  };
  std::array<Seen, looks + 1> seen;
  const auto age = [&](const Look& of) { return std::find_if(place.looks.begin(), place.looks.end(), [&](const auto& old) { return old.get() == &of; }) - place.looks.begin(); };
  for (std::size_t b = 0; b < scan.beams.size(); ++b) {
    std::size_t count = 0;
    seen[count++] = {look->first_range(b), look.get(), b};
    for (const auto& old : place.looks) {
      std::size_t there = b;
      if (by_bearing) {
        const std::int32_t found = old->at_bin[bin_of(look->yaw, scan.beams[b])];
        if (found < 0) continue;
        there = static_cast<std::size_t>(found);
      }
      seen[count++] = {old->first_range(there), old.get(), there};
    }
    if (count == 1) {
      add(fresh_, scan.beams[b], scan.echoes.data() + scan.beams[b].first_echo);
      continue;
    }
    if (count < enough) continue;
    const auto middle = seen.begin() + static_cast<std::ptrdiff_t>(count / 2);
    std::nth_element(seen.begin(), middle, seen.begin() + static_cast<std::ptrdiff_t>(count), [](const Seen& x, const Seen& y) { return x.range < y.range; });
    medians.emplace_back(middle->look, middle->beam);
  }
  std::stable_sort(medians.begin(), medians.end(), [&](const auto& x, const auto& y) { return age(*x.first) < age(*y.first); });
  std::size_t parts = 0;
  for (std::size_t i = 0; i < medians.size(); ++i) {
    const Look& of = *medians[i].first;
    if (i == 0 || medians[i - 1].first != &of) {
      if (repeated_.size() < ++parts) repeated_.emplace_back();
      repeated_[parts - 1].sensor = of.sensor;
      begin(repeated_[parts - 1].scan, scan);
    }
    const Beam& beam = of.beams[medians[i].second];
    add(repeated_[parts - 1].scan, beam, of.echoes.data() + beam.first_echo);
  }
  place.looks.push_back(std::move(look));
  if (place.looks.size() > looks - 1) place.looks.pop_front();
  return {fresh_.beams.empty() ? nullptr : &fresh_, std::span(repeated_.data(), parts)};
}

}  // namespace thicket
