#include "picture_colours.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <string>
#include <string_view>

#include "thicket/sim/material_colour.hpp"

namespace thicket {
namespace {

struct Word {
  std::string_view word;
  glm::dvec3 display;
  double gloss = 0.0;
};

// The first word that a name has counts.
const Word words[] = {
    {"smoke", {0.72, 0.73, 0.75}},  {"fog", {0.86, 0.88, 0.90}},     {"dust", {0.80, 0.72, 0.58}},    {"rain", {0.62, 0.70, 0.80}},
    {"red", {0.78, 0.22, 0.18}, 0.3},    {"orange", {0.90, 0.50, 0.16}, 0.3}, {"yellow", {0.92, 0.75, 0.24}, 0.3}, {"blue", {0.20, 0.40, 0.66}, 0.3},
    {"white", {0.92, 0.92, 0.90}, 0.2},  {"black", {0.14, 0.14, 0.15}, 0.3},  {"violet", {0.48, 0.32, 0.60}, 0.3}, {"green", {0.30, 0.52, 0.28}, 0.2},
    {"leaf", {0.36, 0.54, 0.20}},   {"leaves", {0.36, 0.54, 0.20}},  {"foliage", {0.33, 0.50, 0.22}}, {"hedge", {0.28, 0.46, 0.20}},
    {"bush", {0.33, 0.50, 0.22}},   {"grass", {0.52, 0.62, 0.36}},   {"bark", {0.42, 0.32, 0.24}},    {"trunk", {0.42, 0.32, 0.24}},
    {"plywood", {0.76, 0.60, 0.40}}, {"chipboard", {0.72, 0.58, 0.40}}, {"wood", {0.56, 0.40, 0.26}}, {"timber", {0.56, 0.40, 0.26}},
    {"glass", {0.66, 0.82, 0.90}, 1.0},  {"window", {0.66, 0.82, 0.90}, 1.0}, {"water", {0.35, 0.55, 0.66}, 0.9}, {"mirror", {0.85, 0.88, 0.90}, 1.0},
    {"metal", {0.62, 0.65, 0.69}, 0.7},  {"steel", {0.56, 0.60, 0.65}, 0.7},  {"brick", {0.70, 0.42, 0.33}},   {"concrete", {0.74, 0.73, 0.70}},
    {"plaster", {0.90, 0.87, 0.81}}, {"ceiling", {0.92, 0.91, 0.88}}, {"absorber", {0.20, 0.24, 0.34}}, {"wall", {0.86, 0.81, 0.73}},
    {"stone", {0.68, 0.66, 0.62}},  {"rock", {0.60, 0.58, 0.55}},    {"sand", {0.86, 0.78, 0.60}},    {"soil", {0.52, 0.42, 0.32}},
    {"earth", {0.60, 0.52, 0.40}},  {"ground", {0.74, 0.70, 0.62}},  {"rubber", {0.20, 0.20, 0.21}},  {"person", {0.85, 0.45, 0.22}},
    {"skin", {0.85, 0.62, 0.50}},   {"box", {0.78, 0.62, 0.42}},     {"cardboard", {0.78, 0.62, 0.42}},
};

bool is_one_of(std::string_view name, std::initializer_list<std::string_view> parts) {
  return std::any_of(parts.begin(), parts.end(), [&](std::string_view part) { return name.find(part) != std::string_view::npos; });
}

/// A word of a colour is one only by itself: "red_paint", but not "shattered".
bool has_word(std::string_view name, std::string_view word) {
  const auto letter = [&](std::size_t i) { return i < name.size() && std::isalpha(static_cast<unsigned char>(name[i])) != 0; };
  for (std::size_t at = name.find(word); at != std::string_view::npos; at = name.find(word, at + 1))
    if (word != "red" || ((at == 0 || !letter(at - 1)) && !letter(at + word.size()))) return true;
  return false;
}

/// A calm colour of any hue.
glm::dvec3 hashed(std::string_view name) {
  std::uint64_t hash = 14695981039346656037u;  // FNV-1a
  for (const char c : name) hash = (hash ^ static_cast<unsigned char>(c)) * 1099511628211u;
  const double hue = static_cast<double>(hash >> 40 & 0xffffu) / 65536.0 * 6.0;
  const auto channel = [hue](double shift) {
    const double k = std::fmod(hue + shift, 6.0);
    return 0.72 - 0.30 * std::clamp(std::min(k, 4.0 - k), 0.0, 1.0);
  };
  return {channel(5.0), channel(3.0), channel(1.0)};
}

}  // namespace

glm::dvec3 to_linear(const glm::dvec3& display) { return {std::pow(display.x, 2.2), std::pow(display.y, 2.2), std::pow(display.z, 2.2)}; }

std::uint32_t to_pixel(const glm::dvec3& linear) {
  const auto channel = [](double light) { return static_cast<std::uint32_t>(std::lround(255.0 * std::pow(std::clamp(light, 0.0, 1.0), 1.0 / 2.2))); };
  return 0xff000000u | channel(linear.x) << 16 | channel(linear.y) << 8 | channel(linear.z);
}

Look look_of(const Material& material) {
  std::string name = material.name;
  std::transform(name.begin(), name.end(), name.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  Look look;
  const auto found = std::find_if(std::begin(words), std::end(words), [&](const Word& w) { return has_word(name, w.word); });
  look.colour = to_linear(found != std::end(words) ? found->display : !material.stops_motion ? glm::dvec3(0.75) : hashed(name));
  look.gloss = found != std::end(words) ? found->gloss : 0.6 * (1.0 - material.roughness);
  look.leafy = is_one_of(name, {"leaf", "leaves", "foliage", "grass"});
  if (!material.stops_motion || material.light_medium()) {
    look.kind = Look::Kind::medium;
    // As light has it, but never so thin that nothing is drawn, nor so thick that nothing is seen behind it.
    look.extinction = std::clamp(material.light_medium() ? material.light_extinction_per_m : 0.5, 0.08, 0.7);
  } else if (!material.stops_light) {
    look.kind = Look::Kind::pane;
  }
  return look;
}

MaterialColour material_colour(const Material& material) {
  const Look look = look_of(material);
  MaterialColour result;
  result.display = glm::dvec3(std::pow(look.colour.x, 1.0 / 2.2), std::pow(look.colour.y, 1.0 / 2.2), std::pow(look.colour.z, 1.0 / 2.2));
  result.penetrable = at_frequency(material, 24.0).attenuation_db_per_m < 50.0;
  return result;
}

}  // namespace thicket
