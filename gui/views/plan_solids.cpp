// The solids of a world from above.
#include <algorithm>
#include <cmath>
#include <utility>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "plan.hpp"
#include "thicket/sim/material_colour.hpp"

namespace thicket::gui {
namespace {

constexpr std::size_t many_triangles = 400;  ///< of a mesh: from here on it is a picture

bool is_slab(const Solid& solid) { return (solid.name == "floor" || solid.name == "ceiling") && std::holds_alternative<Box>(solid.shape); }

/// Puts a triangle into a mask: every pixel whose middle it covers, and that of its own middle, so that leaves smaller than a pixel leave a trace.
void fill_triangle(const std::vector<glm::dvec2>& t, const glm::dvec2& low, double pixel, int width, int height, std::vector<std::uint8_t>& covered) {
  const glm::dvec2 a = (t[0] - low) / pixel, b = (t[1] - low) / pixel, c = (t[2] - low) / pixel, middle = (a + b + c) / 3.0;
  const auto put = [&](int x, int y) {
    if (x >= 0 && y >= 0 && x < width && y < height) covered[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)] = 1;
  };
  put(static_cast<int>(middle.x), static_cast<int>(middle.y));
  const auto cross = [](const glm::dvec2& u, const glm::dvec2& v) { return u.x * v.y - u.y * v.x; };
  const int x0 = static_cast<int>(std::min({a.x, b.x, c.x})), x1 = static_cast<int>(std::max({a.x, b.x, c.x})), y0 = static_cast<int>(std::min({a.y, b.y, c.y})), y1 = static_cast<int>(std::max({a.y, b.y, c.y}));
  for (int y = y0; y <= y1; ++y)
    for (int x = x0; x <= x1; ++x) {
      const glm::dvec2 p(x + 0.5, y + 0.5);
      if (cross(b - a, p - a) >= 0.0 && cross(c - b, p - b) >= 0.0 && cross(a - c, p - c) >= 0.0) put(x, y);
    }
}

}  // namespace

/// A mesh of many triangles becomes a picture of the part of each pixel that it covers.
PlanSolids::Mask PlanSolids::mask_of(Footprint& shape) {
  constexpr int side = 256, fine = 2;
  const glm::dvec2 size = shape.high - shape.low;
  const double pixel = std::max(size.x, size.y) / side;
  Mask mask;
  if (!(pixel > 0.0)) return mask;
  mask.width = std::max(1, static_cast<int>(std::ceil(size.x / pixel)));
  mask.height = std::max(1, static_cast<int>(std::ceil(size.y / pixel)));
  const int width = fine * mask.width, height = fine * mask.height;
  std::vector<std::uint8_t> covered(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), 0);
  for (const auto& triangle : shape.fills) fill_triangle(triangle, shape.low, pixel / fine, width, height, covered);
  mask.pixels.resize(static_cast<std::size_t>(mask.width) * static_cast<std::size_t>(mask.height));
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      if (covered[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)]) mask.pixels[static_cast<std::size_t>(y / fine) * static_cast<std::size_t>(mask.width) + static_cast<std::size_t>(x / fine)] += 255 / (fine * fine);
  for (std::uint32_t& p : mask.pixels) p = 0x00ffffffu | p << 24;
  shape.high = shape.low + glm::dvec2(mask.width, mask.height) * pixel;
  shape.fills.clear();
  shape.rings.clear();
  return mask;
}

/// The shape of a mesh, if it is known or soon made; else a rough one, and the true one is wanted.
std::shared_ptr<const Footprint> PlanSolids::mesh_shape(const Solid& solid, const MeshKey& key, Entry& entry) {
  if (const auto known = meshes_.find(key); known != meshes_.end()) return known->second;
  if (std::get<0>(key)->triangles.size() <= many_triangles) return meshes_[key] = std::make_shared<Footprint>(footprint_of(solid));
  entry.waits_for = key;
  auto& rough = rough_[key];
  if (!rough) {
    rough = std::make_shared<Footprint>(rough_footprint_of(solid));
    wanted_.emplace_back(key, solid);
  }
  return rough;
}

/// Takes what was made beside, and lets make what is wanted.
void PlanSolids::take_made(bool wait) {
  for (std::vector<Made> made; making_.busy() || !wanted_.empty();) {
    if (!making_.busy())
      making_.start([wanted = std::exchange(wanted_, {})] {
        std::vector<Made> result;
        for (const auto& [key, solid] : wanted) {
          Made one{key, footprint_of(solid), {}};
          one.mask = mask_of(one.shape);
          result.push_back(std::move(one));
        }
        return result;
      });
    if (!making_.poll(wait, made)) return;
    for (Made& one : made) {
      // (Of a world that is gone, nobody waits for it.)
      const bool awaited = std::any_of(entries_.begin(), entries_.end(), [&](const Entry& entry) { return entry.waits_for == one.key; });
      if (!awaited) continue;
      if (one.mask.width > 0) {
        one.shape.mask = "world mask " + std::to_string(masks_made_++);
        masks_[one.shape.mask] = std::move(one.mask);
      }
      const auto shape = meshes_[one.key] = std::make_shared<Footprint>(std::move(one.shape));
      rough_.erase(one.key);
      for (Entry& entry : entries_)
        if (entry.waits_for == one.key) {
          entry.shape = shape;
          entry.waits_for.reset();
        }
    }
  }
}

void PlanSolids::make(const Snapshot& now) {
  revision_ = now.world_revision;
  made_ = true;
  entries_.clear();
  const World& world = now.simulation->stage().scene.world();
  const Mission& mission = now.simulation->mission();
  double head = mission.start.z_m + mission.vehicle.hull().z_high;
  for (const SensorSpec& sensor : mission.sensors) head = std::max(head, mission.start.z_m + mounted(sensor).position_m.z);
  std::map<MeshKey, std::shared_ptr<const Footprint>> before;
  before.swap(meshes_);
  rough_.clear();
  wanted_.clear();
  for (std::uint32_t i = 0; i < world.solids.size(); ++i) {
    const Solid& solid = world.solids[i];
    const Bounds box = extent(solid);
    if (is_slab(solid) || (!solid.motion && box.high.z <= mission.start.z_m + 1e-3)) continue;
    Entry entry;
    entry.solid = i;
    entry.top = box.high.z;
    entry.overhead = !solid.motion && box.low.z > head + 0.1;
    const auto* mesh = std::get_if<MeshSolid>(&solid.shape);
    if (mesh) {
      const MeshKey key{mesh->mesh, mesh->scale, solid.pitch, solid.roll};
      if (const auto old = before.find(key); old != before.end()) meshes_.insert(*old);
      entry.shape = mesh_shape(solid, key, entry);
    } else {
      entry.shape = std::make_shared<Footprint>(footprint_of(solid));
    }
    const MaterialColour colour = material_colour(world.materials[solid.material]);
    const double alpha = (colour.penetrable ? 0.5 : 0.95) * (entry.overhead ? 0.35 : 1.0);
    entry.fill = colour_of(colour.display, alpha);
    entry.edge = colour_of(0.55 * colour.display, std::min(1.0, alpha + 0.3));
    entries_.push_back(std::move(entry));
  }
  for (const auto& [key, shape] : before)
    if (!meshes_.contains(key)) masks_.erase(shape->mask);
  std::stable_sort(entries_.begin(), entries_.end(), [](const Entry& a, const Entry& b) { return a.top < b.top; });
}

void PlanSolids::draw(const Frame& frame, const PlanCamera& camera, ImDrawList& draw) {
  if (!made_ || revision_ != frame.now.world_revision) make(frame.now);
  take_made(frame.still);
  const ImDrawListFlags flags = draw.Flags;
  draw.Flags &= ~ImDrawListFlags_AntiAliasedFill;  // neighbours would show seams
  for (const Entry& entry : entries_) draw_one(frame, camera, entry, draw);
  draw.Flags = flags;
}

void PlanSolids::draw_one(const Frame& frame, const PlanCamera& camera, const Entry& entry, ImDrawList& draw) {
  const Solid& solid = frame.now.simulation->stage().scene.world().solids[entry.solid];
  const Standing standing = standing_at(solid, frame.now.simulation->time());
  const Pose2 pose{glm::dvec2(standing.position), standing.yaw};
  const Footprint& shape = *entry.shape;
  const auto screen = [&](const glm::dvec2& p) { return camera.to_screen(pose.to_outer(p)); };
  const glm::dvec2 middle = 0.5 * (shape.low + shape.high);
  const auto reach = static_cast<float>(0.5 * glm::length(shape.high - shape.low) * camera.pixels_per_metre) + 2.0f;
  const ImVec2 at = screen(middle), low = camera.low, high{camera.low.x + camera.size.x, camera.low.y + camera.size.y};
  if (at.x + reach < low.x || at.x - reach > high.x || at.y + reach < low.y || at.y - reach > high.y) return;
  const bool selected = frame.desk.solid == entry.solid;
  const ImU32 edge = selected ? frame.colours.selected : entry.edge;
  const float thick = selected ? 2.5f : 1.0f;
  std::vector<ImVec2> points;
  const auto outline = [&](const std::vector<glm::dvec2>& ring) {
    points.clear();
    for (const glm::dvec2& p : ring) points.push_back(screen(p));
    draw.AddPolyline(points.data(), static_cast<int>(points.size()), edge, ImDrawFlags_Closed, thick);
  };
  if (!shape.mask.empty()) {
    Mask& mask = masks_[shape.mask];
    bool fresh = false;
    const ImTextureID texture = frame.textures.get(shape.mask, mask.width, mask.height, fresh);
    if (fresh || !mask.sent) frame.textures.update(shape.mask, 0, 0, mask.width, mask.height, mask.pixels.data());
    mask.sent = true;
    draw.AddImageQuad(texture, screen(shape.low), screen({shape.high.x, shape.low.y}), screen(shape.high), screen({shape.low.x, shape.high.y}), {0, 0}, {1, 0}, {1, 1}, {0, 1}, entry.fill);
    if (selected) outline({shape.low, {shape.high.x, shape.low.y}, shape.high, {shape.low.x, shape.high.y}});
    return;
  }
  for (const auto& polygon : shape.fills) {
    points.clear();
    PlanExtent box;
    for (const glm::dvec2& p : polygon) {
      points.push_back(screen(p));
      box.hold({points.back().x, points.back().y});
    }
    if (box.high.x < static_cast<double>(low.x) || box.high.y < static_cast<double>(low.y) || box.low.x > static_cast<double>(high.x) || box.low.y > static_cast<double>(high.y)) continue;
    draw.AddConvexPolyFilled(points.data(), static_cast<int>(points.size()), entry.fill);
  }
  for (const Footprint::Disc& disc : shape.discs) {
    const auto radius = static_cast<float>(disc.radius * camera.pixels_per_metre);
    draw.AddCircleFilled(screen(disc.centre), std::max(radius, 0.7f), entry.fill);
    if (shape.fills.empty()) draw.AddCircle(screen(disc.centre), std::max(radius, 0.7f), edge, 0, thick);
  }
  for (const auto& ring : shape.rings) outline(ring);
  if (selected && shape.rings.empty())
    for (const auto& polygon : shape.fills) outline(polygon);
}

std::optional<std::uint32_t> PlanSolids::at(const Snapshot& now, const glm::dvec2& point) {
  if (!made_ || revision_ != now.world_revision) make(now);
  for (auto entry = entries_.rbegin(); entry != entries_.rend(); ++entry) {
    const Standing standing = standing_at(now.simulation->stage().scene.world().solids[entry->solid], now.simulation->time());
    if (entry->shape->contains(Pose2{glm::dvec2(standing.position), standing.yaw}.to_inner(point))) return entry->solid;
  }
  return std::nullopt;
}

}  // namespace thicket::gui
