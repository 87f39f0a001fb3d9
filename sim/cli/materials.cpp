// `thicket materials`: what matter is made of, as a radar of some frequency meets it.
#include <fmt/format.h>

#include <cmath>
#include <cstdio>

#include "program.hpp"
#include "thicket/worlds/world.hpp"

namespace thicket::cli {
namespace {

/// Three digits or more, as a table wants them: 2660, 54.4, 0.00218, 1e+07.
std::string figure(double number) { return number >= 100.0 && number < 1e5 ? fmt::format("{:.0f}", number) : fmt::format("{:.3g}", number); }

std::string power_db(double fraction) {
  const std::string text = fmt::format("{:.2f}", 10.0 * std::log10(fraction));
  return text == "-0.00" ? "0.00" : text;
}

Row heads(const MaterialsArguments& arguments) {
  Row row = {"material", "permittivity", "S/m", "reflectivity", "dB/m", "light 1/m", "stops"};
  if (arguments.thickness_m) row.insert(row.end(), {"reflected dB", "passed dB"});
  row.push_back("source");
  return row;
}

Row row_of(const Material& material, const MaterialsArguments& arguments) {
  const Material there = at_frequency(material, arguments.frequency_ghz);
  const auto& dielectric = material.dielectric;
  const std::string stops = material.stops_light && material.stops_motion ? "light, motion" : material.stops_light ? "light" : material.stops_motion ? "motion" : "nothing";
  Row row = {material.name,
             dielectric ? figure(permittivity(*dielectric, arguments.frequency_ghz).real()) : "-",
             dielectric ? figure(conductivity(*dielectric, arguments.frequency_ghz)) : "-",
             figure(there.reflectivity),
             there.opaque() ? "opaque" : figure(there.attenuation_db_per_m),
             material.light_medium() ? figure(material.light_extinction_per_m) : material.stops_light ? "surface" : "-",
             stops};
  if (arguments.thickness_m) {
    const Slab wall = slab(material, arguments.frequency_ghz, *arguments.thickness_m);
    row.push_back(power_db(wall.reflected));
    row.push_back(power_db(wall.transmitted));
  }
  row.push_back(material.source.empty() ? "-" : material.source);
  return row;
}

Result<std::vector<Material>> materials_of(const std::string& world_name) {
  if (world_name.empty()) return material_presets();
  const auto file = find_world(world_name);
  if (!file) return file.error();
  auto world = read_world(*file);
  if (!world) return world.error();
  return std::move(world->materials);
}

}  // namespace

int list_materials(const MaterialsArguments& arguments) {
  if (!(arguments.frequency_ghz >= 0.3 && arguments.frequency_ghz <= 300.0))
    return complain({fmt::format("--frequency-ghz is {}, expected 0.3 to 300", arguments.frequency_ghz)});
  if (arguments.thickness_m && !(*arguments.thickness_m > 0.0 && *arguments.thickness_m <= 1e3))
    return complain({fmt::format("--thickness-m is {}, expected metres, above 0 and at most 1000", *arguments.thickness_m)});
  const auto materials = materials_of(arguments.world);
  if (!materials) return complain(materials.error());
  std::vector<Row> rows = {heads(arguments)};
  for (const Material& material : *materials) rows.push_back(row_of(material, arguments));
  fmt::print("at {:g} GHz{}\n\n{}", arguments.frequency_ghz, arguments.thickness_m ? fmt::format(", walls of {:g} m at normal incidence", *arguments.thickness_m) : "", aligned(rows, {"stops"}));
  return done;
}

}  // namespace thicket::cli
