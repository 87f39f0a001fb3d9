#include "explorer.hpp"

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "thicket/base/random.hpp"

namespace thicket {

Decision Explorer::decide(const Senses& senses) {
  pilot_.look(senses);
  if (before_) driven_ += glm::distance(*before_, position());
  before_ = position();
  if (driven_ >= explore_) return explored("the distance to explore is driven");
  return drive();
}

Decision Explorer::explored(const std::string& why) const {
  return {{}, Outcome::reached, "explored", fmt::format("explored: {}; {:.1f} m driven", why, driven_)};
}

double Explorer::another_way(double bearing, std::size_t count) const {
  const Random random(0, 0);
  for (std::uint32_t i = 0; i < 32; ++i) {
    const double turn = radians(60.0) + radians(240.0) * random.uniform(count, 0, RandomUse::sampling, i)[0];
    if (const double way = wrap_angle(bearing + turn); pilot_.open_toward(far_away(way))) return way;
  }
  return wrap_angle(bearing + pi);
}

}  // namespace thicket
