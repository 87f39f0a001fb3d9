#include "thicket/gui/history.hpp"

#include <algorithm>

namespace thicket::gui {
namespace {

constexpr std::size_t most_kept = 256;

std::size_t bytes_of(const Simulation& s) {
  std::size_t bytes = 4096 + s.map().memory_bytes();
  if (s.sar()) bytes += s.sar()->memory_bytes();
  for (const Scan& scan : s.scans())
    bytes += scan.beams.size() * sizeof(Beam) + scan.echoes.size() * sizeof(Echo) + scan.profiles.amplitude.size() * 2 * sizeof(float) + scan.profiles.iq.size() * sizeof(std::complex<float>);
  return bytes;
}

}  // namespace

void History::begin(const Simulation& state) {
  states_.clear();
  bytes_ = 0;
  spacing_ = 16;
  newest_ = state.steps();
  keep(state, true);
}

void History::note(const Simulation& state) {
  // The end comes without a step of its own: it is kept as what was made is, so that who steps to it finds it.
  const bool ends = state.verdict() && !states_.back().state.verdict();
  if (state.steps() <= newest_ && !ends) return;
  newest_ = state.steps();
  if (ends || newest_ - states_.back().state.steps() >= spacing_) keep(state, ends);
}

void History::intervene(const Simulation& state) {
  while (states_.size() > 1 && states_.back().state.steps() > state.steps()) {
    bytes_ -= states_.back().bytes;
    states_.pop_back();
  }
  newest_ = state.steps();
  keep(state, true);
}

void History::keep(const Simulation& state, bool made) {
  states_.push_back({state, made, bytes_of(state)});
  bytes_ += states_.back().bytes;
  if (states_.size() > most_kept || bytes_ > budget_) thin_out();
}

void History::thin_out() {
  // Every other one that only steps made; if that is not enough, the oldest go, and there is no way back to them.
  spacing_ *= 2;
  std::vector<Kept> left;
  bool drop = false;
  for (std::size_t i = 0; i < states_.size(); ++i) {
    if (!states_[i].made && i + 1 < states_.size() && (drop = !drop)) bytes_ -= states_[i].bytes;
    else left.push_back(std::move(states_[i]));
  }
  while (left.size() > 1 && (left.size() > most_kept || bytes_ > budget_)) {
    bytes_ -= left.front().bytes;
    left.erase(left.begin());
  }
  states_ = std::move(left);
}

Simulation History::at(std::uint64_t step) const {
  const auto after = std::upper_bound(states_.begin(), states_.end(), step, [](std::uint64_t s, const Kept& kept) { return s < kept.state.steps(); });
  Simulation state = after == states_.begin() ? states_.front().state : std::prev(after)->state;
  while (state.steps() < step && state.step()) {
  }
  return state;
}

const Simulation* History::made_at(std::uint64_t step) const {
  const auto after = std::upper_bound(states_.begin(), states_.end(), step, [](std::uint64_t s, const Kept& kept) { return s < kept.state.steps(); });
  if (after == states_.begin()) return nullptr;
  const Kept& kept = *std::prev(after);
  return kept.made && kept.state.steps() == step ? &kept.state : nullptr;
}

}  // namespace thicket::gui
