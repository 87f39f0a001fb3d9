// The radars: what rays return becomes beams, or goes through a receiver.
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include "mount.hpp"
#include "one_row.hpp"
#include "ray_sampler.hpp"
#include "receiver.hpp"
#include "sensors.hpp"

namespace thicket {
namespace {

/// Rays are traced in tasks of this many, whatever the number of threads.
constexpr std::size_t rays_per_task = 256;
/// Shorter scans stay on one core: starting the others costs more than it saves (measured, tests/bench).
constexpr std::size_t rays_for_threads = 513;

/// Rays of a row of which one is chosen: the middle one and those at its sides.
constexpr std::size_t most_in_row = 3;

/// Which of the rays of a row of a beam give what it returns.
enum class Choice { all, drawn, incidence, strongest };

Choice choice_of(const ScanningRadarSpec& spec) {
  if (spec.divergence != "side_rays" || spec.side_choice == "sum") return Choice::all;
  return spec.side_choice == "equal" ? Choice::drawn : spec.side_choice == "incidence" ? Choice::incidence : Choice::strongest;
}

/// What both kinds of radars hold.
struct Parts {
  MountedSpec mounted;
  RadarSpec wave;
  ReceiverSpec receiver;
  RaySampler sampler;
  Choice choice = Choice::all;
  std::size_t row = 1;           ///< traced rays of a row, of which one is chosen
  bool ray_beams = false;        ///< traced, every ray is a beam of its own (a lobe)
  bool first_echo_only = false;
  std::optional<OneRow> one_row;  ///< where one row of rays may stand for all of a lobe
};

class Radar final : public Sensor {
 public:
  Radar(Parts parts, std::uint16_t index)
      : Sensor(parts.mounted), p_(std::move(parts)), index_(index), mount_(mount_of(p_.mounted)), received_(p_.receiver.echoes == "receiver"), printed_(p_.wave.law == "printed"),
        receiver_(p_.receiver, p_.wave, p_.mounted.range_min_m, p_.mounted.range_max_m), floor_power_(std::pow(10.0, 0.1 * p_.wave.detection_floor_db)) {
    double printed_sum = 0.0;
    for (const SubRay& ray : p_.sampler.antenna().rays())
      if (ray.share > 0.0) printed_sum += ray.gain / (std::cos(ray.elevation) * std::cos(ray.azimuth));
    printed_unit_ = printed_sum > 0.0 ? 1.0 / printed_sum : 0.0;  // an antenna whose gain is nothing along all its rays receives nothing
    if (p_.ray_beams && !received_)
      for (const glm::dvec3& direction : p_.sampler.directions()) nominal_.push_back(beam_along(direction));
    else
      for (const double azimuth : azimuths()) nominal_.push_back(beam_towards(azimuth));
    weighted_ = !received_ && p_.ray_beams && std::ranges::any_of(p_.sampler.traits(), [](const RayTraits& ray) { return ray.gain != 1.0f; });
    resolution_ = p_.receiver.bandwidth_ghz > 0.0 ? 0.5 * light_speed / (1e9 * p_.receiver.bandwidth_ghz) : p_.receiver.bin_size_m;
  }

  bool detects(const Material& material) const override {
    const WaveMaterial wave = wave_material(material, p_.wave, floor_power_);
    return wave.visible && (!received_ || wave.reflectivity >= receiver_.floor_power());
  }

  std::vector<PhysicsPart> model_of(const Scene& scene, const Platform& platform) const override {
    const Random random(0, index_);
    const TraceContext context(scene, p_.wave, spec().range_min_m, spec().range_max_m, p_.sampler.antenna(), platform.pose * mount_, {}, random, 0);
    std::vector<PhysicsPart> parts = parts_of_world(context);
    if (p_.one_row) parts.push_back(p_.one_row->model_of(context));
    if (!p_.ray_beams) parts.push_back({"beam divergence", p_.sampler.rays_per_beam() > 1 || p_.sampler.drawn_from() > 1, p_.sampler.rays_per_beam() > 1 || p_.sampler.drawn_from() > 1 ? "asked for" : "not asked for: a beam is one ray"});
    return parts;
  }

  void measure(const Scene& scene, const Platform& platform, double time, std::uint64_t number, const Random& random, Scan& scan) const override {
    head(spec(), mount_, index_, time, number, scan);
    const Pose sensor = platform.pose * mount_;
    const glm::dvec3 velocity = platform.velocity + glm::cross(platform.turn_rate, sensor.position - platform.pose.position);
    const TraceContext context(scene, p_.wave, spec().range_min_m, spec().range_max_m, p_.sampler.antenna(), sensor, velocity, random, number);

    if (p_.one_row && p_.one_row->holds(context)) {
      Result result = std::exchange(spare_result(), {});
      result.ground.clear();  // which would be out of reach
      result.returns.resize(1);
      scan.rays += p_.one_row->returns(context, p_.sampler, result.returns.front());
      receive(context, result, scan);
      spare_result() = std::move(result);
      return;
    }
    const std::size_t count = p_.sampler.count();
    const bool own_traits = !p_.sampler.always_the_same(), rays_are_beams = !received_ && (p_.ray_beams || p_.sampler.rays_per_beam() == 1);
    Result result = std::exchange(spare_result(), {});
    const Ground ground = received_ && p_.receiver.floor_gate ? ground_below(context) : Ground{};
    result.ground.resize(ground.material ? count : 0);
    result.own_traits.resize(own_traits ? count : 0);
    result.traits = own_traits ? std::span<const RayTraits>(result.own_traits) : p_.sampler.traits();
    result.traced.resize((count + rays_per_task - 1) / rays_per_task);
    result.returns.resize(result.traced.size());
    scan.beams.resize(rays_are_beams ? count : 0);
    const auto task = [&](std::size_t t) {
      const std::size_t first = t * rays_per_task, size = std::min(count - first, rays_per_task);
      std::array<Ray, rays_per_task> buffer;
      const std::span<Ray> rays = std::span(buffer).first(size);
      p_.sampler.sample(first, sensor, spec().range_max_m, random, number, rays, own_traits ? std::span(result.own_traits).subspan(first, size) : std::span<RayTraits>());
      trace_rays(context, rays, result.traits.subspan(first, size), result.traced[t]);
      if (ground.material)
        for (std::size_t i = 0; i < size; ++i) result.ground[first + i] = from_ground(context, ground, rays[i], result.traits[first + i]);
      if (received_ && p_.ray_beams) {
        result.returns[t].clear();
        for (std::size_t i = first; i < first + size; ++i) add_returns(result, i, result.returns[t]);
      }
      if (weighted_) weigh_by_gain(result.traced[t], result.traits.subspan(first, size));
      if (rays_are_beams) take_rays_as_beams(result.traced[t], rays, result.traits.subspan(first, size), sensor, std::span(scan.beams).subspan(first, size), first);
    };
    if (count < rays_for_threads)
      for (std::size_t t = 0; t < result.traced.size(); ++t) task(t);
    else tbb::parallel_for(std::size_t{0}, result.traced.size(), task);
    for (const Traced& part : result.traced) scan.rays += part.count;

    if (received_) receive(context, result, scan);
    else if (rays_are_beams) take_echoes(result, scan);
    else join_rays(result, random, number, scan);
    if (!received_) finish_beams(random, scan);
    spare_result() = std::move(result);
  }

 private:
  /// The rays of a scan and what came of them.
  struct Result {
    std::vector<Return> ground;         ///< what each ray would bring back from the ground; with a floor gate
    std::vector<RayTraits> own_traits;  ///< if this scan's are its own
    std::span<const RayTraits> traits;
    std::vector<Traced> traced;                 ///< by task
    std::vector<std::vector<Return>> returns;   ///< by task; of a lobe that has a receiver

    const RayEnd& end(std::size_t ray) const { return traced[ray / rays_per_task].rays[ray % rays_per_task]; }
    std::span<const Echo> echoes(std::size_t ray) const {
      const RayEnd& e = end(ray);
      return std::span(traced[ray / rays_per_task].echoes).subspan(e.first_echo, e.echo_count);
    }
  };

  /// A thread's memory for its next scan. (It is taken out while it is used: a thread that waits for the tasks of one scan may begin another.)
  static Result& spare_result() {
    thread_local Result spare;
    return spare;
  }

  const std::vector<double>& azimuths() const { return p_.sampler.antenna().beam_azimuths(); }

  static Beam beam_towards(double azimuth) {
    Beam beam;
    beam.azimuth = azimuth;
    beam.direction = {std::cos(azimuth), std::sin(azimuth), 0.0};
    return beam;
  }
  static Beam beam_along(const glm::dvec3& direction) {
    Beam beam;
    beam.direction = direction;
    beam.azimuth = std::atan2(direction.y, direction.x);
    beam.elevation = std::asin(std::clamp(direction.z, -1.0, 1.0));
    return beam;
  }

  /// Appends a beam and its echoes.
  static void add_beam(Beam beam, std::span<const Echo> echoes, Scan& scan) {
    beam.first_echo = static_cast<std::uint32_t>(scan.echoes.size());
    beam.echo_count = static_cast<std::uint32_t>(echoes.size());
    scan.echoes.insert(scan.echoes.end(), echoes.begin(), echoes.end());
    scan.beams.push_back(beam);
  }

  /// The traced rays of a lobe are what its antenna makes of them: weaker off its axis, and nothing outside its section.
  void weigh_by_gain(Traced& traced, std::span<const RayTraits> traits) const {
    for (std::size_t i = 0; i < traits.size(); ++i) {
      RayEnd& ray = traced.rays[i];
      const auto echoes = std::span(traced.echoes).subspan(ray.first_echo, ray.echo_count);
      std::uint32_t kept = 0;
      for (Echo echo : echoes) {
        echo.amplitude *= traits[i].gain;
        if (traits[i].share > 0.0f && static_cast<double>(echo.amplitude) * static_cast<double>(echo.amplitude) >= floor_power_) echoes[kept++] = echo;
      }
      ray.echo_count = kept;
      if (traits[i].share == 0.0f) ray.sensed_range = 0.0;
    }
  }

  /// Makes the beams of a task's rays; their echoes are counted from the task's first one.
  void take_rays_as_beams(const Traced& traced, std::span<const Ray> rays, std::span<const RayTraits> traits, const Pose& sensor, std::span<Beam> beams, std::size_t first) const {
    const bool moved = p_.ray_beams && !p_.sampler.always_the_same();
    const glm::dmat3 back = moved ? glm::mat3_cast(glm::inverse(sensor.orientation)) : glm::dmat3(1.0);
    for (std::size_t i = 0; i < beams.size(); ++i) {
      const RayEnd& end = traced.rays[i];
      Beam& beam = beams[i];
      if (moved) beam = beam_along(back * rays[i].direction);
      else beam = nominal_[first + i];
      beam.side = traits[i].side;
      beam.first_echo = end.first_echo;
      beam.echo_count = end.echo_count;
      beam.sensed_range = end.sensed_range;
      beam.end = end.end;
      beam.starts_inside = end.starts_inside;
    }
  }
  /// The echoes of all tasks, for beams that are there already.
  static void take_echoes(const Result& result, Scan& scan) {
    std::size_t count = 0;
    for (const Traced& part : result.traced) count += part.echoes.size();
    scan.echoes.reserve(count);
    for (std::size_t t = 0; t < result.traced.size(); ++t) {
      const Traced& part = result.traced[t];
      const auto before = static_cast<std::uint32_t>(scan.echoes.size());
      scan.echoes.insert(scan.echoes.end(), part.echoes.begin(), part.echoes.end());
      if (before > 0)
        for (std::size_t i = 0; i < part.rays.size(); ++i) scan.beams[t * rays_per_task + i].first_echo += before;
    }
  }

  /// What a ray's echo counts for in its beam: a power, or under the printed law an amplitude.
  double strength(const RayTraits& ray, const Echo& echo) const {
    const double amplitude = echo.amplitude;
    return printed_ ? printed_unit_ * static_cast<double>(ray.gain) * amplitude : static_cast<double>(ray.share) * amplitude * amplitude;
  }

  /// The rays of a beam that count: all, or one of each row.
  void choose_rays(const Result& result, std::size_t beam, const Random& random, std::uint64_t number, std::vector<std::size_t>& chosen) const {
    chosen.clear();
    const std::size_t first = beam * p_.sampler.rays_per_beam(), end = first + p_.sampler.rays_per_beam();
    if (p_.choice == Choice::all || p_.choice == Choice::drawn) {
      for (std::size_t ray = first; ray < end; ++ray) chosen.push_back(ray);
      return;
    }
    for (std::size_t row = first; row < end; row += p_.row) {
      // The weight of a ray: how squarely it meets its first surface (one that meets none, as if squarely), or how strong its strongest echo is.
      std::size_t best = row;
      double sum = 0.0;
      std::array<double, most_in_row> weights{};
      for (std::size_t i = 0; i < p_.row; ++i) {
        const auto echoes = result.echoes(row + i);
        if (p_.choice == Choice::incidence) weights[i] = echoes.empty() ? 1.0 : static_cast<double>(echoes.front().incidence_cosine);
        else
          for (const Echo& echo : echoes) weights[i] = std::max(weights[i], static_cast<double>(echo.amplitude));
        if (weights[i] > weights[best - row]) best = row + i;
        sum += weights[i];
      }
      if (p_.choice == Choice::incidence) {
        double chance = sum * random.uniform(number, static_cast<std::uint32_t>(beam), RandomUse::ray_choice, static_cast<std::uint32_t>((row - first) / p_.row))[0];
        best = row;
        for (std::size_t i = 0; i + 1 < p_.row && chance >= weights[i]; ++i, ++best) chance -= weights[i];
      }
      chosen.push_back(best);
    }
  }

  /// How much a chosen ray stands for: for its whole row, where one was chosen of it.
  double standing_for() const { return static_cast<double>(p_.choice == Choice::all ? 1 : p_.choice == Choice::drawn ? p_.sampler.drawn_from() : p_.row); }

  /// Beams of several rays: echoes that the receiver's bandwidth does not tell apart are one.
  void join_rays(const Result& result, const Random& random, std::uint64_t number, Scan& scan) const {
    struct Member {
      Echo echo;
      double strength;
    };
    std::vector<std::size_t> chosen;
    std::vector<Member> members;
    std::vector<Echo> joined;
    for (std::size_t b = 0; b < azimuths().size(); ++b) {
      choose_rays(result, b, random, number, chosen);
      Beam beam = nominal_[b];
      beam.side = chosen.size() == 1 ? result.traits[chosen[0]].side : std::int8_t{0};
      members.clear();
      for (const std::size_t ray : chosen) {
        const RayEnd& end = result.end(ray);
        if (ray == chosen[0] || end.sensed_range > beam.sensed_range) {
          beam.sensed_range = end.sensed_range;
          beam.end = end.end;
        }
        beam.starts_inside = beam.starts_inside || end.starts_inside;
        for (const Echo& echo : result.echoes(ray)) members.push_back({echo, standing_for() * strength(result.traits[ray], echo)});
      }
      std::stable_sort(members.begin(), members.end(), [](const Member& x, const Member& y) { return x.echo.range < y.echo.range; });
      joined.clear();
      for (std::size_t i = 0; i < members.size();) {
        const std::size_t first = i;
        std::size_t strongest = i;
        double sum = 0.0, range = 0.0, cosine = 0.0, velocity = 0.0;
        for (; i < members.size() && members[i].echo.range - members[first].echo.range <= (chosen.size() > 1 ? resolution_ : 0.0); ++i) {
          const auto& [echo, strength] = members[i];
          if (strength > members[strongest].strength) strongest = i;
          sum += strength;
          range += strength * echo.range;
          cosine += strength * static_cast<double>(echo.incidence_cosine);
          velocity += strength * static_cast<double>(echo.radial_velocity);
        }
        const double amplitude = printed_ ? sum : std::sqrt(sum);
        if (!(sum > 0.0) || amplitude * amplitude < floor_power_) continue;
        Echo echo = members[strongest].echo;
        echo.amplitude = static_cast<float>(amplitude);
        if (i - first > 1) {
          echo.range = range / sum;
          echo.incidence_cosine = static_cast<float>(cosine / sum);
          echo.radial_velocity = static_cast<float>(velocity / sum);
        }
        joined.push_back(echo);
      }
      add_beam(beam, joined, scan);
    }
  }

  void add_returns(const Result& result, std::size_t ray, std::vector<Return>& returns) const {
    for (const Echo& echo : result.echoes(ray)) returns.push_back({echo.range, static_cast<float>(standing_for() * strength(result.traits[ray], echo)), echo.radial_velocity});
  }

  /// As the receiver sees it: a profile for each beam, and its detections.
  void receive(const TraceContext& context, const Result& result, Scan& scan) const {
    const std::size_t beams = azimuths().size();
    receiver_.start(beams, scan.profiles);
    std::vector<std::vector<Echo>> detections(beams);
    const auto one_beam = [&](std::size_t b) {
      std::vector<std::size_t> chosen;
      std::vector<Return> returns, ground;
      if (p_.ray_beams) {  // the beam is all there is
        for (const auto& part : result.returns) returns.insert(returns.end(), part.begin(), part.end());
        ground = result.ground;
      } else {
        choose_rays(result, b, context.random, context.scan, chosen);
        for (const std::size_t ray : chosen) {
          add_returns(result, ray, returns);
          if (!result.ground.empty()) ground.push_back(result.ground[ray]);
        }
      }
      receiver_.receive(returns, ground, context.random, context.scan, static_cast<std::uint32_t>(b), scan.profiles, detections[b]);
    };
    if (beams == 1) one_beam(0);
    else tbb::parallel_for(std::size_t{0}, beams, one_beam);
    scan.azimuth_opening = p_.sampler.antenna().opening().x;
    scan.elevation_opening = p_.sampler.antenna().opening().y;
    for (std::size_t b = 0; b < beams; ++b) {
      Beam beam = nominal_[b];
      // A receiver cannot tell what stopped the wave: it knows nothing of what lies behind its last detection.
      beam.end = detections[b].empty() ? BeamEnd::open : BeamEnd::stopped;
      beam.sensed_range = detections[b].empty() ? spec().range_max_m : detections[b].back().range;
      add_beam(beam, detections[b], scan);
    }
  }

  /// The ground below the sensor, as an altimeter tells it: a plane.
  struct Ground {
    double depth = 0.0;                      ///< m below the sensor
    const WaveMaterial* material = nullptr;  ///< nothing if there is no ground
  };
  Ground ground_below(const TraceContext& context) const {
    const Ray down{context.sensor.position, {0.0, 0.0, -1.0}, infinity};
    Hit hit;
    context.scene.closest_hits({&down, 1}, Stops::motion, {&hit, 1});
    if (hit.solid == no_solid || !(hit.range > 0.0)) return {};
    return {hit.range, &context.materials[context.scene.material(hit.solid)]};
  }
  /// What a ray would bring back from the ground if nothing else were there; nothing from where it does not meet it.
  Return from_ground(const TraceContext& context, const Ground& ground, const Ray& ray, const RayTraits& traits) const {
    const double cosine = -ray.direction.z;
    if (!(cosine > 0.0)) return {};
    const double range = (ground.depth + (ray.origin.z - context.sensor.position.z)) / cosine;
    if (!(range > 0.0) || range > spec().range_max_m) return {};
    const double ratio = range / spec().range_max_m, back = backscatter(*ground.material, ground.material->reflectivity, cosine, traits.spread);
    const double strength = printed_ ? printed_unit_ * static_cast<double>(traits.gain) * cosine * ratio * ratio * std::sqrt(ground.material->reflectivity)
                                     : static_cast<double>(traits.share) * back / (p_.wave.range_compensation ? 1.0 : ratio * ratio);
    return {range, static_cast<float>(strength), 0.0f};
  }

  void finish_beams(const Random& random, Scan& scan) const {
    if (p_.first_echo_only) {
      for (Beam& beam : scan.beams) {
        if (beam.echo_count == 0) continue;
        beam.echo_count = 1;
        beam.end = BeamEnd::stopped;
        beam.sensed_range = scan.echoes[beam.first_echo].range;
      }
    }
    if (spec().range_noise_m <= 0.0) return;
    BeamNoise noise(random, scan.number);
    for (std::size_t b = 0; b < scan.beams.size(); ++b) {
      Beam& beam = scan.beams[b];
      if (beam.end == BeamEnd::open && beam.echo_count == 0) continue;
      shift_beam(beam, std::span(scan.echoes).subspan(beam.first_echo, beam.echo_count), spec().range_noise_m * noise.of(b), spec().range_max_m);
    }
  }

  Parts p_;
  std::uint16_t index_;
  Pose mount_;
  bool received_, printed_, weighted_ = false;  ///< weighted: traced rays count by the antenna's gain
  Receiver receiver_;
  double floor_power_;
  std::vector<Beam> nominal_;     ///< where the beams look
  double printed_unit_ = 1.0;     ///< I_m of eq. 4.2: a metal plate at range_max_m that fills the opening squarely is 1 in all
  double resolution_ = 0.0;       ///< m
};

template <class Spec>
Parts parts_of(const Spec& spec, std::size_t drawn_from) {
  return {.mounted = spec, .wave = spec, .receiver = spec, .sampler = RaySampler(Antenna(spec), spec.sampling == "jitter", drawn_from), .one_row = std::nullopt};
}

}  // namespace

std::shared_ptr<const Sensor> make_radar(const ScanningRadarSpec& spec, std::uint16_t index) {
  const Choice choice = choice_of(spec);
  const std::size_t row = choice == Choice::all ? 1 : most_in_row;
  Parts parts = parts_of(spec, choice == Choice::drawn ? row : 1);
  parts.choice = choice;
  parts.row = choice == Choice::drawn ? 1 : row;
  parts.first_echo_only = spec.first_echo_only;
  return std::make_shared<Radar>(std::move(parts), index);
}

std::shared_ptr<const Sensor> make_radar(const LobeRadarSpec& spec, std::uint16_t index) {
  Parts parts = parts_of(spec, 1);
  parts.ray_beams = true;
  parts.one_row = OneRow::make(spec, parts.sampler);
  return std::make_shared<Radar>(std::move(parts), index);
}

}  // namespace thicket
