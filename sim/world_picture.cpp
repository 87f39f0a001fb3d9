#include "thicket/sim/world_picture.hpp"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "canvas.hpp"

namespace thicket {
namespace {

using Vector = glm::dvec3;

bool is_slab(const Solid& solid) { return (solid.name == "floor" || solid.name == "ceiling") && std::holds_alternative<Box>(solid.shape); }

std::array<Vector, 8> corners_of(const Bounds& box) {
  std::array<Vector, 8> corners;
  for (std::size_t i = 0; i < 8; ++i) corners[i] = {i & 1 ? box.high.x : box.low.x, i & 2 ? box.high.y : box.low.y, i & 4 ? box.high.z : box.low.z};
  return corners;
}

bool is_called(const Solid& solid, const std::string& name) {
  return solid.name == name || solid.name.starts_with(name + " ") || solid.name.starts_with(name + "/");
}

std::optional<Error> fault_of(const PictureView& view) {
  if (!(view.fov_deg >= 1.0 && view.fov_deg <= 150.0)) return Error{fmt::format("the opening of the picture is {} degrees, expected 1 to 150", view.fov_deg)};
  if (view.width < 1 || view.height < 1 || view.width > largest_picture_side || view.height > largest_picture_side)
    return Error{fmt::format("the picture has {} x {} pixels, expected 1 to {} each", view.width, view.height, largest_picture_side)};
  for (const auto& point : {view.from, view.at})
    if (point && !std::islessequal(glm::length(*point), 1e10)) return Error{"the camera, or what it looks at, is farther than 1e10 m, expected finite metres"};
  if (view.from && view.at && *view.from == *view.at) return Error{"the camera is at the point that it looks at, expected two different points"};
  return std::nullopt;
}

}  // namespace

PictureCamera::PictureCamera(const PictureView& view) : from(*view.from), forward(glm::normalize(*view.at - *view.from)) {
  const Vector above = std::abs(forward.z) > 0.9999 ? Vector(0.0, 1.0, 0.0) : Vector(0.0, 0.0, 1.0);
  right = glm::normalize(glm::cross(forward, above));
  up = glm::cross(right, forward);
  half_width = std::tan(0.5 * view.fov_deg * std::numbers::pi / 180.0);
  half_height = half_width * view.height / view.width;
}

glm::dvec3 PictureCamera::direction(double u, double v) const { return glm::normalize(forward + u * half_width * right + v * half_height * up); }

glm::dvec3 PictureCamera::seen(const glm::dvec3& point) const {
  const Vector c = point - from;
  const double ahead = glm::dot(c, forward);
  return {glm::dot(c, right) / (ahead * half_width), glm::dot(c, up) / (ahead * half_height), ahead};
}

Bounds picture_subject(const World& world) {
  std::optional<Bounds> box;
  for (const Solid& solid : world.solids) {
    if (is_slab(solid)) continue;
    const Bounds one = extent(solid);
    box = box ? join(*box, one) : one;
  }
  if (!box) {
    const auto all = extent(world);
    box = all ? *all : Bounds{Vector(-1.0), Vector(1.0)};
  }
  if (const auto& stated = world.bounds) {
    box->low = {stated->x, stated->y, box->low.z};
    box->high = {stated->z, stated->w, box->high.z};
  }
  return *box;
}

Result<std::vector<bool>> hidden_solids(const World& world, const PictureView& view) {
  std::vector<bool> hidden(world.solids.size(), false);
  for (const std::string& name : view.hide) {
    bool found = false;
    for (std::size_t i = 0; i < world.solids.size(); ++i)
      if (is_called(world.solids[i], name)) hidden[i] = found = true;
    if (!found) return Error{fmt::format("there is no solid '{}' to hide in '{}', expected the name of one", name, world.name)};
  }
  for (std::size_t i = 0; i < world.solids.size(); ++i)
    if (world.solids[i].name == "ceiling" && is_slab(world.solids[i]) && view.from->z > extent(world.solids[i]).low.z) hidden[i] = true;
  return hidden;
}

Result<Scene> without(const Scene& scene, const std::vector<bool>& hidden) {
  if (std::find(hidden.begin(), hidden.end(), true) == hidden.end()) return Scene(scene);
  World world = scene.world();
  std::vector<Solid> kept;
  for (std::size_t i = 0; i < world.solids.size(); ++i)
    if (!hidden[i]) kept.push_back(std::move(world.solids[i]));
  world.solids = std::move(kept);
  auto rest = Scene::build(std::move(world));
  if (rest) rest->set_time(scene.time());
  return rest;
}

PictureView fitted(const World& world, const PictureView& view) {
  PictureView full = view;
  const Bounds box = picture_subject(world);
  if (!full.at) full.at = 0.5 * (box.low + box.high);
  if (full.from) {
    if (*full.from == *full.at) full.at = *full.from + Vector(1.0, 0.0, 0.0);  // a camera in the very middle looks east
    return full;
  }
  const Vector back = glm::normalize(Vector(-0.56, -0.83, 0.70));
  PictureView there = full;
  there.from = *full.at + back;
  const PictureCamera camera(there);
  double distance = 0.1;
  // As near as all corners allow; then what they take of the picture is moved to its middle, and again.
  for (int round = 0; round < 6; ++round) {
    distance = 0.1;
    glm::dvec2 low(infinity), high(-infinity);
    for (const Vector& corner : corners_of(box)) {
      const Vector c = corner - *full.at;
      const double aside = std::max(std::abs(glm::dot(c, camera.right)) / camera.half_width, std::abs(glm::dot(c, camera.up)) / camera.half_height);
      distance = std::max(distance, 1.04 * aside - glm::dot(c, camera.forward));
    }
    if (view.at) break;
    for (const Vector& corner : corners_of(box)) {
      const Vector c = corner - *full.at;
      const glm::dvec2 seen = glm::dvec2(glm::dot(c, camera.right), glm::dot(c, camera.up)) / (distance + glm::dot(c, camera.forward));
      low = glm::min(low, seen);
      high = glm::max(high, seen);
    }
    if (round == 5) break;
    const glm::dvec2 off = 0.5 * (low + high) * distance;
    *full.at += off.x * camera.right + off.y * camera.up;
  }
  full.from = *full.at + distance * back;
  return full;
}

Result<Done> draw_world_pixels(const Scene& scene, const PictureView& wanted, int samples, std::vector<std::uint32_t>& pixels, std::vector<float>* depth) {
  if (const auto fault = fault_of(wanted)) return *fault;
  if (samples != 1 && samples != 4) return Error{fmt::format("{} rays a pixel, expected 1 or 4", samples)};
  const World standing = world_at(scene.world(), scene.time());
  const PictureView view = fitted(standing, wanted);
  const auto hidden = hidden_solids(standing, view);
  if (!hidden) return hidden.error();
  auto shown = without(scene, *hidden);
  if (!shown) return shown.error();

  const WorldPainter painter(std::move(*shown), view, picture_subject(standing));
  const auto width = static_cast<std::size_t>(view.width), count = width * static_cast<std::size_t>(view.height);
  pixels.resize(count);
  if (depth) depth->resize(count);
  tbb::parallel_for(0, view.height, [&](int row) {
    const std::size_t first = static_cast<std::size_t>(row) * width;
    painter.paint_row(row, samples, pixels.data() + first);
    if (depth) painter.measure_row(row, depth->data() + first);
  });
  return Done{};
}

Result<Done> draw_world(const Scene& scene, const PictureView& view, const std::filesystem::path& file) {
  std::vector<std::uint32_t> pixels;
  if (auto drawn = draw_world_pixels(scene, view, 4, pixels, nullptr); !drawn) return drawn;
  Canvas canvas(view.width, view.height, {});
  canvas.image(pixels, view.width, view.height, {0.0, 0.0}, 1.0);
  return canvas.write(file);
}

}  // namespace thicket
