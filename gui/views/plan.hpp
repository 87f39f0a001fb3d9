// What the World and the Map view share: a plan that one can move about in, and what is drawn on it. Private to the room.
#pragma once

#include <array>
#include <functional>
#include <future>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <tuple>
#include <unordered_map>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "../view.hpp"
#include "thicket/sim/map_score.hpp"
#include "thicket/worlds/truth.hpp"

namespace thicket::gui {

ImU32 with_alpha(ImU32 colour, double share);  ///< its own alpha times the share
ImU32 colour_of(const glm::dvec3& display, double alpha = 1.0);
/// Words that can be read over anything.
void label(const Frame& frame, const ImVec2& at, ImU32 colour, const char* words, ImDrawList& draw);
/// On a ramp from yellow (0) over orange and purple to dark blue (1).
ImU32 ramp(double share, double alpha);

/// A key of the keyboard, by its letter or digit, pressed just now while the mouse is over the plan and nobody writes.
bool key_pressed(char key);

/// What comes next stands beside the last button if its words have room there, and below it if not. `box`: it is a checkbox.
void beside_if_room(const char* words, bool box = false);

/// The camera of a view and what moves it.
class PlanControls {
 public:
  PlanCamera camera;
  bool follow = false, robot_up = false;

  /// Lays the plan over the rest of the window and takes the mouse and keys: wheel, middle and right drags, F, T, N; left drags if `left_pans`.
  void begin(const Frame& frame, const char* id);
  void pan(const Frame& frame, bool left);
  bool hovered() const { return hovered_; }
  void fit(const Frame& frame);
  void buttons();

  void draw_grid(const Frame& frame, ImDrawList& draw) const;
  void draw_scale_bar(const Frame& frame, ImDrawList& draw) const;

 private:
  bool hovered_ = false, touched_ = false, wants_fit_ = false;
  ImVec2 fitted_size_{0.0f, 0.0f};
  std::filesystem::path file_;
};

/// A rectangle of the world that holds what is to be seen.
struct PlanExtent {
  glm::dvec2 low{INFINITY}, high{-INFINITY};
  void hold(const glm::dvec2& p) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y)};
  }
};
PlanExtent extent_of(const Snapshot& now);
PlanExtent seen_by(const PlanCamera& camera);

/// What of a solid is seen from above, in the solid's frame (turned by pitch and roll already).
struct Footprint {
  struct Disc {
    glm::dvec2 centre{0.0};
    double radius = 0.0;
  };
  std::vector<std::vector<glm::dvec2>> fills;   ///< convex polygons
  std::vector<std::vector<glm::dvec2>> rings;   ///< outlines
  std::vector<Disc> discs;
  std::string mask;                             ///< the name of a picture, over `low` to `high`; empty: none
  glm::dvec2 low{0.0}, high{0.0};
  bool contains(const glm::dvec2& point) const;
};
Footprint footprint_of(const Solid& solid);
/// Of a mesh only the rectangle around it, at once.
Footprint rough_footprint_of(const Solid& solid);

/// Something that takes long, computed beside.
template <class T>
class Beside {
 public:
  bool busy() const { return future_.valid(); }
  void start(std::function<T()> work) { future_ = std::async(std::launch::async, std::move(work)); }
  /// Takes what is finished; waits for it if told so. Whether there is something new.
  bool poll(bool wait, T& result) {
    if (!future_.valid() || (!wait && future_.wait_for(std::chrono::seconds(0)) != std::future_status::ready)) return false;
    result = future_.get();
    return true;
  }

 private:
  std::future<T> future_;
};

/// The solids of a world from above. Made anew when the world is another. Meshes of many triangles are made beside: until then there is a rectangle.
class PlanSolids {
 public:
  void draw(const Frame& frame, const PlanCamera& camera, ImDrawList& draw);
  /// The topmost at a point.
  std::optional<std::uint32_t> at(const Snapshot& now, const glm::dvec2& point);

 private:
  using MeshKey = std::tuple<std::shared_ptr<const Mesh>, double, double, double>;  ///< scale, pitch, roll
  struct Entry {
    std::uint32_t solid = 0;
    std::shared_ptr<const Footprint> shape;
    ImU32 fill = 0, edge = 0;
    bool overhead = false;
    double top = 0.0;
    std::optional<MeshKey> waits_for = std::nullopt;  ///< its shape is being made
  };
  struct Mask {
    int width = 0, height = 0;
    std::vector<std::uint32_t> pixels;
    bool sent = false;  ///< to the graphics card
  };
  struct Made {
    MeshKey key;
    Footprint shape;
    Mask mask;
  };
  void make(const Snapshot& now);
  std::shared_ptr<const Footprint> mesh_shape(const Solid& solid, const MeshKey& key, Entry& entry);
  void take_made(bool wait);
  static Mask mask_of(Footprint& shape);
  void draw_one(const Frame& frame, const PlanCamera& camera, const Entry& entry, ImDrawList& draw);

  std::uint64_t revision_ = 0;
  bool made_ = false;
  std::vector<Entry> entries_;
  std::unordered_map<std::string, Mask> masks_;
  std::map<MeshKey, std::shared_ptr<const Footprint>> meshes_;  ///< kept from world to world: an edited one has most of its meshes still
  std::map<MeshKey, std::shared_ptr<const Footprint>> rough_;   ///< until they are made
  int masks_made_ = 0;
  std::vector<std::pair<MeshKey, Solid>> wanted_;               ///< whose footprints are to be made
  Beside<std::vector<Made>> making_;
};

/// The occupancy map as pictures, of which only squares that have changed go to the graphics card.
class MapPicture {
 public:
  /// `unknown`: the colour of what was never sensed, over all of the view if it has one.
  MapPicture(std::string name, ImU32 unknown) : name_(std::move(name)), unknown_(unknown) {}
  void draw(const Frame& frame, const PlanCamera& camera, bool probability, double alpha, ImDrawList& draw);
  std::size_t tiles_sent() const { return sent_; }  ///< squares of 64 x 64 cells in all, for tests

  static constexpr ImU32 unknown_colour = IM_COL32(0x2f, 0x4b, 0x8f, 255);

 private:
  static constexpr int across = 512;  ///< cells along the edge of one picture
  struct Chunk {
    std::int64_t column = 0, row = 0;  ///< in chunks
    std::vector<std::uint32_t> pixels;
    std::vector<bool> dirty;           ///< of its squares
    bool all_dirty = true;
  };
  void take(const Frame& frame, bool probability);
  Chunk& chunk_at(std::int64_t column, std::int64_t row);
  void fill_around(const PlanCamera& camera, double size, ImDrawList& draw) const;
  void send(const Frame& frame, Chunk& chunk, ImTextureID& texture);

  std::string name_;
  ImU32 unknown_;
  std::shared_ptr<const Simulation> last_;
  bool probability_ = false;
  std::vector<Chunk> chunks_;
  std::size_t sent_ = 0;
};

/// Where matter really is at the sensors' height: its outline on the map's cells.
class TruthOutline {
 public:
  void draw(const Frame& frame, const PlanCamera& camera, ImDrawList& draw);

 private:
  struct Line {
    glm::dvec2 from, to;
  };
  struct Made {
    std::vector<Line> lines;
    std::string error;
  };
  Beside<Made> work_;
  Made made_;
  std::uint64_t revision_ = ~std::uint64_t{0};
  double time_ = -1.0;
};

/// What is drawn over the solids; each with its key.
struct Layers {
  enum class Rays { amplitude, depth, side };
  enum class MapPlace { off, under, over };
  bool rays = true, echoes = true, bumpers = true, clearance = false, lidar = true, lobes = true, truth = false, contact = true, trail = true, marks = true, solids = true;
  Rays ray_mode = Rays::amplitude;
  MapPlace map = MapPlace::off;

  void keys();
  void menu();
};
void draw_scans(const Frame& frame, const PlanCamera& camera, const Layers& layers, ImDrawList& draw);
void draw_bumpers(const Frame& frame, const PlanCamera& camera, ImDrawList& draw);
void draw_clearance(const Frame& frame, const PlanCamera& camera, ImDrawList& draw);
void draw_contact(const Frame& frame, const PlanCamera& camera, ImDrawList& draw);
void draw_trail(const Frame& frame, const PlanCamera& camera, ImDrawList& draw);
void draw_marks(const Frame& frame, const PlanCamera& camera, ImDrawList& draw);
/// Start, goal and way-points.
void draw_places(const Frame& frame, const PlanCamera& camera, ImDrawList& draw);
void draw_robot(const Frame& frame, const PlanCamera& camera, ImDrawList& draw);
void draw_hull(const PlanCamera& camera, const Pose2& pose, double radius, ImU32 fill, ImU32 edge, ImDrawList& draw);

/// The robot's pose when a scan was made.
Pose2 pose_at(const Snapshot& now, double time);

/// Drags of the goal, the robot and its heading, by the left button.
class Handles {
 public:
  enum class What { nothing, goal, robot, heading };
  /// What lies under a point of the screen.
  static What at(const Frame& frame, const PlanCamera& camera, const ImVec2& point);
  /// Takes a press that hits one of those, and posts when it is let go. Whether it has the mouse.
  bool use(const Frame& frame, const PlanCamera& camera, bool hovered, ImDrawList& draw);
  bool busy() const { return what_ != What::nothing; }

 private:
  What what_ = What::nothing;
  ImVec2 pressed_{0.0f, 0.0f};
  bool moved_ = false;
  glm::dvec2 offset_{0.0};
  Pose2 pose_;
  glm::dvec2 goal_{0.0};
};
bool has_goal(const Snapshot& now);

std::unique_ptr<PlanTool> make_goal_tool();
std::unique_ptr<PlanTool> make_robot_tool();
std::unique_ptr<PlanTool> make_measure_tool();
/// `solids`: those of the view.
std::unique_ptr<PlanTool> make_inspect_tool(std::shared_ptr<PlanSolids> solids);

/// What the map says of a cell, in words.
std::string describe_cell(const Simulation& simulation, const glm::dvec2& point);

}  // namespace thicket::gui
