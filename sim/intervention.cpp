// What a person does to a run that is under way, and the number by which two states are told apart.
#include <cmath>

#include "thicket/sim/simulation.hpp"
#include "vehicle_limits.hpp"

namespace thicket {
namespace {

template <class Spec>
bool same(const Section& section, const Spec& a, const Spec& b) {
  return write_section(section, &a) == write_section(section, &b);
}

/// FNV-1a.
class Hash {
 public:
  void bytes(const void* data, std::size_t count) {
    for (const auto* byte = static_cast<const unsigned char*>(data); count > 0; --count, ++byte) value_ = (value_ ^ *byte) * 1099511628211u;
  }
  template <class Number>
  void number(Number n) {
    static_assert(std::is_arithmetic_v<Number>);
    bytes(&n, sizeof n);
  }
  void text(const std::string& t) { bytes(t.data(), t.size() + 1); }
  void pose(const Pose2& p) {
    for (const double x : {p.position.x, p.position.y, p.yaw}) number(x);
  }
  std::uint64_t value() const { return value_; }

 private:
  std::uint64_t value_ = 14695981039346656037u;
};

}  // namespace

void Simulation::drive(const std::optional<Command>& command) {
  const bool given_back = manual_ && !command;
  manual_ = command;
  if (command) {
    decision_ = {*command, Outcome::running, "driven by hand", ""};
    if (verdict_ && clearance_.distance > 0.0) verdict_.reset();
  } else if (given_back) {
    // The mission's planner could be made before; what it knows of where it is is the estimate, drift and all.
    planner_ = std::move(*make_planner(mission().planner, vehicle_limits(mission()), estimate()));
  }
}

Result<Simulation> Simulation::changed(const Mission& mission, const std::optional<Pose2>& pose) const { return changed(mission, stage_->scene, pose); }

Result<Simulation> Simulation::changed(const Mission& mission, Scene scene, const std::optional<Pose2>& pose) const {
  auto made = create(mission, std::move(scene));
  if (!made) return made.error();
  Simulation& next = *made;
  const Mission& was = stage_->mission;
  const Mission& is = next.mission();
  next.steps_ = is.step_s == was.step_s ? steps_ : static_cast<std::uint64_t>(std::llround(time() / is.step_s));
  next.scene_.set_time(next.time());
  next.vehicle_ = vehicle_;
  if (!is.vehicle.flies() || !was.vehicle.flies()) {
    // Another kind of vehicle begins as that kind does, where this one is.
    next.vehicle_ = {};
    static_cast<DifferentialDrive&>(next.vehicle_) = vehicle_;
    next.vehicle_.z = is.start.z_m;
    next.vehicle_.on_floor = is.vehicle.flies() && is.start.z_m <= 0.0;
  }
  if (pose) {
    const double z = next.vehicle_.z;
    next.vehicle_ = {};
    next.vehicle_.pose = *pose;
    next.vehicle_.z = z;
    next.vehicle_.on_floor = is.vehicle.flies() && z <= 0.0;
  }
  if (pose || !is.vehicle.flies() || !was.vehicle.flies()) next.vehicle_.attitude = Pose::planar(0.0, 0.0, 0.0, next.vehicle_.pose.yaw).orientation;
  const bool odometry_stays = same(odometry_section(), was.odometry, is.odometry) && was.seed == is.seed;
  if (odometry_stays && !pose) next.odometry_ = odometry_;
  else next.odometry_ = Odometry(is.odometry, pose ? *pose : estimate(), static_cast<std::uint64_t>(is.seed));
  if (same(map_section(), was.map, is.map) && was.initial_map_file == is.initial_map_file) next.map_ = map_;
  if (next.sar_ && sar_ && same(sar_section(), was.sar, is.sar) && next.sar_->method() == sar_->method() && next.sar_->frequency_ghz() == sar_->frequency_ghz() && next.stage_->sar_sensor == stage_->sar_sensor) next.sar_ = sar_;
  // Sensors go on at their rates; what they sensed last stays in view as long as there are as many of them.
  const bool as_many = stage_->sensors.size() == next.stage_->sensors.size();
  for (std::size_t i = 0; i < next.scan_counts_.size(); ++i) {
    const double rate = next.stage_->sensors[i]->spec().rate_hz;
    next.scan_counts_[i] = as_many && stage_->sensors[i]->spec().rate_hz == rate ? scan_counts_[i] : static_cast<std::uint64_t>(std::ceil(next.time() * rate - 1e-9));
  }
  if (as_many) {
    next.scans_ = scans_;
    next.scan_estimates_ = scan_estimates_;
  }
  next.manual_ = pose ? std::nullopt : manual_;
  const bool planner_stays = !pose && !verdict_ && as_many && is.step_s == was.step_s && same(planner_section(), was.planner, is.planner) && same(vehicle_section(), was.vehicle, is.vehicle) &&
                             same(bumper_section(), was.bumpers, is.bumpers) && was.planner.clearance_m == is.planner.clearance_m;
  if (planner_stays) {
    next.planner_ = planner_->clone();
    next.bumpers_ = bumpers_;
    next.decision_ = decision_;
  } else {
    auto planner = make_planner(is.planner, vehicle_limits(is), next.estimate());
    if (!planner) return planner.error();
    next.planner_ = std::move(*planner);
  }
  next.totals_ = totals_;
  next.times_ = times_;
  next.stuck_pose_ = next.vehicle_.pose;
  next.stuck_z_ = next.vehicle_.z;
  next.place_ = next.vehicle_.pose.position;
  next.stuck_step_ = next.place_step_ = next.steps_;
  next.verdict_.reset();
  next.clearance_ = next.scene_.clearance(is.vehicle.hull(), next.vehicle_pose().position, infinity);
  next.clear_of_ = next.clearance_.distance;
  next.totals_.least_clearance = std::min(next.totals_.least_clearance, next.clearance_.distance);
  if (next.clearance_.distance <= 0.0) next.end(Verdict::Kind::collided, "the hull touches '" + next.scene_.world().solids[next.clearance_.solid].name + "' where it was put");
  return made;
}

std::uint64_t state_hash(const Simulation& simulation) {
  Hash hash;
  hash.number(simulation.steps());
  hash.pose(simulation.vehicle().pose);
  hash.pose(simulation.estimate());
  for (const double x : {simulation.vehicle().speed, simulation.vehicle().turn_rate, simulation.decision().command.speed, simulation.decision().command.turn_rate}) hash.number(x);
  if (simulation.mission().vehicle.flies()) {
    const Vehicle& v = simulation.vehicle();
    for (const glm::dvec3& x : {v.velocity, v.rates, v.unrest.gust, v.unrest.jitter}) hash.bytes(&x, sizeof x);
    for (const double x : {v.z, v.attitude.w, v.attitude.x, v.attitude.y, v.attitude.z, simulation.decision().command.lateral, simulation.decision().command.climb, simulation.decision().command.altitude.value_or(-1.0)}) hash.number(x);
    hash.number(v.on_floor);
  }
  hash.text(simulation.decision().state);
  hash.number(simulation.driven_by_hand());
  for (const Scan& scan : simulation.scans()) {
    hash.number(scan.number);
    for (const Beam& beam : scan.beams) hash.number(beam.sensed_range);
    for (const Echo& echo : scan.echoes) {
      hash.number(echo.range);
      hash.number(echo.amplitude);
    }
    for (const float a : scan.profiles.amplitude) hash.number(a);
  }
  for (const Bumper& bumper : simulation.bumpers().bumpers()) {
    hash.number(bumper.distance);
    hash.number(bumper.pressed);
  }
  for (const Mark& mark : simulation.marks())
    for (const double x : {mark.from.x, mark.from.y, mark.to.x, mark.to.y}) hash.number(x);
  const std::vector<std::uint8_t> map = simulation.map().changes_since(OccupancyMap(simulation.mission().map));
  hash.bytes(map.data(), map.size());
  if (const SarImage* sar = simulation.sar()) {
    hash.number(sar->scans());
    for (const float a : sar->grid().amplitude) hash.number(a);
  }
  const RunTotals& totals = simulation.totals();
  for (const double x : {totals.path_length, totals.least_clearance}) hash.number(x);
  for (const std::uint64_t n : {totals.scans, totals.rays, totals.decisions}) hash.number(n);
  if (simulation.verdict()) hash.text(to_string(simulation.verdict()->kind) + simulation.verdict()->reason);
  return hash.value();
}

}  // namespace thicket
