#include "thicket/worlds/material.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "material_file.hpp"
#include "thicket/base/files.hpp"
#include "thicket/base/text.hpp"

namespace thicket {
namespace {

using Complex = std::complex<double>;

constexpr double light_speed = 299792458.0;           // m/s
constexpr double vacuum_permittivity = 8.8541878128e-12;  // F/m, CODATA 2018

double angular_frequency(double frequency_ghz) { return 2.0 * std::numbers::pi * 1e9 * frequency_ghz; }
double wave_number(double frequency_ghz) { return angular_frequency(frequency_ghz) / light_speed; }

struct RadarNumbers {
  double reflectivity, attenuation_db_per_m;
};
RadarNumbers numbers_of(const Dielectric& dielectric, double frequency_ghz) {
  const Complex index = std::sqrt(permittivity(dielectric, frequency_ghz));
  const double attenuation = 20.0 * std::numbers::log10e * wave_number(frequency_ghz) * std::abs(index.imag());
  return {std::norm((1.0 - index) / (1.0 + index)), attenuation > opaque_db_per_m ? std::numeric_limits<double>::infinity() : attenuation};
}

Slab slab_of(const Dielectric& dielectric, double frequency_ghz, double thickness, double incidence) {
  const double cosine = std::cos(incidence), sine = std::sin(incidence);
  const Complex eta = permittivity(dielectric, frequency_ghz), inside = std::sqrt(eta - sine * sine);
  const Complex once = std::exp(Complex(0.0, -1.0) * (wave_number(frequency_ghz) * thickness * inside));
  Slab mean;
  for (const Complex face : {(cosine - inside) / (cosine + inside), (eta * cosine - inside) / (eta * cosine + inside)}) {  // TE, TM
    const Complex inner = 1.0 - face * face * once * once;
    mean.reflected += 0.5 * std::norm(face * (1.0 - once * once) / inner);
    mean.transmitted += 0.5 * std::norm((1.0 - face * face) * once / inner);
  }
  return mean;
}

Slab slab_of_powers(const Material& material, double thickness, double incidence) {
  const double reflectivity = material.reflectivity, through = 1.0 - reflectivity;
  if (through <= 0.0) return {1.0, 0.0};
  const double once = std::pow(10.0, -0.1 * material.attenuation_db_per_m * thickness / std::cos(incidence));
  const double inner = 1.0 - reflectivity * reflectivity * once * once;
  return {reflectivity * (1.0 + through * through * once * once / inner), through * through * once / inner};
}

/// The keys of a table. A dielectric is there as soon as there is a permittivity.
struct MaterialKeys {
  Material material;
  std::optional<std::string> preset;
  std::optional<double> permittivity, permittivity_exponent, conductivity, conductivity_exponent;
};

const SectionOf<MaterialKeys>& material_section() {
  static const SectionOf<MaterialKeys> section = [] {
    using K = MaterialKeys;
    SectionOf<K> s("[material.NAME]", "a material; solids name it. The shipped ones (`thicket materials`) need no table");
    const auto member = [](auto Material::*of) { return [of](K& k) -> auto& { return k.material.*of; }; };
    s.key("preset", &K::preset, "shipped material whose numbers stand where this table has none");
    s.add("reflectivity", member(&Material::reflectivity), "", between(0.0, 1.0), "fraction of the power that its surface reflects at normal incidence");
    s.add("attenuation_db_per_m", member(&Material::attenuation_db_per_m), "dB/m", or_infinite(at_least(0.0)),
          "loss of a radar ray inside, one way (at 1 GHz, if it has an exponent); inf is opaque");
    s.add("attenuation_exponent", member(&Material::attenuation_exponent), "", between(-5.0, 5.0), "n of attenuation_db_per_m f^n, f in GHz");
    s.key("permittivity", &K::permittivity, "", between(1.0, 1e6), "relative permittivity at 1 GHz; reflectivity and attenuation then follow from it and the conductivity")
        .key("permittivity_exponent", &K::permittivity_exponent, "", between(-5.0, 5.0), "n of permittivity f^n, f in GHz; without it 0")
        .key("conductivity_s_per_m", &K::conductivity, "S/m", between(0.0, 1e12), "conductivity at 1 GHz; without it 0")
        .key("conductivity_exponent", &K::conductivity_exponent, "", between(-5.0, 5.0), "n of conductivity_s_per_m f^n, f in GHz; without it 0");
    s.add("roughness", member(&Material::roughness), "", between(0.0, 1.0), "0 is a mirror, 1 is diffuse");
    s.add("stops_light", member(&Material::stops_light), "", Range{}, "whether a lidar's ray ends at its surface, or inside it if light_extinction_per_m is finite");
    s.add("light_extinction_per_m", member(&Material::light_extinction_per_m), "1/m", or_infinite(at_least(0.0)),
          "of smoke and the like, which light enters: 1 / its mean free path; inf is a surface");
    s.add("leaves_per_m", member(&Material::leaves_per_m), "1/m", between(0.0, 1e4), "how many leaves a ray meets per metre, for radars with statistical_foliage; 0 is even matter");
    s.add("stops_motion", member(&Material::stops_motion), "", Range{}, "whether a robot collides with it");
    s.add("source", member(&Material::source), "", Range{}, "where its figures come from");
    return s;
  }();
  return section;
}

/// Takes over the preset that the table names. Returns its name, empty without one.
std::string start_from_preset(const Node& table, const std::vector<Material>& presets, MaterialKeys& keys, Faults& faults) {
  const Node* node = table.find("preset");
  const auto* word = node ? std::get_if<std::string>(&node->content) : nullptr;
  if (!word) return "";  // one of a wrong type is told with the other keys
  const Material* preset = find_material(presets, *word);
  if (!preset) {
    faults.add(node->place, fmt::format("there is no shipped material '{}', expected one of `thicket materials`{}", *word, did_you_mean(*word, names_of(presets))));
    return "";
  }
  keys.material = *preset;
  if (table.table()->size() > 1) keys.material.source = fmt::format("changed from {}: {}", *word, preset->source);
  if (const auto& d = preset->dielectric) {
    keys.permittivity = d->a;
    keys.permittivity_exponent = d->b;
    keys.conductivity = d->c;
    keys.conductivity_exponent = d->d;
  }
  return *word;
}

}  // namespace

double conductivity(const Dielectric& dielectric, double frequency_ghz) { return dielectric.c * std::pow(frequency_ghz, dielectric.d); }

std::complex<double> permittivity(const Dielectric& dielectric, double frequency_ghz) {
  return {dielectric.a * std::pow(frequency_ghz, dielectric.b), -conductivity(dielectric, frequency_ghz) / (angular_frequency(frequency_ghz) * vacuum_permittivity)};
}

Material at_frequency(const Material& material, double frequency_ghz) {
  Material there = material;
  if (!material.depends_on_frequency()) return there;
  if (material.dielectric) {
    const RadarNumbers numbers = numbers_of(*material.dielectric, frequency_ghz);
    there.reflectivity = numbers.reflectivity;
    there.attenuation_db_per_m = numbers.attenuation_db_per_m;
  } else {
    there.attenuation_db_per_m *= std::pow(frequency_ghz, material.attenuation_exponent);
  }
  there.dielectric.reset();
  there.attenuation_exponent = 0.0;
  return there;
}

std::vector<Material> at_frequency(const std::vector<Material>& materials, double frequency_ghz) {
  std::vector<Material> list;
  list.reserve(materials.size());
  for (const Material& material : materials) list.push_back(at_frequency(material, frequency_ghz));
  return list;
}

Slab slab(const Material& material, double frequency_ghz, double thickness_m, double incidence) {
  if (material.dielectric) return slab_of(*material.dielectric, frequency_ghz, thickness_m, incidence);
  return slab_of_powers(at_frequency(material, frequency_ghz), thickness_m, incidence);
}

Material read_material(const std::string& name, const Node& table, const std::vector<Material>& presets, Faults& faults) {
  MaterialKeys keys;
  const std::string preset = table.table() ? start_from_preset(table, presets, keys, faults) : "";
  read_section(table, material_section(), &keys, faults);
  Material& material = keys.material;
  material.name = name;
  if (keys.permittivity) {
    material.dielectric = {*keys.permittivity, keys.permittivity_exponent.value_or(0.0), keys.conductivity.value_or(0.0), keys.conductivity_exponent.value_or(0.0)};
    const std::string whose = table.find("permittivity") ? "this table" : fmt::format("the preset '{}'", preset);
    for (const char* key : {"reflectivity", "attenuation_db_per_m", "attenuation_exponent"})
      if (const Node* node = table.find(key))
        faults.add(node->key_place, fmt::format("'{}' would follow from the permittivity of {}, expected only one of the two", key, whose));
    const RadarNumbers at_1_ghz = numbers_of(*material.dielectric, 1.0);
    material.reflectivity = at_1_ghz.reflectivity;
    material.attenuation_db_per_m = at_1_ghz.attenuation_db_per_m;
    material.attenuation_exponent = 0.0;
  } else if (!table.find("permittivity") && (!preset.empty() || !table.find("preset"))) {  // else what is wrong is told already
    for (const char* key : {"permittivity_exponent", "conductivity_s_per_m", "conductivity_exponent"})
      if (const Node* node = table.find(key)) faults.add(node->key_place, fmt::format("'{}' stands without a permittivity, expected the key 'permittivity' beside it", key));
  }
  return material;
}

std::string write_material(const Material& material) {
  MaterialKeys keys;
  keys.material = material;
  if (const auto& d = material.dielectric) {
    keys.permittivity = d->a;
    keys.permittivity_exponent = d->b;
    keys.conductivity = d->c;
    keys.conductivity_exponent = d->d;
  }
  std::string text;
  for (const Key& key : material_section().keys) {
    const bool follows = key.name == "reflectivity" || key.name == "attenuation_db_per_m" || key.name == "attenuation_exponent";  // from a permittivity
    const Value value = key.get(&keys);
    if (std::holds_alternative<std::monostate>(value) || (follows && material.dielectric)) continue;
    text += fmt::format("{} = {}\n", key.name, to_toml(value));
  }
  return text;
}

const Material* find_material(const std::vector<Material>& materials, const std::string& name) {
  const auto found = std::find_if(materials.begin(), materials.end(), [&name](const Material& m) { return m.name == name; });
  return found == materials.end() ? nullptr : &*found;
}

std::vector<std::string> names_of(const std::vector<Material>& materials) {
  std::vector<std::string> names;
  for (const Material& material : materials) names.push_back(material.name);
  return names;
}

std::string describe_material_table(bool markdown) {
  const MaterialKeys defaults;
  return markdown ? describe_section_in_markdown(material_section(), &defaults) : describe_section(material_section(), &defaults);
}

Result<std::vector<Material>> material_presets() {
  const auto document = read_document(shipped_root() / "worlds" / "presets" / "materials.toml");
  if (!document) return document.error();
  Faults faults;
  std::vector<Material> list;
  const Node* materials = document->find("material");
  if (const auto* table = materials ? materials->table() : nullptr)
    for (const auto& [name, entry] : *table) list.push_back(read_material(name, entry, {}, faults));
  if (list.empty()) faults.add(document->place, "holds no materials, expected tables [material.NAME]");
  if (!faults.none()) return faults.error();
  return list;
}

}  // namespace thicket
