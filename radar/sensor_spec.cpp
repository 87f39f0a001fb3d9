#include "thicket/radar/sensor_spec.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "antenna.hpp"
#include "thicket/base/files.hpp"
#include "thicket/base/pose.hpp"
#include "thicket/base/text.hpp"

namespace thicket {
namespace {

template <class S>
SectionOf<S> mounted_section(const char* type, const char* help) {
  SectionOf<S> section(fmt::format("[[sensor]] of type \"{}\"", type), help);
  section.key("name", &S::name, "name of the sensor, for --set and for outputs")
      .key("rate_hz", &S::rate_hz, "Hz", above_up_to(0.0, 1e4), "scans per second")
      .key("position_m", &S::position_m, "m", between(-100.0, 100.0), "where it sits on the vehicle: forward, left, up from the ground")
      .key("yaw_deg", &S::yaw_deg, "deg", between(-360.0, 360.0), "where its x axis points on the vehicle, counter-clockwise from forward")
      .key("pitch_deg", &S::pitch_deg, "deg", between(-90.0, 90.0), "how far its x axis points down")
      .key("roll_deg", &S::roll_deg, "deg", between(-180.0, 180.0), "turn about its x axis, right side down")
      .key("range_min_m", &S::range_min_m, "m", between(0.0, 1e5), "nearer echoes are not seen")
      .key("range_max_m", &S::range_max_m, "m", above_up_to(0.0, 1e5), "farther echoes are not seen")
      .key("range_noise_m", &S::range_noise_m, "m", between(0.0, 1e6), "standard deviation of traced ranges, one draw per beam and scan");
  return section;
}

template <class S>
void add_scanner_keys(SectionOf<S>& section) {
  section.key("fov_deg", &S::fov_deg, "deg", above_up_to(0.0, 360.0), "sector that it scans, centred on its x axis")
      .key("step_deg", &S::step_deg, "deg", between(0.001, 180.0), "angle between beams");
}

template <class S>
void add_radar_keys(SectionOf<S>& section) {
  section.key("frequency_ghz", &S::frequency_ghz, "GHz", between(0.3, 300.0), "at which the numbers of materials are taken")
      .choice("law", &S::law, {"radar_equation", "printed"}, "what a ray returns: by the radar equation, or as eq. 4.2 of Billdal 2018 prints it")
      .key("range_compensation", &S::range_compensation, "the receiver's gain grows with the range (sensitivity-time control): a wall is as strong at any range")
      .key("penetration_budget_db", &S::penetration_budget_db, "dB", or_infinite(at_least(0.0)), "loss inside matter, one way, after which a ray is exhausted")
      .key("detection_floor_db", &S::detection_floor_db, "dB", between(-300.0, 0.0),
           "power under which nothing is seen; 0 dB is a perfect diffuse reflector that fills the beam squarely (at range_max_m, without range_compensation)")
      .choice("scattering", &S::scattering, {"material", "lambert"}, "where a surface sends the wave: by its material's roughness, or everything is diffuse")
      .key("fresnel", &S::fresnel, "what a dielectric reflects depends on the angle (Fresnel); else as if met squarely")
      .key("slab_max_m", &S::slab_max_m, "m", at_least(0.0), "a solid in the open that is no thicker is one slab with inner reflections (ITU-R P.2040-3), and one echo; 0: none is")
      .key("excess_range", &S::excess_range, "the wave is slower in dielectrics, so that what lies behind seems farther")
      .key("statistical_foliage", &S::statistical_foliage, "materials with leaves_per_m are leaves at random places, others in each scan, instead of even matter")
      .choice("surfaces", &S::surfaces, {"auto", "all"}, "of each ray only what the world can show (nothing behind opaque matter, no bounces without mirrors), or every surface, as a check")
      .key("bounces_max", &S::bounces_max, "", between(1.0, 64.0), "surfaces that a wave may meet on its way out; 1 is no multipath")
      .key("radial_velocity", &S::radial_velocity, "echoes tell how fast their range changes (Doppler)")
      .choice("sampling", &S::sampling, {"regular", "jitter"}, "rays at the middles of their cells, or at random places in them, others in each scan");
}

template <class S>
void add_receiver_keys(SectionOf<S>& section) {
  section.choice("echoes", &S::echoes, {"traced", "receiver"}, "what maps and bumpers get: what the rays met, or what the receiver detects")
      .key("bin_count", &S::bin_count, "", between(0.0, 1e6), "range bins of the receiver; 0: as many as range_max_m takes")
      .key("bin_size_m", &S::bin_size_m, "m", above_up_to(0.0, 1e3), "of a range bin")
      .key("bin_offset_m", &S::bin_offset_m, "m", between(-1e3, 1e5), "range of the middle of the first bin")
      .key("bandwidth_ghz", &S::bandwidth_ghz, "GHz", between(0.0, 100.0), "of the pulse, a Gaussian, at -10 dB; 0: a pulse no longer than a bin")
      .choice("signal", &S::signal, {"amplitude", "iq"}, "powers are added in a bin, or fields with their phases")
      .key("noise", &S::noise, "", between(0.0, 1e6), "standard deviation of the white noise per bin (each of I and Q); without it, the noise that gives false_alarm_rate at the threshold")
      .key("noise_walk", &S::noise_walk, "", between(0.0, 1e6), "noise that wanders from bin to bin: standard deviation of a step")
      .key("smoothing_bins", &S::smoothing_bins, "", between(1.0, 1e4), "length of the moving average over bins")
      .key("clutter_floor", &S::clutter_floor, "", between(0.0, 1e6), "amplitude of the clutter that is in every bin; powers add")
      .key("saturation", &S::saturation, "", or_infinite(above(0.0)), "amplitude above which the receiver clips")
      .choice("detector", &S::detector, {"threshold", "ca_cfar"}, "against a fixed threshold, or against the mean of the bins around (cell-averaging CFAR)")
      .key("threshold", &S::threshold, "", above_up_to(0.0, 1e6), "amplitude that a detection takes; 0.038 is that of Billdal 2018")
      .key("false_alarm_rate", &S::false_alarm_rate, "", between(1e-15, 0.4), "per bin: of CFAR, and of the noise where none is given")
      .key("cfar_training_bins", &S::cfar_training_bins, "", between(1.0, 1e4), "bins that are averaged, on either side")
      .key("cfar_guard_bins", &S::cfar_guard_bins, "", between(0.0, 1e4), "bins next to the one in question that are left out, on either side")
      .choice("detection", &S::detection, {"first", "strongest", "all"}, "which of the tops above the threshold are echoes")
      .key("floor_gate", &S::floor_gate, "the threshold is raised to what the ground below, whose distance an altimeter tells, would return");
}

SectionOf<ScanningRadarSpec> scanning_section() {
  using S = ScanningRadarSpec;
  auto section = mounted_section<S>("scanning_radar", "a penetrating scanning radar, as that of Rozeboom 2012");
  add_scanner_keys(section);
  section.key("elevation_opening_deg", &S::elevation_opening_deg, "deg", between(0.0, 170.0), "full opening of a beam upward and downward; 0 looks along the plane alone")
      .key("elevation_rays", &S::elevation_rays, "", between(1.0, 1000.0), "rows of rays over the elevation opening")
      .choice("divergence", &S::divergence, {"none", "side_rays", "cone"}, "beam divergence: a beam is its middle, left and right ray; or a cone of cone_rays")
      .key("side_offset_m", &S::side_offset_m, "m", between(0.0, 1e3), "N of the 2012 text: how far a side ray is off the beam's middle")
      .choice("side_geometry", &S::side_geometry, {"diverging", "parallel"}, "side rays from the same origin, N off at range_max_m; or N off everywhere")
      .choice("side_choice", &S::side_choice, {"equal", "incidence", "strongest", "sum"},
              "which of the three rays is the beam: by equal chance, by chance in proportion to the cosine of incidence, the strongest, or all of them")
      .key("cone_opening_deg", &S::cone_opening_deg, "deg", between(0.001, 90.0), "full width of the cone")
      .key("cone_rays", &S::cone_rays, "", between(1.0, 10000.0), "rays of the cone; all of them are the beam");
  add_radar_keys(section);
  section.key("first_echo_only", &S::first_echo_only, "keep only the first echo of each beam, as if it could not see through anything");
  add_receiver_keys(section);
  return section;
}

SectionOf<LobeRadarSpec> lobe_section() {
  using S = LobeRadarSpec;
  auto section = mounted_section<S>("lobe_radar", "a fixed antenna with a wide opening along its x axis, as the X4M05 of Billdal 2018");
  section.key("azimuth_opening_deg", &S::azimuth_opening_deg, "deg", between(0.001, 180.0), "full opening to the left and right")
      .key("elevation_opening_deg", &S::elevation_opening_deg, "deg", between(0.001, 170.0), "full opening upward and downward")
      .key("azimuth_rays", &S::azimuth_rays, "", between(1.0, 2000.0), "rays over the azimuth opening")
      .key("elevation_rays", &S::elevation_rays, "", between(1.0, 2000.0), "rays over the elevation opening")
      .choice("rows", &S::rows, {"auto", "one", "all"}, "one level row of rays stands for all where the world is the same at every height that a level lobe with a receiver sees, with regular rays; one: jittered ones too, whose scans then vary more; or each row is traced")
      .key("ray_spacing_m", &S::ray_spacing_m, "m", above_up_to(0.0, 1e3), "distance of neighbouring rays at range_max_m; gives the numbers of rays (eq. 4.4 of Billdal 2018)")
      .choice("section", &S::section, {"square", "elliptic"}, "of the lobe")
      .choice("gain", &S::gain, {"flat", "gaussian", "table"}, "of the antenna over the angle off its axis; nothing outside the opening")
      .key("gain_width_deg", &S::gain_width_deg, "deg", above_up_to(0.0, 360.0), "azimuth and elevation: full one-way -3 dB width of a Gaussian gain; without it the openings")
      .key("gain_table_db", &S::gain_table_db, "deg, dB", between(-300.0, 180.0), "points [angle off the axis, one-way gain] by angle; straight between, and as the last one beyond");
  add_radar_keys(section);
  add_receiver_keys(section);
  return section;
}

SectionOf<LidarSpec> lidar_section() {
  auto section = mounted_section<LidarSpec>("lidar", "a laser scanner: it sees the first surface that stops light, or as deep into smoke as its light gets");
  add_scanner_keys(section);
  section.key("range_noise_table_m", &LidarSpec::range_noise_table_m, "m", between(0.0, 1e6),
              "points [range, standard deviation] by range, straight between and level beyond; if given, instead of range_noise_m");
  section.key("optical_depth_max", &LidarSpec::optical_depth_max, "", or_infinite(above(0.0)),
              "optical depth (extinction x path, one way) at which a ray ends inside a medium; at 1, light is down by e^-2 there and back; inf sees through every medium");
  return section;
}

/// Points of a table must come by their first number.
void check_order(const Node& entry, const char* key, const std::vector<glm::dvec2>& table, Faults& faults) {
  for (std::size_t i = 1; i < table.size(); ++i) {
    if (table[i].x >= table[i - 1].x) continue;
    const Node* node = entry.find(key);
    return faults.add(node ? node->place : entry.place, fmt::format("'{}' goes back from {} to {}, expected points by their first number", key, table[i - 1].x, table[i].x));
  }
}

/// What a scan may take: these rays are 2 GB while they are traced, and these bins 1 GB.
constexpr double most_rays = 4e6, most_bins = 1e8;

/// `beams`, of `rays` each.
void check_radar(const Node& entry, const MountedSpec& common, const RadarSpec& radar, const ReceiverSpec& receiver, double beams, double rays, Faults& faults) {
  const auto place = [&](const char* key) { return entry.find(key) ? entry.find(key)->place : entry.place; };
  const double range_max = common.range_max_m;
  if (beams * rays > most_rays) faults.add(entry.place, fmt::format("{:g} beams of {:g} rays are more than a scan may have, expected at most {:g} rays in all", beams, rays, most_rays));
  if (receiver.echoes == "receiver") {
    const double bins = receiver.bin_count > 0 ? static_cast<double>(receiver.bin_count) : std::max(0.0, (range_max - receiver.bin_offset_m) / receiver.bin_size_m) + 1.0;
    const double last = receiver.bin_offset_m + (bins - 1.0) * receiver.bin_size_m;
    if (beams * bins > most_bins)
      faults.add(place("bin_count"), fmt::format("{:g} beams of {:g} bins are more than a scan may have, expected at most {:g} bins in all", beams, bins, most_bins));
    if (receiver.bin_offset_m > range_max)
      faults.add(place("bin_offset_m"), fmt::format("'bin_offset_m' is {}, so that all bins are beyond range_max_m, {}, expected less", receiver.bin_offset_m, range_max));
    else if (receiver.bin_count > 0 && last < common.range_min_m)
      faults.add(place("bin_count"), fmt::format("the last bin is at {} m, nearer than range_min_m, {}, expected more or larger bins", last, common.range_min_m));
  }
  if (radar.law == "printed" && receiver.signal == "iq")
    faults.add(place("signal"), "'signal' is 'iq', but the printed law has no phases, expected 'amplitude', or law = 'radar_equation'");
  if (receiver.echoes == "receiver" && common.range_noise_m > 0.0)
    faults.add(place("range_noise_m"), "'range_noise_m' is for traced echoes, expected the 'noise' of the receiver");
  if (receiver.bin_count == 0 && (range_max - receiver.bin_offset_m) / receiver.bin_size_m > 1e6)
    faults.add(place("bin_size_m"), fmt::format("range_max_m takes over a million bins of {} m, expected larger bins or a bin_count", receiver.bin_size_m));
}

std::string preset_folder() { return (shipped_root() / "radar" / "presets").string(); }

/// Presets may build on one another; deeper than this they do so without end.
constexpr int deepest_preset = 8;

SensorSpec read_sensor_at(const Node& entry, Faults& faults, int depth);

/// Reads `preset` into a spec; the entry's own keys come on top of it. Nothing if there is no such preset.
std::optional<SensorSpec> read_preset(const Node& preset, Faults& faults, int depth) {
  const auto* name = std::get_if<std::string>(&preset.content);
  if (!name) {
    faults.add(preset.place, fmt::format("'preset' is {}, expected a text in quotes", preset.kind_in_words()));
    return std::nullopt;
  }
  if (depth > deepest_preset) {
    faults.add(preset.place, fmt::format("'preset' is '{}', which builds on itself, expected another one", *name));
    return std::nullopt;
  }
  std::filesystem::path file = std::filesystem::path(preset_folder()) / (*name + ".toml");
  if (!std::filesystem::exists(file)) file = *name;
  if (!std::filesystem::is_regular_file(file)) {
    const auto known = sensor_presets();
    faults.add(preset.place, fmt::format("there is no sensor preset '{}', expected one of '{}' or a file{}", *name, fmt::join(known, "', '"), did_you_mean(*name, known)));
    return std::nullopt;
  }
  const auto document = read_document(file);
  if (!document) {
    faults.take(document.error());
    return std::nullopt;
  }
  return read_sensor_at(*document, faults, depth + 1);
}

}  // namespace

const std::vector<std::string>& sensor_types() {
  static const std::vector<std::string> types = {"scanning_radar", "lobe_radar", "lidar"};
  return types;
}

const char* sensor_type(const SensorSpec& spec) { return sensor_types()[spec.index()].c_str(); }

SensorSpec default_sensor(const std::string& type) {
  if (type == "lidar") return LidarSpec{};
  if (type == "lobe_radar") return LobeRadarSpec{};
  return ScanningRadarSpec{};
}

const Section& sensor_section(const SensorSpec& spec) {
  static const std::array<Section, std::variant_size_v<SensorSpec>> sections = {scanning_section(), lobe_section(), lidar_section()};
  return sections[spec.index()];
}

namespace {

SensorSpec read_sensor_at(const Node& entry, Faults& faults, int depth) {
  SensorSpec spec = ScanningRadarSpec{};
  const Node* type = entry.find("type");
  const Node* preset = entry.find("preset");
  if (preset) {
    auto read = read_preset(*preset, faults, depth);
    if (!read) return spec;  // told already; which keys there are is not known
    spec = std::move(*read);
  }
  if (type) {
    const auto* word = std::get_if<std::string>(&type->content);
    const auto& known = sensor_types();
    if (!word || std::find(known.begin(), known.end(), *word) == known.end()) {
      faults.add(type->place, fmt::format("'type' is {}, expected one of '{}'{}", word ? "'" + *word + "'" : type->kind_in_words(), fmt::join(known, "', '"),
                                          word ? did_you_mean(*word, known) : ""));
    } else if (!preset) {
      spec = default_sensor(*word);
    } else if (*word != sensor_type(spec)) {
      faults.add(type->place, fmt::format("'type' is '{}', but the preset is of type '{}': leave one of them out", *word, sensor_type(spec)));
    }
  } else if (!preset) {
    faults.add(entry.place, fmt::format("[[sensor]] lacks 'type' or 'preset', expected a type of '{}', or a preset of '{}'", fmt::join(sensor_types(), "', '"),
                                        fmt::join(sensor_presets(), "', '")));
  }
  read_section(entry, sensor_section(spec), sensor_object(spec), faults, {"type", "preset"});
  // A noise that is given on top of a preset is meant to count, and not the preset's table.
  if (auto* lidar = std::get_if<LidarSpec>(&spec); lidar && entry.find("range_noise_m") && !entry.find("range_noise_table_m")) lidar->range_noise_table_m.clear();
  const MountedSpec& common = mounted(spec);
  if (common.range_min_m >= common.range_max_m)
    faults.add(entry.place, fmt::format("'range_min_m' is {}, expected less than range_max_m, {}", common.range_min_m, common.range_max_m));
  if (const auto* radar = std::get_if<ScanningRadarSpec>(&spec)) {
    // What a scan will have; `azimuths_of` makes the list of it.
    const double beams = std::max(1.0, std::floor(radar->fov_deg / radar->step_deg + 1e-9) + (radar->fov_deg >= 360.0 ? 0.0 : 1.0));
    const double in_row = radar->divergence == "cone" ? static_cast<double>(radar->cone_rays) : radar->divergence == "side_rays" ? 3.0 : 1.0;
    check_radar(entry, *radar, *radar, *radar, beams, in_row * (radar->elevation_opening_deg > 0.0 ? static_cast<double>(radar->elevation_rays) : 1.0), faults);
    if (const Node* rows = entry.find("elevation_rays"); rows && radar->elevation_rays > 1 && radar->elevation_opening_deg == 0.0)
      faults.add(rows->place, fmt::format("'elevation_rays' is {}, but there is no opening to spread them over, expected an 'elevation_opening_deg' above 0", radar->elevation_rays));
    if (radar->first_echo_only && radar->echoes == "receiver") {
      const Node* node = entry.find("first_echo_only");
      faults.add(node ? node->place : entry.place, "'first_echo_only' is for traced echoes, expected detection = 'first' with a receiver");
    }
  }
  if (const auto* lidar = std::get_if<LidarSpec>(&spec)) check_order(entry, "range_noise_table_m", lidar->range_noise_table_m, faults);
  if (const auto* lobe = std::get_if<LobeRadarSpec>(&spec)) {
    check_radar(entry, *lobe, *lobe, *lobe, 1.0, lobe->ray_spacing_m ? 1.0 : static_cast<double>(lobe->azimuth_rays * lobe->elevation_rays), faults);
    check_order(entry, "gain_table_db", lobe->gain_table_db, faults);
    if (const Node* table = entry.find("gain_table_db"); table && lobe->gain != "table" && !lobe->gain_table_db.empty())
      faults.add(table->place, fmt::format("'gain_table_db' has points, but 'gain' is '{}', expected gain = 'table'", lobe->gain));
    if (lobe->gain == "table" && lobe->gain_table_db.empty()) faults.add(entry.place, "'gain' is 'table', expected its points in 'gain_table_db'");
    for (const double opening : {lobe->azimuth_opening_deg, lobe->elevation_opening_deg}) {
      constexpr std::int64_t at_most = 2000;
      const std::int64_t rays = lobe->ray_spacing_m ? rays_for_spacing(radians(opening), *lobe->ray_spacing_m, common.range_max_m) : 0;
      if (rays <= at_most) continue;
      const Node* node = entry.find("ray_spacing_m");
      faults.add(node ? node->place : entry.place, fmt::format("'ray_spacing_m' takes {} rays over {} deg at range_max_m, expected at most {}", rays, opening, at_most));
      break;
    }
  }
  return spec;
}

}  // namespace

SensorSpec read_sensor(const Node& entry, Faults& faults) { return read_sensor_at(entry, faults, 0); }

std::vector<std::string> sensor_presets() { return shipped_names("radar/presets"); }

}  // namespace thicket
