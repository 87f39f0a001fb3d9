// The models that Thicket makes itself: the shipped files are what the generator makes, and the loader takes them for volumes of the right size.
#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <string>

#include "../temporary_folder.hpp"
#include "thicket/base/files.hpp"
#include "thicket/worlds/mesh_file.hpp"
#include "thicket/worlds/models.hpp"
#include "thicket/worlds/scene.hpp"
#include "thicket/worlds/world.hpp"

using namespace thicket;

namespace {

ObjFile read_back(const Model& model) {
  const TemporaryFolder folder;
  folder.write(model.name + ".mtl", model_mtl(model));
  auto file = read_obj(folder.write(model.name + ".obj", model_obj(model, model.name + ".mtl")));
  INFO((file ? "" : file.error().message));
  REQUIRE(static_cast<bool>(file));
  return *file;
}

struct Box {
  glm::dvec3 low{infinity}, high{-infinity};
};
Box box_of(const ObjFile& file) {
  Box box;
  for (const MeshPiece& piece : file.pieces) {
    box.low = glm::min(box.low, piece.mesh->low);
    box.high = glm::max(box.high, piece.mesh->high);
  }
  return box;
}

std::string shipped_model(const std::string& name) {
  return "worlds/data/" + std::string(name == "hold" ? "cargo_hold/" : "cluttered_room/") + name;
}

}  // namespace

TEST_CASE("the shipped models are what the generator makes") {
  for (const std::string& name : model_names()) {
    CAPTURE(name);
    const Model model = *make_model(name);
    const auto obj = read_text_file(shipped_root() / (shipped_model(name) + ".obj")), mtl = read_text_file(shipped_root() / (shipped_model(name) + ".mtl"));
    REQUIRE(static_cast<bool>(obj));
    REQUIRE(static_cast<bool>(mtl));
    CHECK(*obj == model_obj(model, name + ".mtl"));
    CHECK(*mtl == model_mtl(model));
  }
}

TEST_CASE("every part of a model is closed and faces outward, and the loader finds volumes and nothing to mend") {
  for (const std::string& name : model_names()) {
    CAPTURE(name);
    const Model model = *make_model(name);
    std::size_t triangles = 0;
    double volume = 0.0, read_volume = 0.0;
    for (const ModelPart& part : model.parts) {
      CAPTURE(part.name);
      CHECK(part.mesh->closed);
      CHECK(signed_volume(*part.mesh) > 0.0);
      triangles += part.mesh->triangles.size();
      volume += signed_volume(*part.mesh);
    }
    CHECK(triangles >= 60);
    CHECK(triangles <= 2500);
    const ObjFile file = read_back(model);
    CHECK(file.notices.empty());
    for (const std::string& notice : file.notices) MESSAGE(notice);
    for (const MeshPiece& piece : file.pieces) {
      CHECK(piece.mesh->closed);
      read_volume += signed_volume(*piece.mesh);
    }
    CHECK(read_volume == doctest::Approx(volume).epsilon(0.02));  // tenths of a millimetre of thin panes
  }
}

TEST_CASE("models stand on z = 0 and are as large as they say") {
  const auto check = [](const char* name, const glm::dvec3& size, double low) {
    CAPTURE(std::string(name));
    const Box box = box_of(read_back(*make_model(name)));
    CHECK(box.low.z == doctest::Approx(low).epsilon(1e-9));
    for (int axis = 0; axis < 3; ++axis) CHECK(box.high[axis] - box.low[axis] == doctest::Approx(size[axis]).epsilon(0.03));
  };
  check("car", {4.28, 2.02, 1.46}, 0.0);  // with the mirrors
  check("control_panel", {0.6, 1.2, 1.35}, 0.0);
  check("dumpster", {1.25, 1.96, 1.35}, 0.0);
  check("human", {0.26, 0.75, 1.76}, 0.0);
  check("postbox", {0.38, 0.4, 1.3}, 0.0);
  check("robot", {0.69, 0.55, 1.25}, 0.0);
  check("stop_sign", {0.3, 0.75, 2.25}, 0.0);
  check("hold", {31.22, 11.22, 4.01}, -0.01);
}

TEST_CASE("the hold is as wide inside as its spec says, between plates and between frames") {
  HoldSpec spec;
  spec.length = 12.0;
  spec.breadth = 8.0;
  spec.depth = 3.0;
  REQUIRE_FALSE(hold_fault(spec));
  const Model model = make_hold(spec);
  std::size_t frames = 0, stiffeners = 0;
  for (const ModelPart& part : model.parts) {
    frames += part.name == "web frame";
    stiffeners += part.name == "stiffener";
    if (part.name == "side wall") CHECK(std::min(std::abs(part.mesh->low.y), std::abs(part.mesh->high.y)) == doctest::Approx(4.0));
    if (part.name == "flange") CHECK(std::min(std::abs(part.mesh->low.y), std::abs(part.mesh->high.y)) == doctest::Approx(4.0 - 0.31));
  }
  CHECK(frames == 2 * 4);      // 12 m in steps of at most 2.5 m: five bays
  CHECK(stiffeners == 2 * 4);  // 3 m in steps of at most 0.65 m
}

TEST_CASE("a hold that cannot be is refused with what was expected") {
  const auto fault = [](auto&& change) {
    HoldSpec spec;
    change(spec);
    return hold_fault(spec).value_or("");
  };
  CHECK(fault([](HoldSpec&) {}).empty());
  CHECK(fault([](HoldSpec& s) { s.length = 0.0; }) == "the hold's length is 0 m, expected a finite number greater than 0");
  CHECK(fault([](HoldSpec& s) { s.depth = std::numeric_limits<double>::quiet_NaN(); }).find("the hold's depth is nan m") == 0);
  CHECK(fault([](HoldSpec& s) { s.frame_depth = 5.0; }).find("frames of 5 m meet") == 0);
  CHECK(fault([](HoldSpec& s) { s.frame_spacing = 0.1; }).find("flanges of 0.15 m stand every 0.1 m") == 0);
  CHECK(fault([](HoldSpec& s) { s.stiffener_spacing = 0.011, s.length = 1e5; }).find("the hold has about") == 0);
}
