// The table of knobs: which keys each turns, by type of sensor, and to what.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "thicket/base/schema.hpp"
#include "thicket/base/text.hpp"
#include "thicket/sim/tradeoff.hpp"

namespace thicket {
namespace {

using Settings = std::vector<KnobSetting>;

/// How a key follows its knob: in proportion, or the other way round (a step between beams: half as many beams, twice the step).
enum class Follows : std::uint8_t { proportional, inverse };

/// A key of a sensor that a knob turns in proportion to its own value.
struct SensorKey {
  const char* key;
  std::optional<double> (*own)(const SensorSpec&);  ///< nothing: this sensor has none, or it does not matter there
  Follows follows = Follows::proportional;
  bool whole = false;  ///< a number of things, at least 1
};

const ReceiverSpec* receiver(const SensorSpec& spec) {
  const ReceiverSpec* found = nullptr;
  if (const auto* scanning = std::get_if<ScanningRadarSpec>(&spec)) found = scanning;
  if (const auto* lobe = std::get_if<LobeRadarSpec>(&spec)) found = lobe;
  return found && found->echoes == "receiver" ? found : nullptr;
}
const RadarSpec* radar(const SensorSpec& spec) {
  if (const auto* scanning = std::get_if<ScanningRadarSpec>(&spec)) return scanning;
  return std::get_if<LobeRadarSpec>(&spec);
}

std::string key_of(const SensorSpec& spec, const char* key) { return fmt::format("sensor.{}.{}", mounted(spec).name, key); }
Override change(std::string key, std::string value) { return {std::move(key), std::move(value), "tradeoff"}; }

/// `own` times the factor as the key has it; whole numbers as such.
std::string turned(double own, double factor, Follows follows, bool whole) {
  const double value = follows == Follows::inverse ? own / factor : own * factor;
  return whole ? std::to_string(std::max<std::int64_t>(1, std::llround(value))) : to_toml(value);
}

/// Settings by factors of the sensors' own values. A setting that changes nothing is left out.
Settings scaled(const Mission& mission, const std::vector<double>& factors, const std::vector<SensorKey>& keys) {
  Settings list;
  for (const double factor : factors) {
    KnobSetting setting{fmt::format("x {:g}", factor), {}, factor > 1.0};
    bool other = false;
    for (const SensorSpec& sensor : mission.sensors)
      for (const SensorKey& key : keys) {
        const auto own = key.own(sensor);
        if (!own) continue;
        setting.changes.push_back(change(key_of(sensor, key.key), turned(*own, factor, key.follows, key.whole)));
        other = other || setting.changes.back().value != turned(*own, 1.0, key.follows, key.whole);
      }
    if (other) list.push_back(std::move(setting));
  }
  return list;
}

/// The same of one key of the mission.
Settings scaled(const std::vector<double>& factors, const char* key, double own, bool finer_is_less, bool whole = false) {
  Settings list;
  for (const double factor : factors) {
    const std::string value = turned(own, factor, Follows::proportional, whole);
    if (value != turned(own, 1.0, Follows::proportional, whole)) list.push_back({value, {change(key, value)}, (factor < 1.0) == finer_is_less});
  }
  return list;
}

/// Values of one key of the mission, the most accurate first, without its own one.
Settings values(const char* key, const std::vector<std::string>& list, const std::string& own) {
  Settings settings;
  const auto place = std::ranges::find(list, own);
  for (auto value = list.begin(); value != list.end(); ++value)
    if (*value != own) settings.push_back({*value, {change(key, value->front() >= '0' && value->front() <= '9' ? *value : toml_string(*value))}, value < place});
  return settings;
}

/// One value for all sensors that `has` says yes to, without settings that change none of them. Finer is what comes before the value that the first of them has.
template <class Has, class Own>
Settings for_sensors(const Mission& mission, const char* key, const std::vector<std::pair<std::string, std::string>>& labels_and_values, const Has& has, const Own& own) {
  Settings list;
  bool finer = true;
  for (const auto& [label, value] : labels_and_values) {
    KnobSetting setting{label, {}, true};
    bool other = false;
    for (const SensorSpec& sensor : mission.sensors) {
      if (!has(sensor)) continue;
      setting.changes.push_back(change(key_of(sensor, key), value));
      other = other || own(sensor) != value;
    }
    finer = setting.finer = finer && other;
    if (other) list.push_back(std::move(setting));
  }
  return list;
}

// --- the knobs

Settings rays(const Mission& m) {
  return scaled(m, {2.0, 0.5, 0.25, 0.125},
                {{"step_deg", [](const SensorSpec& s) { return scanner(s) ? std::optional(scanner(s)->step_deg) : std::nullopt; }, Follows::inverse},
                 {"azimuth_rays", [](const SensorSpec& s) -> std::optional<double> {
                    const auto* lobe = std::get_if<LobeRadarSpec>(&s);
                    return lobe && !lobe->ray_spacing_m ? std::optional(static_cast<double>(lobe->azimuth_rays)) : std::nullopt;
                  }, Follows::proportional, true},
                 {"ray_spacing_m", [](const SensorSpec& s) -> std::optional<double> {
                    const auto* lobe = std::get_if<LobeRadarSpec>(&s);
                    return lobe ? lobe->ray_spacing_m : std::nullopt;
                  }, Follows::inverse}});
}

Settings elevation(const Mission& m) {
  return scaled(m, {2.0, 0.5, 0.25, 0.125},
                {{"elevation_rays", [](const SensorSpec& s) -> std::optional<double> {
                    if (const auto* lobe = std::get_if<LobeRadarSpec>(&s)) return lobe->ray_spacing_m ? std::nullopt : std::optional(static_cast<double>(lobe->elevation_rays));
                    const auto* scanning = std::get_if<ScanningRadarSpec>(&s);
                    return scanning && scanning->elevation_opening_deg > 0.0 ? std::optional(static_cast<double>(scanning->elevation_rays)) : std::nullopt;
                  }, Follows::proportional, true}});
}

Settings bounces(const Mission& m) {
  std::int64_t most = 0;
  for (const SensorSpec& s : m.sensors)
    if (radar(s)) most = std::max(most, radar(s)->bounces_max);
  if (most == 0) return {};
  std::vector<std::pair<std::string, std::string>> list;
  for (const std::int64_t count : {most + 2, most + 1, most, most - 1, std::int64_t{1}})
    if (count >= 1 && (list.empty() || list.back().first != std::to_string(count))) list.emplace_back(std::to_string(count), std::to_string(count));
  return for_sensors(m, "bounces_max", list, [](const SensorSpec& s) { return radar(s) != nullptr; }, [](const SensorSpec& s) { return std::to_string(radar(s)->bounces_max); });
}

Settings divergence(const Mission& m) {
  const auto cone = [](const SensorSpec& s) -> std::optional<double> {
    const auto* scanning = std::get_if<ScanningRadarSpec>(&s);
    return scanning && scanning->divergence == "cone" ? std::optional(static_cast<double>(scanning->cone_rays)) : std::nullopt;
  };
  return scaled(m, {3.0, 0.5, 0.25}, {{"cone_rays", cone, Follows::proportional, true}});
}

Settings echoes(const Mission& m) {
  return for_sensors(m, "first_echo_only", {{"all", "false"}, {"first", "true"}}, [](const SensorSpec& s) { return std::holds_alternative<ScanningRadarSpec>(s); },
                     [](const SensorSpec& s) -> std::string { return std::get<ScanningRadarSpec>(s).first_echo_only ? "true" : "false"; });
}

Settings bins(const Mission& m) {
  return scaled(m, {2.0, 0.5, 0.25, 0.125},
                {{"bin_size_m", [](const SensorSpec& s) { return receiver(s) ? std::optional(receiver(s)->bin_size_m) : std::nullopt; }, Follows::inverse},
                 {"bin_count", [](const SensorSpec& s) -> std::optional<double> {
                    return receiver(s) && receiver(s)->bin_count > 0 ? std::optional(static_cast<double>(receiver(s)->bin_count)) : std::nullopt;
                  }, Follows::proportional, true}});
}

Settings rate(const Mission& m) {
  return scaled(m, {2.0, 0.5, 0.25}, {{"rate_hz", [](const SensorSpec& s) { return std::optional(mounted(s).rate_hz); }}});
}

Settings store(const Mission& m) { return m.map.enabled ? values("map.store", {"tiles", "dense", "quadtree"}, m.map.store) : Settings{}; }
Settings resolution(const Mission& m) { return m.map.enabled ? scaled({0.5, 2.0, 4.0}, "map.resolution_m", m.map.resolution_m, true) : Settings{}; }
Settings bits(const Mission& m) { return m.map.enabled ? values("map.cell_bits", {"16", "8"}, std::to_string(m.map.cell_bits)) : Settings{}; }
Settings bumpers(const Mission& m) { return scaled({2.0, 0.5}, "bumpers.count", m.bumpers.count, false, true); }
Settings step(const Mission& m) { return scaled({0.5, 2.0, 4.0}, "step_s", m.step_s, true); }

}  // namespace

const std::vector<Knob>& tradeoff_knobs() {
  static const std::vector<Knob> list = {
      {"rays", "beams of a scan (step_deg), rays over a lobe's azimuth (azimuth_rays)", true, &rays},
      {"elevation", "rows of rays over the elevation (elevation_rays)", true, &elevation},
      {"bounces", "surfaces that a wave may meet (bounces_max)", true, &bounces},
      {"divergence", "rays of a beam that is a cone (cone_rays)", true, &divergence},
      {"echoes", "echoes kept of a beam (first_echo_only)", false, &echoes},
      // (Bins are the device's: with others its noise and its threshold would be others, too.)
      {"bins", "range bins of a receiver (bin_size_m, bin_count)", false, &bins},
      {"store", "how the map is kept (map.store)", false, &store},
      {"resolution", "cells of the map, m (map.resolution_m)", true, &resolution},
      {"bits", "of a cell of the map (map.cell_bits)", true, &bits},
      {"bumpers", "how many (bumpers.count)", false, &bumpers},
      {"step", "simulated time of a step, s (step_s)", true, &step},
      {"rate", "scans per second (rate_hz)", true, &rate},
  };
  return list;
}

Result<std::vector<const Knob*>> chosen_knobs(const std::string& names) {
  std::vector<std::string> known, wanted;
  for (const Knob& knob : tradeoff_knobs()) known.push_back(knob.name);
  for (std::size_t from = 0; from < names.size();) {
    const std::size_t comma = std::min(names.find(',', from), names.size());
    wanted.push_back(names.substr(from, comma - from));
    from = comma + 1;
  }
  for (const std::string& name : wanted)
    if (std::ranges::find(known, name) == known.end())
      return Error{fmt::format("--knobs: there is no knob '{}', expected some of '{}' separated by commas{}", name, fmt::join(known, "', '"), did_you_mean(name, known))};
  std::vector<const Knob*> list;
  for (const Knob& knob : tradeoff_knobs())
    if (wanted.empty() || std::ranges::find(wanted, knob.name) != wanted.end()) list.push_back(&knob);
  return list;
}

}  // namespace thicket
