// `thicket picture`: what a world looks like.
#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <cstdio>
#include <filesystem>

#include "program.hpp"
#include "thicket/sim/world_picture.hpp"

namespace thicket::cli {
namespace {

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
    const auto xyz = numbers<3>(*text);
    if (!xyz) return Error{fmt::format("{} is '{}', expected X,Y,Z in metres, for example -8,-12,9", flag, *text)};
    *point = glm::dvec3((*xyz)[0], (*xyz)[1], (*xyz)[2]);
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
  const auto file = find_world(a.world);
  if (!file) return complain(file.error());
  if (std::error_code none; std::filesystem::equivalent(out, *file, none)) return complain({fmt::format("{}: would be overwritten while it is read, expected another name to write to", a.out)});
  MapOptions options;
  options.image = a.map_image;
  options.cell_size = a.cell_size;
  auto world = read_world(*file, options);
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
