// The hold of a river barge, and models as text.
#include "thicket/worlds/models.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "model_shapes.hpp"

namespace thicket {
namespace {

constexpr double most_members = 1e4;

/// The places of members between two ends, evenly, at most `spacing` apart; none stands at an end.
std::vector<double> between(double low, double high, double spacing) {
  const int gaps = std::max(1, static_cast<int>(std::ceil((high - low) / spacing - 1e-9)));
  std::vector<double> places;
  for (int i = 1; i < gaps; ++i) places.push_back(low + (high - low) * i / gaps);
  return places;
}

void add_plates(ModelBuilder& hold, const HoldSpec& s) {
  const double x = 0.5 * s.length, y = 0.5 * s.breadth, t = s.plate;
  hold.block("tank top", "metal", {-x - t, -y - t, -t}, {x + t, y + t, 0.0});
  for (const double side : {-1.0, 1.0}) {
    hold.box("side wall", "metal", {0.0, side * (y + 0.5 * t), 0.5 * s.depth}, {s.length + 2.0 * t, t, s.depth});
    hold.box("bulkhead", "metal", {side * (x + 0.5 * t), 0.0, 0.5 * s.depth}, {t, s.breadth, s.depth});
    hold.box("deck beside", "metal", {0.0, side * (y + t + 0.5 * s.deck_width), s.depth - 0.5 * t}, {s.length + 2.0 * (t + s.deck_width), s.deck_width, t});
    hold.box("deck at the end", "metal", {side * (x + t + 0.5 * s.deck_width), 0.0, s.depth - 0.5 * t}, {s.deck_width, s.breadth + 2.0 * t, t});
  }
}

void add_members(ModelBuilder& hold, const HoldSpec& s) {
  const double x = 0.5 * s.length, y = 0.5 * s.breadth, t = s.plate;
  for (const double side : {-1.0, 1.0}) {
    for (const double place : between(-x, x, s.frame_spacing)) {
      hold.box("web frame", "metal", {place, side * (y - 0.5 * s.frame_depth), 0.5 * s.depth}, {t, s.frame_depth, s.depth});
      hold.box("flange", "metal", {place, side * (y - s.frame_depth - 0.5 * t), 0.5 * s.depth}, {s.flange_width, t, s.depth});
    }
    for (const double height : between(0.0, s.depth, s.stiffener_spacing)) hold.box("stiffener", "metal", {0.0, side * (y - 0.5 * s.stiffener_depth), height}, {s.length, s.stiffener_depth, t});
    for (const double place : between(-y, y, s.stiffener_spacing)) hold.box("upright stiffener", "metal", {side * (x - 0.5 * s.stiffener_depth), place, 0.5 * s.depth}, {s.stiffener_depth, t, s.depth});
  }
}

struct Colour {
  const char* material;
  const char* text;
};
// Colours are for other programs; of an MTL file Thicket takes the names and the dissolve d.
constexpr std::array<Colour, 5> colours = {{{"metal", "Kd 0.55 0.58 0.62\nd 1"}, {"glass", "Kd 0.7 0.8 0.9\nd 0.3"}, {"rubber", "Kd 0.1 0.1 0.1\nd 1"}, {"skin", "Kd 0.8 0.6 0.5\nd 1"}, {"plastic", "Kd 0.2 0.4 0.25\nd 1"}}};

std::vector<std::string> materials_of(const Model& model) {
  std::vector<std::string> names;
  for (const ModelPart& part : model.parts)
    if (std::ranges::find(names, part.material) == names.end()) names.push_back(part.material);
  return names;
}

/// A coordinate to a tenth of a millimetre; a zero without a sign.
double rounded(double metres) { return std::round(metres * 1e4) / 1e4 + 0.0; }

}  // namespace

std::optional<std::string> hold_fault(const HoldSpec& s) {
  const std::pair<const char*, double> sizes[] = {{"length", s.length}, {"breadth", s.breadth}, {"depth", s.depth}, {"plate", s.plate}, {"frame spacing", s.frame_spacing}, {"frame depth", s.frame_depth},
                                                  {"flange width", s.flange_width}, {"stiffener spacing", s.stiffener_spacing}, {"stiffener depth", s.stiffener_depth}, {"deck width", s.deck_width}};
  for (const auto& [name, metres] : sizes)
    if (!(metres > 0.0) || !std::isfinite(metres)) return fmt::format("the hold's {} is {} m, expected a finite number greater than 0", name, metres);
  if (s.plate < 1e-3) return fmt::format("the hold's plate is {} m, expected at least 0.001 (the file is written to a tenth of a millimetre)", s.plate);
  if (2.0 * (s.frame_depth + s.plate) >= s.breadth) return fmt::format("frames of {} m meet in a hold of {} m breadth, expected less than half of it", s.frame_depth, s.breadth);
  if (2.0 * s.stiffener_depth >= std::min(s.breadth, s.length)) return fmt::format("stiffeners of {} m meet in a hold of {} x {} m, expected less than half of it", s.stiffener_depth, s.length, s.breadth);
  if (s.flange_width + s.plate >= s.frame_spacing) return fmt::format("flanges of {} m stand every {} m, expected them to be narrower than that", s.flange_width, s.frame_spacing);
  if (s.plate >= s.stiffener_spacing) return fmt::format("stiffeners stand every {} m, expected more than their thickness of {} m", s.stiffener_spacing, s.plate);
  const double members = s.length / s.frame_spacing + (s.depth + s.breadth) / s.stiffener_spacing;
  if (members > most_members) return fmt::format("the hold has about {:.0f} frames and stiffeners a side, expected at most {:.0f}", members, most_members);
  return std::nullopt;
}

Model make_hold(const HoldSpec& spec) {
  ModelBuilder hold("hold", fmt::format("the hold of a river barge, {} x {} x {} m inside, of {} m plate, with web frames of {} m and stiffeners of {} m", spec.length, spec.breadth, spec.depth, spec.plate, spec.frame_depth,
                                        spec.stiffener_depth));
  add_plates(hold, spec);
  add_members(hold, spec);
  return hold.take();
}

const std::vector<std::string>& model_names() {
  static const std::vector<std::string> names = {"hold", "car", "control_panel", "dumpster", "human", "postbox", "robot", "stop_sign"};
  return names;
}

std::optional<Model> make_model(const std::string& name) {
  if (name == "hold") return make_hold({});
  if (name == "car") return make_car();
  if (name == "control_panel") return make_control_panel();
  if (name == "dumpster") return make_dumpster();
  if (name == "human") return make_human();
  if (name == "postbox") return make_postbox();
  if (name == "robot") return make_robot();
  if (name == "stop_sign") return make_stop_sign();
  return std::nullopt;
}

std::string model_obj(const Model& model, const std::string& library) {
  std::string text = fmt::format("# Made by `thicket generate {}`: {}. z up, x forward, metres.\nmtllib {}\n", model.name, model.description, library);
  std::uint32_t first = 1;
  for (const std::string& material : materials_of(model)) {
    text += fmt::format("usemtl {}\n", material);
    for (const ModelPart& part : model.parts) {
      if (part.material != material) continue;
      text += fmt::format("g {}\n", part.name);
      for (const glm::dvec3& v : part.mesh->vertices) text += fmt::format("v {} {} {}\n", rounded(v.x), rounded(v.y), rounded(v.z));
      for (const glm::uvec3& t : part.mesh->triangles) text += fmt::format("f {} {} {}\n", first + t.x, first + t.y, first + t.z);
      first += static_cast<std::uint32_t>(part.mesh->vertices.size());
    }
  }
  return text;
}

std::string model_mtl(const Model& model) {
  std::string text = "# Colours are for other programs; of an MTL file Thicket takes the names and the dissolve d.\n";
  for (const std::string& material : materials_of(model)) {
    const auto colour = std::ranges::find_if(colours, [&](const Colour& c) { return material == c.material; });
    text += fmt::format("newmtl {}\n{}\n\n", material, colour == colours.end() ? "Kd 0.5 0.5 0.5\nd 1" : colour->text);
  }
  return text;
}

}  // namespace thicket
