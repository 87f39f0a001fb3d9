// Com, "common sense" (Sankaranarayanan & Vidyasagar 1990): follow the boundary until the way to the goal is open, leave there. Not complete: with nothing remembered it
// may go round and round between the same leave and hit points (a U whose mouth faces away from the goal is enough). It cannot know that by its own rule; this one remembers
// its hit points, for nothing but to end with "stuck" when it comes back to the same one again and again and to no new one in between. A boundary walked all around with the way
// open nowhere is a true "unreachable".
#include <vector>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "bug.hpp"
#include "planners.hpp"

namespace thicket {
namespace {

class Com final : public Bug {
 public:
  using Bug::Bug;
  std::unique_ptr<Planner> clone() const override { return std::make_unique<Com>(*this); }

 private:
  /// A place where boundaries were hit.
  struct Place {
    glm::dvec2 at{0.0, 0.0};
    std::size_t known = 0;  ///< how many places there were when it was hit last
    int rounds = 0;         ///< times in a row that it was hit again without a new place in between
  };
  static constexpr int most_rounds = 3;

  void on_hit() override {
    rounds_ = 0;
    for (Place& place : places_) {
      if (glm::distance(place.at, walk().hit()) > 3.0 * pilot().same_place()) continue;
      place.rounds = place.known == places_.size() ? place.rounds + 1 : 0;
      place.known = places_.size();
      rounds_ = place.rounds;
      return;
    }
    places_.push_back({walk().hit(), places_.size() + 1, 0});
  }

  Decision on_boundary() override {
    if (rounds_ >= most_rounds)
      return {{}, Outcome::stuck, "goes round for ever", fmt::format("goes round for ever: the boundary was hit at ({:.2f}, {:.2f}) for the {}th time, and at no new place since the first of them",
                                                                      walk().hit().x, walk().hit().y, rounds_ + 1)};
    if (walk().armed() && pilot().open_toward(goal())) return leave();
    if (walk().closed()) return unreachable("the whole boundary was walked, and nowhere was the way to the goal open");
    return follow("following the boundary");
  }

  std::vector<Place> places_;
  int rounds_ = 0;  ///< of the place that was hit last
};

}  // namespace

std::unique_ptr<Planner> make_com(const PlannerSpec& spec, const VehicleLimits& vehicle, const Pose2&) { return std::make_unique<Com>(spec, vehicle); }

}  // namespace thicket
