#include "mesh_parts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <span>
#include <string_view>
#include <utility>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "edges.hpp"
#include "mesh_inside.hpp"

namespace thicket {
namespace {

using Index = std::uint32_t;
using Triangles = std::vector<glm::uvec3>;
using Labels = std::vector<Index>;  // a number per triangle

/// Sets of triangles that are joined step by step, and for each triangle whether it runs the other way than the first of its set.
class Joined {
 public:
  explicit Joined(std::size_t count) : parent_(count), turned_(count, 0) { std::iota(parent_.begin(), parent_.end(), Index{0}); }

  struct Root {
    Index index;
    bool turned;
  };
  Root find(Index i) {
    Index root = i;
    bool turned = false;
    for (; parent_[root] != root; root = parent_[root]) turned ^= turned_[root] != 0;
    // All on the way point to the root from now on.
    for (bool rest = turned; parent_[i] != root && i != root;) {
      const bool own = turned_[i] != 0;
      const Index next = std::exchange(parent_[i], root);
      turned_[i] = rest;
      rest ^= own;
      i = next;
    }
    return {root, turned};
  }
  /// False if they are already joined the other way.
  bool join(Index i, Index j, bool opposite) {
    const Root a = find(i), b = find(j);
    if (a.index == b.index) return (a.turned != b.turned) == opposite;
    const auto [low, high] = std::minmax(a.index, b.index);
    parent_[high] = low;
    turned_[high] = (a.turned != b.turned) != opposite;
    return true;
  }

 private:
  std::vector<Index> parent_;
  std::vector<char> turned_;
};

struct Partition {
  Labels part;  ///< of each triangle, numbered by their first triangles
  Index count = 0;
};

/// Parts that hang together by edges within their group: by all of them, or only by those of two triangles. (Only by a corner is not
/// together: two cubes that touch there are two.)
Partition partition(const Triangles& triangles, const Labels& groups, bool only_by_pairs) {
  Joined joined(triangles.size());
  for_each_edge(edge_passes(triangles, groups), [&](std::span<const EdgePass> edge) {
    if (only_by_pairs && edge.size() != 2) return;
    for (std::size_t i = 1; i < edge.size(); ++i) joined.join(edge[0].triangle(), edge[i].triangle(), false);
  });
  Partition result;
  result.part.resize(triangles.size());
  for (Index t = 0; t < triangles.size(); ++t) {
    const Index root = joined.find(t).index;  // the first of its set
    result.part[t] = root == t ? result.count++ : result.part[root];
  }
  return result;
}

struct Judgement {
  bool balanced = true;      ///< every edge is passed as often one way as the other: closed
  bool paired = true;        ///< every edge belongs to two triangles
  bool orientable = true;    ///< of what is paired: it can be made balanced
  std::size_t boundary = 0;  ///< edges of an odd number of triangles
};

std::vector<Judgement> judge(const Triangles& triangles, const Partition& parts) {
  std::vector<Judgement> result(parts.count);
  for_each_edge(edge_passes(triangles, parts.part), [&](std::span<const EdgePass> edge) {
    Judgement& j = result[edge[0].group];
    int sum = 0;
    for (const EdgePass& pass : edge) sum += pass.way();
    j.balanced = j.balanced && sum == 0;
    j.paired = j.paired && edge.size() == 2;
    j.boundary += edge.size() % 2;
  });
  return result;
}

/// Turns triangles of the parts that are paired but not balanced until they are; how many parts that were. What has only one side stays as
/// it is.
std::size_t make_consistent(Triangles& triangles, const Partition& parts, std::vector<Judgement>& judgements) {
  const auto mendable = [&](Index part) { return judgements[part].paired && !judgements[part].balanced; };
  bool any = false;
  for (Index p = 0; p < parts.count; ++p) any = any || mendable(p);
  if (!any) return 0;
  Joined joined(triangles.size());
  for_each_edge(edge_passes(triangles, parts.part), [&](std::span<const EdgePass> edge) {
    Judgement& j = judgements[edge[0].group];
    if (!mendable(edge[0].group)) return;
    if (!joined.join(edge[0].triangle(), edge[1].triangle(), edge[0].way() == edge[1].way())) j.orientable = false;
  });
  for (Index t = 0; t < triangles.size(); ++t)
    if (mendable(parts.part[t]) && judgements[parts.part[t]].orientable && joined.find(t).turned) std::swap(triangles[t].y, triangles[t].z);
  std::size_t mended = 0;
  for (Index p = 0; p < parts.count; ++p) {
    if (!mendable(p) || !judgements[p].orientable) continue;
    judgements[p].balanced = true;
    ++mended;
  }
  return mended;
}

/// A closed part.
struct Volume {
  Triangles triangles;
  Index material = 0;
  glm::dvec3 low{0.0}, high{0.0};
  double volume = 0.0, area = 0.0;  ///< m^3, negative if it faces inward; m^2
  bool inward = false;              ///< as it shall be
};

void measure(Volume& v, const std::vector<glm::dvec3>& vertices) {
  v.low = v.high = vertices[v.triangles.front().x];
  for (const glm::uvec3& t : v.triangles)
    for (int i = 0; i < 3; ++i) {
      v.low = glm::min(v.low, vertices[t[i]]);
      v.high = glm::max(v.high, vertices[t[i]]);
    }
  const glm::dvec3 middle = 0.5 * (v.low + v.high);
  for (const glm::uvec3& t : v.triangles) {
    const glm::dvec3 a = vertices[t.x], b = vertices[t.y], c = vertices[t.z];
    v.volume += glm::dot(a - middle, glm::cross(b - middle, c - middle)) / 6.0;
    v.area += 0.5 * glm::length(glm::cross(b - a, c - a));
  }
}

/// Finds which volumes of one material shall face inward. Only needed where they do not all face the same way: then what faces the other
/// way than the part around it is a cavity in it, and what has none around it, or lies in a cavity, faces outward.
void decide_directions(std::vector<Volume*>& volumes, const std::vector<glm::dvec3>& vertices) {
  const auto faces_inward = [](const Volume* v) { return v->volume < 0.0; };
  if (std::all_of(volumes.begin(), volumes.end(), faces_inward) || std::none_of(volumes.begin(), volumes.end(), faces_inward)) return;

  // From left to right, with those that may still hold the next: the smallest that does is the part around it.
  std::sort(volumes.begin(), volumes.end(), [](const Volume* a, const Volume* b) {
    if (a->low.x != b->low.x) return a->low.x < b->low.x;
    return std::abs(a->volume) > std::abs(b->volume);
  });
  struct Open {
    const Volume* volume;
    MeshInside inside;
  };
  std::vector<Open> open;
  std::vector<std::pair<Volume*, const Volume*>> around;
  for (Volume* v : volumes) {
    std::erase_if(open, [&](const Open& o) { return o.volume->high.x < v->low.x; });
    const Volume* smallest = nullptr;
    for (Open& o : open) {
      const Volume& w = *o.volume;
      const bool may_hold = glm::all(glm::lessThanEqual(w.low, v->low)) && glm::all(glm::greaterThanEqual(w.high, v->high)) &&
                            std::abs(w.volume) > std::abs(v->volume) && (!smallest || std::abs(w.volume) < std::abs(smallest->volume));
      if (may_hold && o.inside.holds(v->triangles)) smallest = &w;
    }
    around.emplace_back(v, smallest);
    open.push_back({v, MeshInside(vertices, v->triangles)});
  }
  std::stable_sort(around.begin(), around.end(),
                   [](const auto& a, const auto& b) { return std::abs(a.first->volume) > std::abs(b.first->volume); });
  for (const auto& [v, outer] : around) v->inward = outer && !outer->inward && faces_inward(v) != faces_inward(outer);
}

std::shared_ptr<const Mesh> compact(const std::vector<glm::dvec3>& vertices, const Triangles& triangles) {
  std::vector<Index> used;
  used.reserve(3 * triangles.size());
  for (const glm::uvec3& t : triangles) used.insert(used.end(), {t.x, t.y, t.z});
  std::sort(used.begin(), used.end());
  used.erase(std::unique(used.begin(), used.end()), used.end());
  std::vector<glm::dvec3> points;
  points.reserve(used.size());
  for (const Index i : used) points.push_back(vertices[i]);
  const auto index = [&](Index i) { return static_cast<Index>(std::lower_bound(used.begin(), used.end(), i) - used.begin()); };
  Triangles renamed;
  renamed.reserve(triangles.size());
  for (const glm::uvec3& t : triangles) renamed.emplace_back(index(t.x), index(t.y), index(t.z));
  return make_mesh(std::move(points), std::move(renamed));
}

/// Leaves one of the triangles that have the same corners: a sheet that was modelled from both sides is still one sheet.
std::size_t remove_doubled(Triangles& triangles) {
  const auto sorted = [](glm::uvec3 t) {
    if (t.x > t.y) std::swap(t.x, t.y);
    if (t.y > t.z) std::swap(t.y, t.z);
    if (t.x > t.y) std::swap(t.x, t.y);
    return std::array<Index, 3>{t.x, t.y, t.z};
  };
  std::vector<std::pair<std::array<Index, 3>, Index>> keys;
  keys.reserve(triangles.size());
  for (Index t = 0; t < triangles.size(); ++t) keys.emplace_back(sorted(triangles[t]), t);
  std::sort(keys.begin(), keys.end());
  std::vector<Index> kept;
  for (std::size_t k = 0; k < keys.size(); ++k)
    if (k == 0 || keys[k].first != keys[k - 1].first) kept.push_back(keys[k].second);
  std::sort(kept.begin(), kept.end());
  Triangles left;
  for (const Index t : kept) left.push_back(triangles[t]);
  const std::size_t doubled = triangles.size() - left.size();
  triangles = std::move(left);
  return doubled;
}

std::string counted(std::size_t count, std::string_view thing) {
  return fmt::format("{} {}{}", count, thing, count == 1 ? "" : "s");
}

class Apart {
 public:
  Apart(const TriangleSoup& soup, const std::string& name, std::vector<std::string>& notices)
      : soup_(soup), name_(name), notices_(notices) {}

  std::vector<MeshPiece> pieces() {
    Triangles triangles = soup_.triangles;
    Labels materials = soup_.materials;
    // First by edges of two triangles, so that parts that touch along an edge, or a whole face, are told apart; what is not closed then, by
    // all edges.
    take_closed(triangles, materials, true);
    take_closed(triangles, materials, false);
    tell(mended_, "closed part", "closed parts", "had faces that turned different ways: they have been turned alike");
    set_directions();
    tell_of_sheets(triangles, materials);
    return gather(triangles, materials);
  }

 private:
  void tell(std::size_t count, std::string_view one, std::string_view many, std::string_view what) {
    if (count > 0) notices_.push_back(fmt::format("{}: {} {} {}", name_, count, count == 1 ? one : many, what));
  }

  /// Takes the closed parts of each material out.
  void take_closed(Triangles& triangles, Labels& materials, bool only_by_pairs) {
    const Partition parts = partition(triangles, materials, only_by_pairs);
    std::vector<Judgement> judgements = judge(triangles, parts);
    mended_ += make_consistent(triangles, parts, judgements);
    std::vector<Index> number(parts.count);  // among the closed ones
    Index count = 0;
    for (Index p = 0; p < parts.count; ++p) number[p] = judgements[p].balanced ? count++ : 0;
    std::vector<Volume> closed(count);
    for (Index t = 0; t < triangles.size(); ++t) {
      if (!judgements[parts.part[t]].balanced) continue;
      Volume& v = closed[number[parts.part[t]]];
      v.triangles.push_back(triangles[t]);
      v.material = materials[t];
    }
    // Two layers of one surface are closed too, but nothing lies between them.
    std::vector<char> taken(parts.count, 0);
    for (Index p = 0; p < parts.count; ++p) {
      if (!judgements[p].balanced) continue;
      Volume& v = closed[number[p]];
      measure(v, soup_.vertices);
      taken[p] = std::abs(v.volume) > 1e-12 * v.area * glm::distance(v.low, v.high);
      if (taken[p]) volumes_.push_back(std::move(v));
    }
    std::size_t left = 0;
    for (Index t = 0; t < triangles.size(); ++t) {
      if (taken[parts.part[t]]) continue;
      triangles[left] = triangles[t];
      materials[left++] = materials[t];
    }
    triangles.resize(left);
    materials.resize(left);
  }

  void set_directions() {
    std::vector<std::vector<Volume*>> by_material(soup_.names.size());
    for (Volume& v : volumes_) by_material[v.material].push_back(&v);
    for (std::vector<Volume*>& volumes : by_material) decide_directions(volumes, soup_.vertices);
    std::size_t outward = 0, inward = 0;
    for (Volume& v : volumes_) {
      if (v.inward == (v.volume < 0.0)) continue;
      ++(v.inward ? inward : outward);
      for (glm::uvec3& t : v.triangles) std::swap(t.y, t.z);
    }
    tell(outward, "closed part", "closed parts", "faced inward: turned outward");
    tell(inward, "cavity", "cavities", "faced into the matter around: turned to face the hollow");
  }

  void tell_of_sheets(const Triangles& triangles, const Labels& materials) {
    if (triangles.empty()) return;
    const Partition parts = partition(triangles, Labels(triangles.size(), 0), false);
    const std::vector<Judgement> judgements = judge(triangles, parts);
    std::vector<Index> first(parts.count);
    std::vector<std::size_t> size(parts.count, 0);
    std::vector<char> mixed(parts.count, 0);
    for (Index t = 0; t < triangles.size(); ++t) {
      const Index p = parts.part[t];
      if (size[p]++ == 0) first[p] = materials[t];
      if (materials[t] != first[p]) mixed[p] = 1;
    }
    struct Sum {
      std::size_t parts = 0, triangles = 0, boundary = 0;
    } open, several, one_sided, flat;
    for (Index p = 0; p < parts.count; ++p) {
      const Judgement& j = judgements[p];
      Sum& sum = j.boundary > 0 ? open : mixed[p] ? several : j.balanced ? flat : one_sided;
      ++sum.parts;
      sum.triangles += size[p];
      sum.boundary += j.boundary;
    }
    const auto say = [&](const Sum& sum, std::string_view which, std::string_view why) {
      if (sum.parts > 0)
        notices_.push_back(fmt::format("{}: {} {} ({}{}) {}", name_, counted(sum.parts, which),
                                       sum.parts == 1 ? "is a thin sheet" : "are thin sheets", counted(sum.triangles, "triangle"),
                                       sum.boundary > 0 ? ", " + counted(sum.boundary, "boundary edge") : "", why));
    };
    say(open, "open part", "instead of volumes, since they do not close");
    say(several, "closed part", "instead of volumes, since faces of several materials close them only together");
    say(one_sided, "part", "instead of volumes, since no inside and outside can be told of them");
    say(flat, "closed part", "instead of volumes, since nothing lies between their faces");
  }

  std::vector<MeshPiece> gather(const Triangles& triangles, const Labels& materials) {
    const std::size_t count = soup_.names.size();
    std::vector<Triangles> closed(count), open(count);
    for (const Volume& v : volumes_) closed[v.material].insert(closed[v.material].end(), v.triangles.begin(), v.triangles.end());
    for (Index t = 0; t < triangles.size(); ++t) open[materials[t]].push_back(triangles[t]);
    std::vector<MeshPiece> pieces;
    std::size_t doubled = 0;
    for (std::size_t m = 0; m < count; ++m) {
      if (!closed[m].empty()) pieces.push_back({compact(soup_.vertices, closed[m]), soup_.names[m]});
      doubled += remove_doubled(open[m]);
      if (!open[m].empty()) pieces.push_back({compact(soup_.vertices, open[m]), soup_.names[m]});
    }
    tell(doubled, "triangle", "triangles", "of thin sheets had the same corners as another: left out");
    return pieces;
  }

  const TriangleSoup& soup_;
  const std::string& name_;
  std::vector<std::string>& notices_;
  std::vector<Volume> volumes_;
  std::size_t mended_ = 0;
};

}  // namespace

std::vector<MeshPiece> take_apart(const TriangleSoup& soup, const std::string& name, std::vector<std::string>& notices) {
  return Apart(soup, name, notices).pieces();
}

}  // namespace thicket
