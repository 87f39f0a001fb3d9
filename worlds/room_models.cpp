// The things of a cluttered room (Billdal 2018, figure 6.11, names them and prints no sizes). Forms and sizes are ours.
#include <cmath>
#include <numbers>

#include "model_shapes.hpp"

namespace thicket {
namespace {

const char* side_name(double side) { return side > 0.0 ? "left" : "right"; }

/// A wheel whose axle lies along y: a tyre, and a rim that stands out of it a little.
void add_wheel(ModelBuilder& model, const glm::dvec3& middle, double radius, double width) {
  const glm::dvec3 half(0.0, 0.5 * width, 0.0), rim(0.0, 0.5 * width + 0.005, 0.0);
  model.cylinder("tyre", "rubber", middle - half, middle + half, radius);
  model.cylinder("rim", "metal", middle - rim, middle + rim, 0.6 * radius, 12);
}

/// A regular polygon in the plane, with a flat side on top.
std::vector<glm::dvec2> regular(int corners, double across_flats) {
  std::vector<glm::dvec2> outline;
  const double radius = 0.5 * across_flats / std::cos(std::numbers::pi / corners);
  for (int i = 0; i < corners; ++i) {
    const double angle = 2.0 * std::numbers::pi * (i + 0.5) / corners;
    outline.emplace_back(radius * std::cos(angle), radius * std::sin(angle));
  }
  return outline;
}

std::vector<glm::dvec2> raised(std::vector<glm::dvec2> outline, double by) {
  for (glm::dvec2& p : outline) p.y += by;
  return outline;
}

}  // namespace

Model make_car() {
  ModelBuilder car("car", "a small car, 4.2 x 1.7 x 1.46 m");
  car.drawn_along_y("body", "metal", {{-2.08, 0.28}, {1.95, 0.28}, {2.1, 0.4}, {2.08, 0.66}, {1.85, 0.8}, {0.95, 0.92}, {-1.75, 0.95}, {-2.05, 0.9}, {-2.1, 0.5}}, -0.85, 0.85);
  car.drawn_along_y("roof", "metal", {{-1.3, 1.4}, {0.1, 1.4}, {0.0, 1.46}, {-1.2, 1.46}}, -0.72, 0.72);
  car.drawn_along_y("windscreen", "glass", {{0.9, 0.92}, {0.905, 0.92}, {0.105, 1.4}, {0.1, 1.4}}, -0.7, 0.7);
  car.drawn_along_y("rear window", "glass", {{-1.705, 0.945}, {-1.7, 0.945}, {-1.295, 1.4}, {-1.3, 1.4}}, -0.7, 0.7);
  for (const double side : {-1.0, 1.0}) {
    car.drawn_along_y(std::string(side_name(side)) + " windows", "glass", {{-1.6, 0.945}, {0.8, 0.92}, {0.08, 1.4}, {-1.25, 1.4}}, side * 0.72 - 0.0025, side * 0.72 + 0.0025);
    car.limb(std::string(side_name(side)) + " front pillar", "metal", {0.92, side * 0.74, 0.9}, {0.08, side * 0.7, 1.43}, 0.04, 0.03, 6);
    car.limb(std::string(side_name(side)) + " middle pillar", "metal", {-0.35, side * 0.75, 0.9}, {-0.4, side * 0.7, 1.43}, 0.05, 0.04, 6);
    car.limb(std::string(side_name(side)) + " rear pillar", "metal", {-1.72, side * 0.74, 0.9}, {-1.28, side * 0.7, 1.43}, 0.07, 0.05, 6);
    car.box(std::string(side_name(side)) + " mirror", "plastic", {0.7, side * 0.93, 0.98}, {0.08, 0.16, 0.12});
    for (const double place : {-1.3, 1.3}) add_wheel(car, {place, side * 0.77, 0.31}, 0.31, 0.2);
  }
  car.box("front bumper", "plastic", {2.08, 0.0, 0.42}, {0.12, 1.6, 0.2});
  car.box("rear bumper", "plastic", {-2.08, 0.0, 0.45}, {0.12, 1.6, 0.2});
  return car.take();
}

Model make_control_panel() {
  ModelBuilder panel("control_panel", "a console with a sloping desk and a screen, 0.65 x 1.2 x 1.35 m; it looks along x");
  panel.drawn_along_y("cabinet", "metal", {{-0.3, 0.0}, {0.2, 0.0}, {0.25, 0.1}, {0.3, 0.75}, {-0.05, 0.92}, {-0.05, 1.35}, {-0.3, 1.35}}, -0.6, 0.6);
  panel.box("screen", "glass", {-0.046, 0.0, 1.14}, {0.008, 0.9, 0.34});
  const glm::dmat3 slope = pitched(std::atan2(0.17, 0.35) * 180.0 / std::numbers::pi);  // of the desk
  for (int column = -3; column <= 3; ++column)
    for (int row = 0; row < 2; ++row) panel.box("button", "plastic", glm::dvec3(0.125, 0.14 * column, 0.835) + slope * glm::dvec3(-0.09 + 0.14 * row, 0.0, 0.01), {0.05, 0.05, 0.03}, slope);
  panel.cylinder("lever", "metal", {0.12, 0.52, 0.82}, {0.14, 0.52, 1.0}, 0.012, 8);
  panel.ellipsoid("knob", "plastic", {0.141, 0.52, 1.01}, glm::dvec3(0.03), 6, 8);
  return panel.take();
}

Model make_dumpster() {
  ModelBuilder dumpster("dumpster", "a container for waste on castors, 1.2 x 1.9 x 1.35 m, empty, its two lids shut");
  constexpr double t = 0.004;  // sheet steel
  const std::vector<glm::dvec2> end = {{-0.5, 0.2}, {0.5, 0.2}, {0.6, 1.1}, {-0.6, 1.3}};
  dumpster.block("bottom", "metal", {-0.5, -0.9, 0.2}, {0.5, 0.9, 0.2 + t});
  for (const double side : {-1.0, 1.0}) dumpster.drawn_along_y(std::string(side_name(side)) + " end", "metal", end, side * 0.9 - 0.5 * t, side * 0.9 + 0.5 * t);
  dumpster.drawn_along_y("front", "metal", {{0.5, 0.2}, {0.5 + t, 0.2}, {0.6 + t, 1.1}, {0.6, 1.1}}, -0.9, 0.9);
  dumpster.drawn_along_y("back", "metal", {{-0.5 - t, 0.2}, {-0.5, 0.2}, {-0.6, 1.3}, {-0.6 - t, 1.3}}, -0.9, 0.9);
  for (const double side : {-1.0, 1.0}) {
    dumpster.drawn_along_y(std::string(side_name(side)) + " lid", "plastic", {{-0.62, 1.31}, {0.63, 1.1}, {0.63, 1.13}, {-0.62, 1.35}}, side > 0.0 ? 0.01 : -0.92, side > 0.0 ? 0.92 : -0.01);
    dumpster.box(std::string(side_name(side)) + " pocket of the fork", "metal", {0.0, side * 0.94, 0.85}, {0.9, 0.08, 0.14});
    for (const double place : {-0.4, 0.4}) {
      dumpster.cylinder("castor", "rubber", {place, side * 0.7 - 0.03, 0.09}, {place, side * 0.7 + 0.03, 0.09}, 0.09, 12);
      dumpster.box("fork of the castor", "metal", {place, side * 0.7, 0.15}, {0.06, 0.08, 0.12});
    }
  }
  dumpster.box("rail in front", "metal", {0.62, 0.0, 1.07}, {0.05, 1.84, 0.06});
  return dumpster.take();
}

Model make_human() {
  ModelBuilder human("human", "a person who stands with the arms a little apart, 1.76 m; it looks along x");
  human.ellipsoid("head", "skin", {0.01, 0.0, 1.64}, {0.1, 0.08, 0.12}, 8, 12);
  human.cylinder("neck", "skin", {0.0, 0.0, 1.42}, {0.0, 0.0, 1.56}, 0.055, 10);
  human.ellipsoid("chest", "skin", {0.0, 0.0, 1.25}, {0.13, 0.2, 0.24}, 8, 12);
  human.ellipsoid("belly and hips", "skin", {0.0, 0.0, 0.98}, {0.125, 0.18, 0.2}, 8, 12);
  for (const double side : {-1.0, 1.0}) {
    const std::string name = side_name(side);
    human.ellipsoid(name + " shoulder", "skin", {0.0, side * 0.19, 1.38}, {0.065, 0.075, 0.075});
    human.limb(name + " upper arm", "skin", {0.0, side * 0.21, 1.38}, {-0.01, side * 0.29, 1.09}, 0.05, 0.042, 10);
    human.limb(name + " forearm", "skin", {-0.01, side * 0.29, 1.09}, {0.04, side * 0.34, 0.84}, 0.042, 0.03, 10);
    human.ellipsoid(name + " hand", "skin", {0.05, side * 0.35, 0.77}, {0.035, 0.02, 0.09});
    human.limb(name + " thigh", "skin", {0.0, side * 0.09, 0.92}, {0.01, side * 0.11, 0.48}, 0.085, 0.058, 10);
    human.limb(name + " calf", "skin", {0.01, side * 0.11, 0.48}, {-0.02, side * 0.12, 0.07}, 0.058, 0.04, 10);
    human.ellipsoid(name + " foot", "skin", {0.05, side * 0.125, 0.045}, {0.13, 0.045, 0.045});
  }
  return human.take();
}

Model make_postbox() {
  ModelBuilder postbox("postbox", "a postbox with a round top on a foot, 0.36 x 0.42 x 1.3 m; its slot looks along x");
  std::vector<glm::dvec2> outline = {{-0.2, 0.45}, {0.2, 0.45}};
  for (int i = 0; i <= 10; ++i) {
    const double angle = std::numbers::pi * i / 10;
    outline.emplace_back(0.2 * std::cos(angle), 1.1 + 0.2 * std::sin(angle));
  }
  postbox.drawn_along_x("cabinet", "metal", outline, -0.17, 0.17);
  postbox.box("hood of the slot", "metal", {0.18, 0.0, 1.12}, {0.06, 0.3, 0.03}, pitched(25.0));
  postbox.box("door", "metal", {0.1725, 0.0, 0.75}, {0.007, 0.32, 0.4});
  postbox.cylinder("lock", "metal", {0.17, 0.11, 0.78}, {0.185, 0.11, 0.78}, 0.015, 8);
  postbox.cylinder("post", "metal", {0.0, 0.0, 0.015}, {0.0, 0.0, 0.46}, 0.05, 12);
  postbox.box("foot", "metal", {0.0, 0.0, 0.01}, {0.34, 0.34, 0.02});
  return postbox.take();
}

Model make_robot() {
  ModelBuilder robot("robot", "a service robot with four wheels, a column, a head and an arm, 0.6 x 0.56 x 1.25 m; it looks along x");
  robot.drawn_along_y("base", "metal", {{-0.3, 0.08}, {0.3, 0.08}, {0.3, 0.22}, {0.2, 0.3}, {-0.25, 0.3}, {-0.3, 0.25}}, -0.2, 0.2);
  for (const double side : {-1.0, 1.0})
    for (const double place : {-0.19, 0.19}) add_wheel(robot, {place, side * 0.235, 0.11}, 0.11, 0.07);
  robot.box("column", "metal", {-0.08, 0.0, 0.66}, {0.16, 0.2, 0.74});
  robot.ellipsoid("shoulders", "plastic", {-0.06, 0.0, 0.95}, {0.14, 0.2, 0.1}, 6, 12);
  robot.cylinder("neck", "metal", {-0.06, 0.0, 1.0}, {-0.06, 0.0, 1.08}, 0.035, 8);
  robot.box("head", "plastic", {-0.05, 0.0, 1.16}, {0.18, 0.24, 0.18});
  for (const double side : {-1.0, 1.0}) robot.cylinder(std::string(side_name(side)) + " eye", "glass", {0.03, side * 0.06, 1.18}, {0.055, side * 0.06, 1.18}, 0.03, 10);
  robot.limb("upper arm", "metal", {-0.05, -0.22, 0.93}, {0.05, -0.25, 0.68}, 0.045, 0.04, 8);
  robot.limb("forearm", "metal", {0.05, -0.25, 0.68}, {0.28, -0.22, 0.72}, 0.04, 0.03, 8);
  for (const double side : {-1.0, 1.0}) robot.box(std::string(side_name(side)) + " finger", "metal", {0.33, -0.22 + side * 0.025, 0.725}, {0.12, 0.012, 0.03});
  robot.cylinder("turning scanner", "plastic", {0.18, 0.0, 0.29}, {0.18, 0.0, 0.37}, 0.05, 12);
  return robot.take();
}

Model make_stop_sign() {
  ModelBuilder sign("stop_sign", "a stop sign, 0.75 m across its flats on a pipe of 2.25 m; it looks along x");
  sign.cylinder("pipe", "metal", {0.0, 0.0, 0.0}, {0.0, 0.0, 2.25}, 0.03, 12);
  sign.drawn_along_x("plate", "metal", raised(regular(8, 0.75), 1.85), 0.035, 0.038);
  for (const double height : {1.7, 2.0}) sign.box("clamp", "metal", {0.015, 0.0, height}, {0.045, 0.1, 0.03});
  sign.box("foot", "metal", {0.0, 0.0, 0.02}, {0.3, 0.3, 0.04});
  return sign.take();
}

}  // namespace thicket
