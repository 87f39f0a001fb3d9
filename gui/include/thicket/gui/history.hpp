// What a run was, so that it can be gone back to: whole states now and then, and the steps between them made anew.
#pragma once

#include <cstdint>
#include <vector>

#include "thicket/sim/simulation.hpp"

namespace thicket::gui {

/// Every state between the first and the newest can be had again, exactly: a simulation is a value, and one state has one future. States that a person made (a goal set, a key changed) are kept, others thinned out as they become
/// many, so that memory is bounded and going back costs the steps since the last state that is kept.
class History {
 public:
  /// `memory_bytes`: for all states together, as if they shared nothing, which they do.
  explicit History(std::size_t memory_bytes = std::size_t{512} << 20) : budget_(memory_bytes) {}

  /// Begins anew with this state.
  void begin(const Simulation& state);
  /// A state that a step led to. It may be kept.
  void note(const Simulation& state);
  /// A state that a person made: what came after its step is forgotten.
  void intervene(const Simulation& state);

  std::uint64_t first_step() const { return states_.empty() ? 0 : states_.front().state.steps(); }
  std::uint64_t newest_step() const { return newest_; }
  /// The state after a step, between the first and the newest.
  Simulation at(std::uint64_t step) const;
  /// The state of that step if a person made it or the run ended in it, so that who steps on from an earlier one does what was done; null: nothing but steps.
  const Simulation* made_at(std::uint64_t step) const;
  std::size_t kept() const { return states_.size(); }

 private:
  struct Kept {
    Simulation state;
    bool made;  ///< by a person
    std::size_t bytes;
  };
  void keep(const Simulation& state, bool made);
  void thin_out();

  std::size_t budget_, bytes_ = 0;
  std::uint64_t spacing_ = 16, newest_ = 0;
  std::vector<Kept> states_;  ///< by step; of one step the last counts
};

}  // namespace thicket::gui
