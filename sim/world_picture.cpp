#include "thicket/sim/world_picture.hpp"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <glm/common.hpp>
#include <glm/exponential.hpp>
#include <glm/geometric.hpp>

#include "canvas.hpp"
#include "picture_colours.hpp"

namespace thicket {
namespace {

using Vector = glm::dvec3;

constexpr int samples = 4;  // a pixel, 2 x 2
constexpr double darkest = 5.0;  // optical depth behind which nothing is drawn

bool is_slab(const Solid& solid) { return (solid.name == "floor" || solid.name == "ceiling") && std::holds_alternative<Box>(solid.shape); }

/// What the picture is about: the stated bounds, or the solids, without floor and ceiling.
Bounds subject(const World& world) {
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

struct Camera {
  Vector from, forward, right, up;
  double half_width, half_height;  // at distance 1

  Camera(const PictureView& view, const Vector& eye, const Vector& target) : from(eye), forward(glm::normalize(target - eye)) {
    const Vector above = std::abs(forward.z) > 0.9999 ? Vector(0.0, 1.0, 0.0) : Vector(0.0, 0.0, 1.0);
    right = glm::normalize(glm::cross(forward, above));
    up = glm::cross(right, forward);
    half_width = std::tan(0.5 * view.fov_deg * std::numbers::pi / 180.0);
    half_height = half_width * view.height / view.width;
  }

  /// u and v in -1...1, from the left and the bottom.
  Vector direction(double u, double v) const { return glm::normalize(forward + u * half_width * right + v * half_height * up); }
};

std::array<Vector, 8> corners_of(const Bounds& box) {
  std::array<Vector, 8> corners;
  for (std::size_t i = 0; i < 8; ++i) corners[i] = {i & 1 ? box.high.x : box.low.x, i & 2 ? box.high.y : box.low.y, i & 4 ? box.high.z : box.low.z};
  return corners;
}

/// Places of the sky that each ray of a pixel looks at from what it met: eight of a pixel, which is enough for a soft shade and has no grain.
constexpr std::size_t places = 2;
Vector place_of_sky(std::size_t sample, std::size_t place) {
  const std::size_t k = sample * places + place;
  const double azimuth = (static_cast<double>(k) + 0.5) * std::numbers::pi / 4.0, elevation = k % 2 ? 0.45 : 1.0;
  return {std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth), std::sin(elevation)};
}

// --- light

const Vector sun = glm::normalize(Vector(-0.72, -0.20, 0.74));
const Vector sun_light(1.02, 0.97, 0.88), sky_light(0.50, 0.55, 0.63), ground_light(0.30, 0.28, 0.25);

Vector sky(const Vector& direction) {
  static const Vector zenith = to_linear({0.45, 0.64, 0.86}), horizon = to_linear({0.90, 0.94, 0.97}), below = to_linear({0.80, 0.82, 0.83});
  const double z = direction.z;
  return z >= 0.0 ? glm::mix(horizon, zenith, std::pow(std::min(1.0, z * 1.6), 0.7)) : glm::mix(horizon, below, std::min(1.0, -3.0 * z));
}

/// Numbers of 0...1 by a hash.
double scattered(std::uint64_t n) {
  n ^= n >> 33;
  n *= 0xff51afd7ed558ccdu;
  n ^= n >> 33;
  n *= 0xc4ceb9fe1a85ec53u;
  n ^= n >> 33;
  return static_cast<double>(n >> 40) / 16777216.0;
}

/// A tint for each leaf of a mesh: leaves differ by their normals.
double tint_of(const Vector& normal) {
  const auto whole = [](double x) { return static_cast<std::uint64_t>(std::llround(std::abs(x) * 500.0)); };
  return scattered(whole(normal.x) * 1000003u + whole(normal.y) * 1009u + whole(normal.z));
}

// --- tracing

/// A surface that a ray ends at.
struct Surface {
  bool there = false;
  Vector point{0.0}, normal{0.0}, colour{0.0}, shadow_from{0.0};
  double range = infinity, facing_sun = 0.0, gloss = 0.0;
  double sunshine = 0.0, skylight = 1.0;  ///< what other matter leaves of them
};

/// What is in front of that surface: light of its own, and what is left of the light from behind.
struct Veil {
  Vector light{0.0};
  double left = 1.0;
};

class Painter {
 public:
  Painter(const Scene& scene, const Camera& camera, const PictureView& view, const Bounds& box)
      : scene_(scene), camera_(camera), view_(view), far_(3.0 * glm::distance(camera.from, 0.5 * (box.low + box.high)) + 2.0 * glm::distance(box.low, box.high)), reach_(0.25 * glm::distance(box.low, box.high)) {
    for (const Material& material : scene.world().materials) {
      const Look& look = looks_.emplace_back(look_of(material));
      losses_.push_back(look.kind == Look::Kind::solid ? infinity : look.extinction);
    }
    pixel_angle_ = 2.0 * camera.half_width / view.width;
  }

  void paint_row(int row, std::uint32_t* pixels) const {
    const auto count = static_cast<std::size_t>(view_.width) * samples;
    std::vector<Ray> rays(count);
    for (std::size_t i = 0; i < count; ++i) {
      const double x = static_cast<double>(i / samples) + (i & 1 ? 0.75 : 0.25), y = row + (i & 2 ? 0.75 : 0.25);
      rays[i] = {camera_.from, camera_.direction(2.0 * x / view_.width - 1.0, 1.0 - 2.0 * y / view_.height), infinity};
    }
    CrossingLists lists;
    scene_.crossings(rays, losses_, darkest, lists);
    std::vector<Surface> surfaces(count);
    std::vector<Veil> veils(count);
    for (std::size_t i = 0; i < count; ++i) look_along(rays[i], lists[i], surfaces[i], veils[i]);
    light_up(surfaces);
    for (std::size_t p = 0; p < static_cast<std::size_t>(view_.width); ++p) {
      Vector sum(0.0);
      for (std::size_t i = p * samples; i < (p + 1) * samples; ++i) sum += glm::min(veils[i].light + veils[i].left * light_of(rays[i].direction, surfaces[i]), Vector(1.0));
      pixels[p] = to_pixel(sum / static_cast<double>(samples));
    }
  }

 private:
  /// What of the sun and of the sky each surface sees.
  void light_up(std::vector<Surface>& surfaces) const {
    std::vector<Ray> rays;
    std::vector<std::size_t> of;
    CrossingLists lists;
    for (std::size_t i = 0; i < surfaces.size(); ++i) {
      if (!surfaces[i].there || surfaces[i].facing_sun <= 0.0) continue;
      of.push_back(i);
      rays.push_back({surfaces[i].shadow_from, towards_sun(i % samples), infinity});
    }
    scene_.crossings(rays, losses_, darkest, lists);
    for (std::size_t k = 0; k < of.size(); ++k) surfaces[of[k]].sunshine = passed(lists[k]);

    rays.clear();
    of.clear();
    for (std::size_t i = 0; i < surfaces.size(); ++i)
      for (std::size_t place = 0; surfaces[i].there && place < places; ++place) {
        const Vector direction = place_of_sky(i % samples, place);
        if (glm::dot(direction, surfaces[i].normal) <= 0.02) continue;
        of.push_back(i);
        rays.push_back({surfaces[i].point + 1e-6 * (1.0 + surfaces[i].range) * surfaces[i].normal, direction, reach_});
      }
    scene_.crossings(rays, losses_, darkest, lists);
    std::vector<double> seen(surfaces.size(), 0.0), asked(surfaces.size(), 0.0);
    for (std::size_t k = 0; k < of.size(); ++k) {
      const double weight = glm::dot(rays[k].direction, surfaces[of[k]].normal);
      // What is near takes more of the sky than what is far.
      const auto first = std::find_if(lists[k].begin(), lists[k].end(), [&](const Crossing& c) { return look(c).kind == Look::Kind::solid; });
      seen[of[k]] += weight * (first == lists[k].end() || first->enter >= reach_ ? 1.0 : 0.6 * first->enter / reach_);
      asked[of[k]] += weight;
    }
    for (std::size_t i = 0; i < surfaces.size(); ++i)
      if (asked[i] > 0.0) surfaces[i].skylight = seen[i] / asked[i];
  }

  /// The sun is not a point: each of a pixel's rays looks at another part of it.
  static Vector towards_sun(std::size_t sample) {
    static constexpr double spread = 0.012;
    return glm::normalize(sun + spread * Vector(sample & 1 ? 1.0 : -1.0, sample & 2 ? 1.0 : -1.0, 0.0));
  }

  const Look& look(const Crossing& c) const { return looks_[scene_.world().solids[c.solid].material]; }

  void look_along(const Ray& ray, std::span<const Crossing> list, Surface& surface, Veil& veil) const {
    for (const Crossing& c : list)
      if (look(c).kind == Look::Kind::solid) {
        surface = surface_at(ray, c);
        break;
      }
    for (const Crossing& c : list) {
      if (c.enter >= surface.range) break;
      const Look& there = look(c);
      if (there.kind == Look::Kind::medium) {
        const double share = 1.0 - std::exp(-there.extinction * (std::min(c.leave, surface.range) - c.enter));
        cover(veil, share, there.colour * (sky_light + 0.62 * sun_light));
      } else if (there.kind == Look::Kind::pane) {
        for (const auto& [range, normal] : {std::pair{c.enter, c.enter_normal}, std::pair{c.leave, c.leave_normal}}) {
          if (range >= surface.range || range <= 0.0) continue;
          // The reflection grows toward grazing, as Schlick (1994) has it.
          const double cosine = std::min(1.0, std::abs(glm::dot(normal, ray.direction)));
          cover(veil, 0.10 + 0.5 * std::pow(1.0 - cosine, 5.0), glm::mix(there.colour, sky(glm::reflect(ray.direction, normal)), 0.5));
        }
      }
    }
  }

  static void cover(Veil& veil, double share, const Vector& light) {
    veil.light += veil.left * share * light;
    veil.left *= 1.0 - share;
  }

  Surface surface_at(const Ray& ray, const Crossing& c) const {
    const Solid& solid = scene_.world().solids[c.solid];
    const Look& there = look(c);
    Surface s;
    s.there = true;
    s.range = c.enter;
    s.point = ray.origin + c.enter * ray.direction;
    s.normal = c.starts_inside ? -ray.direction : c.enter_normal;
    s.colour = there.colour;
    s.gloss = there.gloss;
    s.facing_sun = glm::dot(s.normal, sun);
    double lift = 1e-6 * (1.0 + c.enter);
    if (const auto* mesh = std::get_if<MeshSolid>(&solid.shape); mesh && !mesh->mesh->closed) {
      const double tint = tint_of(s.normal);
      if (there.leafy) s.colour *= Vector(0.72 + 0.75 * tint, 0.80 + 0.42 * tint, 0.75 + 0.3 * tint);
      if (there.leafy && s.facing_sun < 0.0) {  // light shines through it
        lift = -2.0 * mesh->sheet_thickness;
        s.facing_sun *= -0.6;
        s.colour *= Vector(1.05, 1.1, 0.6);
      }
    }
    s.shadow_from = s.point + lift * s.normal;
    if (solid.name == "floor" && s.normal.z > 0.99) s.colour *= 1.0 - 0.10 * line_share(s.point, c.enter, ray.direction);
    return s;
  }

  /// How much of a pixel's footprint on the floor belongs to lines a metre apart.
  double line_share(const Vector& point, double range, const Vector& direction) const {
    const double foot = pixel_angle_ * range / std::max(0.05, std::abs(direction.z)), width = 0.02;
    double share = 0.0;
    for (const double x : {point.x, point.y}) {
      const double off = std::abs(x - std::round(x));
      share = std::max(share, std::clamp((0.5 * (width + foot) - off) / foot, 0.0, 1.0) * std::min(1.0, width / foot));
    }
    return share;
  }

  double passed(std::span<const Crossing> list) const {
    double share = 1.0;
    for (const Crossing& c : list) {
      const Look& there = look(c);
      if (there.kind == Look::Kind::solid) return 0.0;
      share *= there.kind == Look::Kind::pane ? 0.8 : std::exp(-0.6 * there.extinction * (c.leave - c.enter));
    }
    return share;
  }

  Vector light_of(const Vector& direction, const Surface& s) const {
    if (!s.there) return sky(direction);
    const Vector around = glm::mix(ground_light, sky_light, 0.5 + 0.5 * s.normal.z);
    // A little of the side that faces the camera keeps what is in the shade from being flat.
    const double front = 0.82 + 0.18 * std::max(0.0, -glm::dot(direction, s.normal));
    Vector light = s.colour * (around * front * (0.35 + 0.65 * s.skylight) + s.sunshine * s.facing_sun * sun_light);
    if (s.gloss > 0.0) {
      const Vector mirrored = glm::reflect(direction, s.normal);
      const double rim = std::pow(1.0 - std::min(1.0, std::abs(glm::dot(direction, s.normal))), 5.0);
      light = glm::mix(light, mirrored.z > 0.0 ? sky(mirrored) : 0.6 * ground_light, s.gloss * (0.18 + 0.5 * rim));
      light += s.sunshine * s.gloss * 0.5 * std::pow(std::max(0.0, glm::dot(mirrored, sun)), 60.0) * sun_light;
    }
    const double haze = 1.0 - std::exp(-(s.range / far_) * (s.range / far_));
    return glm::mix(light, sky({direction.x, direction.y, 0.0}), haze);
  }

  const Scene& scene_;
  const Camera& camera_;
  const PictureView& view_;
  std::vector<double> losses_;  // of every material: optical depth a metre
  std::vector<Look> looks_;
  double far_, reach_, pixel_angle_ = 0.0;  // how far away haze begins, and how far a surface looks for what hides the sky
};

bool is_called(const Solid& solid, const std::string& name) {
  return solid.name == name || solid.name.starts_with(name + " ") || solid.name.starts_with(name + "/");
}

/// Which solids are left out of the picture; none if there is nothing to hide.
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

/// The scene without some of its solids.
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

std::optional<Error> fault_of(const PictureView& view) {
  if (!(view.fov_deg >= 1.0 && view.fov_deg <= 150.0)) return Error{fmt::format("the opening of the picture is {} degrees, expected 1 to 150", view.fov_deg)};
  if (view.width < 1 || view.height < 1 || view.width > largest_picture_side || view.height > largest_picture_side)
    return Error{fmt::format("the picture has {} x {} pixels, expected 1 to {} each", view.width, view.height, largest_picture_side)};
  for (const auto& point : {view.from, view.at})
    if (point && !(glm::length(*point) <= 1e10)) return Error{"the camera, or what it looks at, is farther than 1e10 m, expected finite metres"};
  if (view.from && view.at && *view.from == *view.at) return Error{"the camera is at the point that it looks at, expected two different points"};
  return std::nullopt;
}

}  // namespace

PictureView fitted(const World& world, const PictureView& view) {
  PictureView full = view;
  const Bounds box = subject(world);
  if (!full.at) full.at = 0.5 * (box.low + box.high);
  if (full.from) {
    if (*full.from == *full.at) full.at = *full.from + Vector(1.0, 0.0, 0.0);  // a camera in the very middle looks east
    return full;
  }
  const Vector back = glm::normalize(Vector(-0.56, -0.83, 0.70));
  const Camera camera(full, *full.at + back, *full.at);
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

Result<Done> draw_world(const Scene& scene, const PictureView& wanted, const std::filesystem::path& file) {
  if (const auto fault = fault_of(wanted)) return *fault;
  const World standing = world_at(scene.world(), scene.time());
  const PictureView view = fitted(standing, wanted);
  const auto hidden = hidden_solids(standing, view);
  if (!hidden) return hidden.error();
  const auto shown = without(scene, *hidden);
  if (!shown) return shown.error();

  const Camera camera(view, *view.from, *view.at);
  const Painter painter(*shown, camera, view, subject(standing));
  const auto width = static_cast<std::size_t>(view.width);
  std::vector<std::uint32_t> pixels(width * static_cast<std::size_t>(view.height));
  tbb::parallel_for(0, view.height, [&](int row) { painter.paint_row(row, pixels.data() + static_cast<std::size_t>(row) * width); });
  Canvas canvas(view.width, view.height, {});
  canvas.image(pixels, view.width, view.height, {0.0, 0.0}, 1.0);
  return canvas.write(file);
}

}  // namespace thicket
