// Trees and hedges.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "thicket/base/pose.hpp"
#include "hand_made_mesh.hpp"
#include "thicket/worlds/generators.hpp"

using namespace thicket;

namespace {

/// The area that leaves show from a direction, by their area.
double projection(const Mesh& mesh, const glm::dvec3& direction) {
  double sum = 0.0;
  for (const glm::uvec3& t : mesh.triangles) {
    const glm::dvec3 a = mesh.vertices[t.x];
    sum += 0.5 * std::abs(glm::dot(glm::cross(mesh.vertices[t.y] - a, mesh.vertices[t.z] - a), direction));
  }
  return sum / area(mesh);
}

bool same(const Mesh& a, const Mesh& b) {
  return a.vertices == b.vertices && a.triangles == b.triangles;
}

}  // namespace

TEST_CASE("a tree has the wood and leaves that were asked for, in their place") {
  const TreeSpec spec;
  const Foliage tree = grow_tree(spec);
  CHECK(tree.wood->closed);
  CHECK(signed_volume(*tree.wood) > 0.0);
  CHECK(tree.wood->triangles.size() == 28u * (1u + 40u));
  CHECK(tree.wood->low.z == 0.0);
  CHECK(tree.wood->high.z <= spec.height);
  CHECK_FALSE(tree.leaves->closed);
  CHECK(tree.leaves->triangles.size() == 8000);
  CHECK(area(*tree.leaves) == doctest::Approx(4000 * leaf_area(spec.leaf_size)).epsilon(1e-9));
  // Within the crown, as far as a leaf reaches.
  double farthest = 0.0;
  for (const glm::dvec3& v : tree.leaves->vertices) {
    const glm::dvec3 half(spec.crown_radius + spec.leaf_size, spec.crown_radius + spec.leaf_size,
                          0.5 * (spec.height - spec.crown_base) + spec.leaf_size);
    farthest = std::max(farthest, glm::length((v - glm::dvec3(0.0, 0.0, 0.5 * (spec.height + spec.crown_base))) / half));
  }
  CHECK(farthest <= 1.0);
  CHECK(farthest > 0.85);
  // As dense as the header says.
  const double crown = 4.0 / 3.0 * pi * 1.5 * 1.5 * 1.75;
  CHECK(area(*tree.leaves) / crown == doctest::Approx(0.47).epsilon(0.02));
  // The trunk tapers: thick at the ground, thin at its top.
  double foot = 0.0;
  for (const glm::dvec3& v : tree.wood->vertices)
    if (v.z == 0.0) foot = std::max(foot, std::hypot(v.x, v.y));
  CHECK(foot == doctest::Approx(spec.trunk_radius));
}

TEST_CASE("branches leave the trunk to all sides, upward") {
  TreeSpec spec;
  spec.leaves = 0;
  const Foliage tree = grow_tree(spec);
  CHECK(tree.leaves->triangles.empty());
  int quadrant[4] = {0, 0, 0, 0};
  for (std::size_t limb = 1; limb <= 40; ++limb) {
    glm::dvec3 from(0.0), to(0.0);
    for (std::size_t i = 0; i < 8; ++i) {
      from += tree.wood->vertices[16 * limb + 2 * i] / 8.0;
      to += tree.wood->vertices[16 * limb + 2 * i + 1] / 8.0;
    }
    CHECK(std::hypot(from.x, from.y) < 1e-9);
    CHECK(to.z >= from.z);
    CHECK(glm::distance(from, to) > 0.05);
    ++quadrant[(to.x > 0.0 ? 1 : 0) + (to.y > 0.0 ? 2 : 0)];
  }
  for (const int count : quadrant) CHECK(count >= 8);
}

TEST_CASE("a hedge fills its box") {
  const HedgeSpec spec;
  const Foliage hedge = grow_hedge(spec);
  CHECK(hedge.wood->closed);
  CHECK(hedge.wood->triangles.size() == 28u * 12u);
  CHECK(signed_volume(*hedge.wood) > 0.0);
  CHECK_FALSE(hedge.leaves->closed);
  CHECK(hedge.leaves->triangles.size() == 2u * 3600u);
  CHECK(area(*hedge.leaves) / (2.0 * 0.6 * 1.5) == doctest::Approx(1.5).epsilon(1e-9));
  CHECK(hedge.leaves->low.x >= -1.0);
  CHECK(hedge.leaves->low.y >= -0.3);
  CHECK(hedge.leaves->low.z >= 0.0);
  CHECK(hedge.leaves->high.x <= 1.0);
  CHECK(hedge.leaves->high.y <= 0.3);
  CHECK(hedge.leaves->high.z <= 1.5);
  CHECK(hedge.leaves->high.x - hedge.leaves->low.x > 1.95);
  CHECK(hedge.leaves->high.z - hedge.leaves->low.z > 1.45);
}

TEST_CASE("leaves show half of their area to every side") {
  // Spherical: the mean of |cos| over a sphere is 1/2. Its variance is 1/12, so four sigma of 20000 leaves are 0.008.
  TreeSpec tree;
  tree.leaves = 20000;
  HedgeSpec hedge;
  hedge.leaves_per_m3 = 12000.0;
  for (const auto& leaves : {grow_tree(tree).leaves, grow_hedge(hedge).leaves}) {
    REQUIRE(leaves->triangles.size() >= 40000);
    for (const glm::dvec3& direction :
         {glm::dvec3(0, 0, 1), glm::dvec3(1, 0, 0), glm::dvec3(0, 1, 0), glm::dvec3(0.6, 0, 0.8), glm::dvec3(0, 0.6, -0.8)})
      CHECK(std::abs(projection(*leaves, direction) - 0.5) < 0.0085);
  }
}

TEST_CASE("foliage is a function of its seed, bit for bit") {
  TreeSpec tree;
  HedgeSpec hedge;
  const Foliage t = grow_tree(tree), h = grow_hedge(hedge);
  CHECK(same(*t.wood, *grow_tree(tree).wood));
  CHECK(same(*t.leaves, *grow_tree(tree).leaves));
  CHECK(same(*h.wood, *grow_hedge(hedge).wood));
  CHECK(same(*h.leaves, *grow_hedge(hedge).leaves));
  tree.seed = hedge.seed = -5;
  CHECK_FALSE(same(*t.wood, *grow_tree(tree).wood));
  CHECK_FALSE(same(*t.leaves, *grow_tree(tree).leaves));
  CHECK_FALSE(same(*h.wood, *grow_hedge(hedge).wood));
  CHECK_FALSE(same(*h.leaves, *grow_hedge(hedge).leaves));
}

TEST_CASE("foliage may be without branches, leaves and stems") {
  TreeSpec tree;
  tree.branches = 0;
  tree.leaves = 500;
  const Foliage t = grow_tree(tree);
  CHECK(t.wood->closed);
  CHECK(t.leaves->triangles.size() == 1000);
  CHECK(t.leaves->low.z >= tree.crown_base - tree.leaf_size);
  HedgeSpec hedge;
  hedge.stems = 0;
  hedge.size = {0.01, 0.01, 1.0};  // thinner than a leaf
  hedge.leaves_per_m3 = 1e6;
  const Foliage h = grow_hedge(hedge);
  CHECK(h.wood->triangles.empty());
  CHECK(h.leaves->triangles.size() == 200);
  CHECK(h.leaves->low.z >= 0.0);
}
