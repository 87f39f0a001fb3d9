// `thicket picture`: what a world looks like.
#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <filesystem>

#include "program.hpp"
#include "thicket/base/files.hpp"
#include "thicket/sim/world_picture.hpp"

namespace thicket::cli {
namespace {

int complain(const Error& error) {
  fmt::print(stderr, "{}\n", error.message);
  return bad_input;
}

/// "1,-2,3" as three finite numbers.
std::optional<glm::dvec3> point_of(const std::string& text) {
  std::array<double, 3> values{};
  const char* at = text.data();
  const char* const end = at + text.size();
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (i > 0 && (at == end || *at++ != ',')) return std::nullopt;
    const auto [stop, failure] = std::from_chars(at, end, values[i]);
    if (failure != std::errc{} || !std::isfinite(values[i])) return std::nullopt;
    at = stop;
  }
  return at == end ? std::optional(glm::dvec3(values[0], values[1], values[2])) : std::nullopt;
}

/// "960x600"
bool read_size(const std::string& text, PictureView& view) {
  const char* const end = text.data() + text.size();
  const auto [cross, no_width] = std::from_chars(text.data(), end, view.width);
  if (no_width != std::errc{} || cross == end || *cross != 'x') return false;
  const auto [stop, no_height] = std::from_chars(cross + 1, end, view.height);
  return no_height == std::errc{} && stop == end;
}

Result<PictureView> view_of(const PictureArguments& a) {
  PictureView view;
  view.fov_deg = a.fov_deg;
  view.hide = a.hide;
  for (const auto& [flag, text, point] : {std::tuple{"--from", &a.from, &view.from}, std::tuple{"--at", &a.at, &view.at}}) {
    if (text->empty()) continue;
    *point = point_of(*text);
    if (!*point) return Error{fmt::format("{} is '{}', expected X,Y,Z in metres, for example -8,-12,9", flag, *text)};
  }
  if (!read_size(a.size, view)) return Error{fmt::format("--size is '{}', expected WIDTHxHEIGHT in pixels, for example 960x600", a.size)};
  return view;
}

}  // namespace

int draw_picture(const PictureArguments& a) {
  const auto view = view_of(a);
  if (!view) return complain(view.error());
  if (!std::isfinite(a.time)) return complain({fmt::format("--time is {}, expected seconds", a.time)});
  const std::filesystem::path out = a.out;
  if (out.extension() != ".png") return complain({fmt::format("--out is '{}', expected a name ending in .png", a.out)});
  const auto file = find_input(a.world);
  if (file.empty()) return complain({fmt::format("there is no world '{}'; shipped ones are listed by `thicket worlds`", a.world)});
  if (is_mission(file)) return complain({fmt::format("{}: this is a mission and not a world, expected a world file", file.string())});
  if (std::error_code none; std::filesystem::equivalent(out, file, none)) return complain({fmt::format("{}: would be overwritten while it is read, expected another name to write to", a.out)});
  MapOptions options;
  options.image = a.map_image;
  options.cell_size = a.cell_size;
  auto world = read_world(file, options);
  if (!world) return complain(world.error());
  auto scene = Scene::build(std::move(*world));
  if (!scene) return complain(scene.error());
  scene->set_time(a.time);
  if (const auto drawn = draw_world(*scene, *view, out); !drawn) return complain(drawn.error());
  const PictureView camera = fitted(world_at(scene->world(), a.time), *view);
  const glm::dvec3 from = *camera.from, at = *camera.at;
  fmt::print("camera     --from {:.2f},{:.2f},{:.2f} --at {:.2f},{:.2f},{:.2f}\nwritten    {}\n", from.x, from.y, from.z, at.x, at.y, at.z, a.out);
  return done;
}

}  // namespace thicket::cli
