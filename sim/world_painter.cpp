#include "thicket/sim/world_picture.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <span>
#include <utility>

#include <glm/common.hpp>
#include <glm/exponential.hpp>
#include <glm/geometric.hpp>

#include "picture_colours.hpp"

namespace thicket {
namespace {

using Vector = glm::dvec3;

constexpr double darkest = 5.0;  // optical depth behind which nothing is drawn

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

}  // namespace

class WorldPainter::Painter {
 public:
  Painter(Scene seen, const PictureView& view, const Bounds& box)
      : scene_(std::move(seen)), camera_(view), view_(view), far_(3.0 * glm::distance(camera_.from, 0.5 * (box.low + box.high)) + 2.0 * glm::distance(box.low, box.high)), reach_(0.25 * glm::distance(box.low, box.high)) {
    for (const Material& material : scene_.world().materials) {
      const Look& look = looks_.emplace_back(look_of(material));
      losses_.push_back(look.kind == Look::Kind::solid ? infinity : look.extinction);
    }
    pixel_angle_ = 2.0 * camera_.half_width / view.width;
  }

  void paint_row(int row, std::size_t samples, std::uint32_t* pixels) const {
    const auto count = static_cast<std::size_t>(view_.width) * samples;
    std::vector<Ray> rays(count);
    for (std::size_t i = 0; i < count; ++i) {
      const double x = static_cast<double>(i / samples) + (samples == 1 ? 0.5 : i & 1 ? 0.75 : 0.25), y = row + (samples == 1 ? 0.5 : i & 2 ? 0.75 : 0.25);
      rays[i] = ray_at(x, y);
    }
    CrossingLists lists;
    scene_.crossings(rays, losses_, darkest, lists);
    std::vector<Surface> surfaces(count);
    std::vector<Veil> veils(count);
    for (std::size_t i = 0; i < count; ++i) look_along(rays[i], lists[i], surfaces[i], veils[i]);
    light_up(surfaces, samples);
    for (std::size_t p = 0; p < static_cast<std::size_t>(view_.width); ++p) {
      Vector sum(0.0);
      for (std::size_t i = p * samples; i < (p + 1) * samples; ++i) sum += glm::min(veils[i].light + veils[i].left * light_of(rays[i].direction, surfaces[i]), Vector(1.0));
      pixels[p] = to_pixel(sum / static_cast<double>(samples));
    }
  }

  /// How far away along the ray through the middle of each pixel the surface is that it ends at.
  void measure_row(int row, float* depth) const {
    const auto count = static_cast<std::size_t>(view_.width);
    std::vector<Ray> rays(count);
    for (std::size_t i = 0; i < count; ++i) rays[i] = ray_at(static_cast<double>(i) + 0.5, row + 0.5);
    CrossingLists lists;
    scene_.crossings(rays, losses_, darkest, lists);
    for (std::size_t i = 0; i < count; ++i) {
      const auto first = std::find_if(lists[i].begin(), lists[i].end(), [&](const Crossing& c) { return look(c).kind == Look::Kind::solid; });
      depth[i] = first == lists[i].end() ? std::numeric_limits<float>::infinity() : static_cast<float>(first->enter);
    }
  }

  const PictureView& view() const { return view_; }

 private:
  Ray ray_at(double x, double y) const { return {camera_.from, camera_.direction(2.0 * x / view_.width - 1.0, 1.0 - 2.0 * y / view_.height), infinity}; }

  /// What of the sun and of the sky each surface sees.
  void light_up(std::vector<Surface>& surfaces, std::size_t samples) const {
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

  Scene scene_;
  PictureCamera camera_;
  PictureView view_;
  std::vector<double> losses_;  // of every material: optical depth a metre
  std::vector<Look> looks_;
  double far_, reach_, pixel_angle_ = 0.0;  // how far away haze begins, and how far a surface looks for what hides the sky
};

WorldPainter::WorldPainter(Scene scene, const PictureView& view, const Bounds& subject) : painter_(std::make_shared<const Painter>(std::move(scene), view, subject)) {}

const PictureView& WorldPainter::view() const { return painter_->view(); }

void WorldPainter::paint_row(int row, int samples, std::uint32_t* pixels) const { painter_->paint_row(row, samples > 1 ? 4 : 1, pixels); }

void WorldPainter::measure_row(int row, float* depth) const { painter_->measure_row(row, depth); }

}  // namespace thicket
