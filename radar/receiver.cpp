#include "receiver.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

#include "thicket/base/pose.hpp"
#include "turns.hpp"
#include "wave.hpp"

namespace thicket {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

/// Where the pulse's field ends, in its standard deviations: power is down by 80 dB.
constexpr double pulse_end = 4.3;
/// No pulse is longer than this either way: that is as many bins as a receiver may have.
constexpr double longest_pulse_bins = 1e6;
/// Under the floor gate a top takes the threshold and this many times the ground's amplitude: noise rides on what the ground returns, which is not quite that of the even ground that is counted on.
constexpr float floor_gate_margin = 1.5f;
/// Bins whose signal is worked out together; small enough for their sums to stay in registers.
constexpr std::size_t block = 16;
/// Returns whose phases are worked out together.
constexpr std::size_t phases_at_a_time = 64;
/// The draws of the random walk come after those of the white noise, of which there are at most one for two bins.
constexpr std::uint32_t first_walk_draw = 1u << 23;

constexpr std::size_t up_to_block(std::size_t count) { return (count + block - 1) / block * block; }

/// Four at a time, as every processor of the platform can.
using Four [[gnu::vector_size(16)]] = float;
Four load(const float* from) {
  Four four;
  std::memcpy(&four, from, sizeof four);
  return four;
}

/// The signal of a block of bins: what is in each and before and behind it, as the (symmetrical) pulse weighs it.
void spread_block(const float* in, std::span<const float> pulse, float* out) {
  static_assert(block == 16);
  Four a = pulse[0] * load(in), b = pulse[0] * load(in + 4), c = pulse[0] * load(in + 8), d = pulse[0] * load(in + 12);
  const float *before = in, *behind = in;
  for (const float weight : pulse.subspan(1)) {
    --before;
    ++behind;
    a += weight * (load(before) + load(behind));
    b += weight * (load(before + 4) + load(behind + 4));
    c += weight * (load(before + 8) + load(behind + 8));
    d += weight * (load(before + 12) + load(behind + 12));
  }
  std::memcpy(out, &a, sizeof a);
  std::memcpy(out + 4, &b, sizeof b);
  std::memcpy(out + 8, &c, sizeof c);
  std::memcpy(out + 12, &d, sizeof d);
}

}  // namespace

/// What one call needs while it works; each thread keeps its own, and its memory.
struct Receiver::Scratch {
  // One part, or two: the in-phase and the quadrature part of a field.
  std::array<std::vector<double>, 2> added;   // in each bin, from `margin_` bins before the profile on
  std::array<std::vector<float>, 2> line;     // the same
  std::array<std::vector<float>, 2> signal;   // of the profile's bins, up to a whole block
  std::vector<float> ground;                  // amplitude
  std::vector<double> sums;                   // of what is before a bin
  std::vector<double> weight, moving;         // of the returns nearest to a bin: their strength, and its product with their velocity
};

Receiver::Receiver(const ReceiverSpec& spec, const RadarSpec& wave, double range_min, double range_max)
    : sum_(spec.signal == "iq" ? Sum::fields : wave.law == "printed" ? Sum::amplitudes : Sum::powers),
      first_range_(spec.bin_offset_m),
      bin_size_(spec.bin_size_m),
      range_min_(range_min),
      range_max_(range_max),
      half_waves_per_m_(2.0 * wave.frequency_ghz * 1e9 / light_speed),
      walk_(spec.noise_walk),
      clutter_(spec.clutter_floor),
      saturation_(spec.saturation),
      threshold_(spec.threshold),
      smoothed_before_(spec.smoothing_bins / 2),
      smoothed_after_((spec.smoothing_bins - 1) / 2),
      training_(spec.cfar_training_bins),
      guard_(spec.cfar_guard_bins),
      floor_gate_(spec.floor_gate),
      pick_(spec.detection == "first" ? Pick::first : spec.detection == "strongest" ? Pick::strongest : Pick::all) {
  // (A billionth of a bin: 0.3 / 0.1 is 2.9999999999999996.)
  const double last_place = std::floor((range_max_ - first_range_) / bin_size_ + 1e-9), first_place = std::ceil((range_min_ - first_range_) / bin_size_ - 1e-9);
  bins_ = spec.bin_count > 0 ? static_cast<std::uint32_t>(spec.bin_count) : static_cast<std::uint32_t>(std::clamp(last_place + 1.0, 1.0, 16e6));
  first_seen_ = static_cast<std::int64_t>(std::clamp(first_place, 0.0, static_cast<double>(bins_)));
  last_seen_ = static_cast<std::int64_t>(std::clamp(last_place, -1.0, bins_ - 1.0));

  // The field's envelope exp(-t^2 / (2 s^2)) has the power spectrum exp(-(2 pi f)^2 s^2), which is 1/10 at half the bandwidth. A way there and back takes twice as long.
  const double deviation = spec.bandwidth_ghz > 0.0 ? 0.5 * light_speed * std::sqrt(std::log(10.0)) / (pi * spec.bandwidth_ghz * 1e9) / bin_size_ : 0.0;
  const auto reach = static_cast<std::size_t>(std::min(pulse_end * deviation, longest_pulse_bins));
  pulse_.assign(1, 1.0f);
  for (std::size_t bin = 1; bin <= reach; ++bin) {
    const double x = static_cast<double>(bin) / deviation;
    pulse_.push_back(static_cast<float>(std::exp((sum_ == Sum::powers ? -1.0 : -0.5) * x * x)));
  }
  margin_ = up_to_block(pulse_.size());
  velocity_reach_ = std::max<std::int64_t>(1, static_cast<std::int64_t>(pulse_.size()) - 1) + smoothed_after_;

  const double root = std::sqrt(static_cast<double>(spec.smoothing_bins)), rate = spec.false_alarm_rate;
  noise_ = spec.noise ? *spec.noise : threshold_ * root / (sum_ == Sum::fields ? std::sqrt(-2.0 * std::log(rate)) : -normal_quantile(rate));
  if (spec.detector == "ca_cfar") {
    // Of exponential power, as that of noise of I and Q is, exactly `rate` exceeds the mean of n others by n (rate^(-1/n) - 1); the sum of them by what is kept here.
    cfar_factor_.push_back(infinite);
    for (std::int64_t n = 1; n <= std::min<std::int64_t>(2 * training_, bins_); ++n) cfar_factor_.push_back(std::expm1(-std::log(rate) / static_cast<double>(n)));
  }
  floor_power_ = find_floor_power();
}

double Receiver::find_floor_power() const {
  const auto smoothed = static_cast<double>(smoothed_before_ + 1 + smoothed_after_);
  double threshold = threshold_;
  const double clutter_power = clutter_ * clutter_ / (sum_ == Sum::fields ? smoothed : 1.0);
  if (!cfar_factor_.empty()) {
    const double noise_power = (sum_ == Sum::fields ? 2.0 : 1.0) * noise_ * noise_ / smoothed;
    threshold = std::sqrt(static_cast<double>(cfar_factor_.size() - 1) * cfar_factor_.back() * (noise_power + clutter_power));
  }
  if (clutter_power >= threshold * threshold) return 0.0;
  if (saturation_ < threshold) return infinite;
  // Amplitudes (or fields) of a return of power 1 in the bins that are averaged.
  std::vector<double> spread;
  double sum = 0.0;
  for (std::int64_t bin = -smoothed_before_; bin <= smoothed_after_; ++bin) {
    const auto distance = static_cast<std::size_t>(std::abs(bin));
    if (distance >= pulse_.size()) continue;
    spread.push_back(sum_ == Sum::powers ? std::sqrt(static_cast<double>(pulse_[distance])) : static_cast<double>(pulse_[distance]));
    sum += spread.back();
  }
  if (sum_ == Sum::fields) return (threshold * threshold - clutter_power) * (smoothed / sum) * (smoothed / sum);
  if (clutter_ == 0.0) return (threshold * smoothed / sum) * (threshold * smoothed / sum);
  // The mean amplitude bends down as the power grows, so Newton's steps from 0 never go too far.
  double power = 0.0;
  for (int step = 0; step < 200; ++step) {
    double mean = (smoothed - static_cast<double>(spread.size())) * clutter_ / smoothed, slope = 0.0;
    for (const double of_one : spread) {
      const double amplitude = std::sqrt(power * of_one * of_one + clutter_power);
      mean += amplitude / smoothed;
      slope += 0.5 * of_one * of_one / amplitude / smoothed;
    }
    const double more = (threshold - mean) / slope;
    power += more;
    if (more <= 1e-15 * power) break;
  }
  return power;
}

void Receiver::start(std::size_t beams, Profiles& profiles) const {
  profiles.bins = bins_;
  profiles.first_range = first_range_;
  profiles.bin_size = bin_size_;
  profiles.amplitude.resize(beams * bins_);
  profiles.threshold.resize(beams * bins_);
  profiles.iq.resize(sum_ == Sum::fields ? beams * bins_ : 0);
}

bool Receiver::deposit(std::span<const Return> returns, Scratch& scratch) const {
  const std::size_t whole = up_to_block(bins_), length = margin_ + whole + margin_;
  for (std::size_t part = 0; part < parts(); ++part) scratch.added[part].assign(length, 0.0);
  // Everything that the loops need, where the compiler sees that the sums do not change it.
  const double range_min = range_min_, range_max = range_max_, first_range = first_range_, bin_size = bin_size_;
  const double margin = static_cast<double>(margin_), end = static_cast<double>(length - 1);
  /// How many bins from the start of `added` on; negative for what does not count.
  const auto place_of = [=](double range) {
    const double place = (range - first_range) / bin_size + margin;
    return range >= range_min && range <= range_max && place < end ? place : -1.0;
  };
  std::uint32_t any_velocity = 0;
  if (sum_ != Sum::fields) {
    double* const added = scratch.added[0].data();
    for (const Return& r : returns) {
      const double place = place_of(r.range);
      if (!(place >= 0.0)) continue;
      const auto bin = static_cast<std::int64_t>(place);
      const double strength = static_cast<double>(r.strength), farther = strength * (place - static_cast<double>(bin));
      added[bin] += strength - farther;
      added[bin + 1] += farther;
      any_velocity |= std::bit_cast<std::uint32_t>(r.radial_velocity);
    }
  } else {
    double *const in_phase = scratch.added[0].data(), *const quadrature = scratch.added[1].data();
    std::array<double, phases_at_a_time> turns{}, cosine, sine;
    for (std::size_t first = 0; first < returns.size(); first += phases_at_a_time) {
      const auto some = returns.subspan(first, std::min(phases_at_a_time, returns.size() - first));
      for (std::size_t i = 0; i < some.size(); ++i) turns[i] = some[i].range * half_waves_per_m_;
      cosine_and_sine(turns, cosine, sine);
      for (std::size_t i = 0; i < some.size(); ++i) {
        const double place = place_of(some[i].range);
        if (!(place >= 0.0)) continue;
        const auto bin = static_cast<std::int64_t>(place);
        const double share = place - static_cast<double>(bin), field = std::sqrt(static_cast<double>(some[i].strength));
        const double re = field * cosine[i], im = -field * sine[i];  // the phase falls with the way
        in_phase[bin] += re - re * share;
        in_phase[bin + 1] += re * share;
        quadrature[bin] += im - im * share;
        quadrature[bin + 1] += im * share;
        any_velocity |= std::bit_cast<std::uint32_t>(some[i].radial_velocity);
      }
    }
  }
  for (std::size_t part = 0; part < parts(); ++part) spread(scratch, part);
  return any_velocity != 0;
}

void Receiver::spread(Scratch& scratch, std::size_t part) const {
  const std::vector<double>& added = scratch.added[part];
  std::vector<float>&line = scratch.line[part], &signal = scratch.signal[part];
  const std::size_t whole = up_to_block(bins_);
  line.resize(added.size());
  signal.assign(whole, 0.0f);
  for (std::size_t i = 0; i < added.size(); ++i) line[i] = static_cast<float>(added[i]);
  if (pulse_.size() == 1) {
    std::copy_n(line.begin() + static_cast<std::ptrdiff_t>(margin_), whole, signal.begin());
    return;
  }
  // Only the blocks that something reaches; the others stay 0.
  const std::size_t reach = pulse_.size() - 1;
  std::size_t next = 0;
  for (std::size_t from = 0; from < line.size(); from += block) {
    bool empty = true;
    for (std::size_t i = from; i < from + block; ++i) empty &= line[i] == 0.0f;
    if (empty || from + block - 1 + reach < margin_) continue;
    const std::size_t nearest = from > margin_ + reach ? (from - margin_ - reach) / block * block : 0, end = std::min(whole, from + block + reach - margin_);
    for (next = std::max(next, nearest); next < end; next += block) spread_block(line.data() + margin_ + next, pulse_, signal.data() + next);
  }
}

void Receiver::add_noise(const Random& random, std::uint64_t scan, std::uint32_t beam, Scratch& scratch) const {
  const std::size_t stride = 4 / parts();  // bins a draw is for
  // Clutter of random phase is one more noise; in amplitudes it has been added as a power.
  const double white = sum_ == Sum::fields ? std::sqrt(noise_ * noise_ + 0.5 * clutter_ * clutter_) : noise_;
  const auto draw = [&](std::uint32_t first_draw, auto&& use) {
    for (std::size_t bin = 0; bin < bins_; bin += stride)
      use(bin, random.normal(scan, beam, RandomUse::receiver, first_draw + static_cast<std::uint32_t>(bin / stride)));
  };
  if (white > 0.0) {
    draw(0, [&](std::size_t bin, const std::array<double, 4>& numbers) {
      if (stride == 4) {
        for (std::size_t i = 0; i < 4; ++i) scratch.signal[0][bin + i] += static_cast<float>(white * numbers[i]);
      } else {
        for (std::size_t i = 0; i < 4; ++i) scratch.signal[i % 2][bin + i / 2] += static_cast<float>(white * numbers[i]);
      }
    });
  }
  if (walk_ > 0.0) {
    std::array<double, 2> wandered{};
    draw(first_walk_draw, [&](std::size_t bin, const std::array<double, 4>& numbers) {
      for (std::size_t i = 0; i < 4; ++i) {
        double& w = wandered[i % parts()];
        w += walk_ * numbers[i];
        scratch.signal[i % parts()][bin + i / parts()] += static_cast<float>(w);
      }
    });
  }
}

void Receiver::smooth(std::vector<float>& values, Scratch& scratch) const {
  if (smoothed_before_ + smoothed_after_ == 0) return;
  std::vector<double>& sums = scratch.sums;
  sums.resize(bins_ + 1);
  sums[0] = 0.0;
  for (std::size_t i = 0; i < bins_; ++i) sums[i + 1] = sums[i] + static_cast<double>(values[i]);
  const auto before = static_cast<std::size_t>(smoothed_before_), after = static_cast<std::size_t>(smoothed_after_), bins = std::size_t{bins_};
  const auto at_edge = [&](std::size_t i) {
    const std::size_t from = i > before ? i - before : 0, to = std::min(bins, i + after + 1);
    values[i] = static_cast<float>((sums[to] - sums[from]) / static_cast<double>(to - from));
  };
  const std::size_t inner = std::min(before, bins), inner_end = std::max(inner, bins > after ? bins - after : 0);
  for (std::size_t i = 0; i < inner; ++i) at_edge(i);
  const double count = static_cast<double>(before + 1 + after);
  for (std::size_t i = inner; i < inner_end; ++i) values[i] = static_cast<float>((sums[i + after + 1] - sums[i - before]) / count);
  for (std::size_t i = inner_end; i < bins; ++i) at_edge(i);
}

void Receiver::amplitude_of_ground(std::span<const Return> ground, Scratch& scratch) const {
  deposit(ground, scratch);
  std::vector<float>& signal = scratch.signal[0];
  if (sum_ == Sum::powers)
    for (float& s : signal) s = std::sqrt(s);
  for (std::size_t part = 0; part < parts(); ++part) smooth(scratch.signal[part], scratch);
  scratch.ground.assign(signal.begin(), signal.end());
  if (sum_ != Sum::fields) return;
  const std::vector<float>& quadrature = scratch.signal[1];
  for (std::size_t i = 0; i < bins_; ++i) scratch.ground[i] = std::sqrt(signal[i] * signal[i] + quadrature[i] * quadrature[i]);
}

void Receiver::cfar_threshold(std::span<const float> amplitude, std::span<float> threshold, Scratch& scratch) const {
  std::vector<double>& sums = scratch.sums;
  sums.resize(bins_ + 1);
  sums[0] = 0.0;
  for (std::size_t i = 0; i < bins_; ++i) sums[i + 1] = sums[i] + static_cast<double>(amplitude[i]) * static_cast<double>(amplitude[i]);
  const auto bins = static_cast<std::int64_t>(bins_);
  const auto at_edge = [&](std::int64_t i) {
    const auto sum_to = [&](std::int64_t bin) { return sums[static_cast<std::size_t>(std::clamp<std::int64_t>(bin, 0, bins))]; };
    const auto count = [&](std::int64_t from, std::int64_t to) { return std::max<std::int64_t>(0, std::min(to, bins) - std::max<std::int64_t>(from, 0)); };
    const std::int64_t near_from = i - guard_ - training_, near_to = i - guard_, far_from = i + guard_ + 1, far_to = far_from + training_;
    const std::int64_t n = count(near_from, near_to) + count(far_from, far_to);
    const double sum = (sum_to(near_to) - sum_to(near_from)) + (sum_to(far_to) - sum_to(far_from));
    threshold[static_cast<std::size_t>(i)] = static_cast<float>(n == 0 ? infinite : std::sqrt(std::max(0.0, sum) * cfar_factor_[static_cast<std::size_t>(n)]));
  };
  const std::int64_t reach = guard_ + training_, inner = std::min(reach, bins), inner_end = std::max(inner, bins - reach);
  for (std::int64_t i = 0; i < inner; ++i) at_edge(i);
  if (inner < inner_end) {
    const double factor = cfar_factor_[static_cast<std::size_t>(2 * training_)];
    const double *near_from = sums.data(), *near_to = near_from + training_, *far_from = near_to + 2 * guard_ + 1, *far_to = far_from + training_;
    float* const out = threshold.data() + inner;
    for (std::int64_t i = 0; i < inner_end - inner; ++i) {
      const double sum = (near_to[i] - near_from[i]) + (far_to[i] - far_from[i]);
      out[i] = static_cast<float>(std::sqrt((sum > 0.0 ? sum : 0.0) * factor));
    }
  }
  for (std::int64_t i = inner_end; i < bins; ++i) at_edge(i);
}

void Receiver::detect(std::span<const float> amplitude, std::span<const float> threshold, std::vector<Echo>& detections) const {
  const std::size_t before = detections.size(), bins = bins_;
  for (std::int64_t b = first_seen_; b <= last_seen_; ++b) {
    const auto bin = static_cast<std::size_t>(b);
    const float a = amplitude[bin];
    if (!(a >= threshold[bin] && a > 0.0f)) continue;
    // Smoothing and saturation make tops that are as wide as many bins: what made them is in the middle.
    std::size_t from = bin, to = bin;
    while (from > 0 && amplitude[from - 1] == a) --from;
    while (to + 1 < bins && amplitude[to + 1] == a) ++to;
    const std::size_t middle = (from + to) / 2;
    b = static_cast<std::int64_t>(to);
    if ((from > 0 && amplitude[from - 1] > a) || (to + 1 < bins && amplitude[to + 1] > a)) continue;
    if (static_cast<std::int64_t>(middle) < first_seen_ || static_cast<std::int64_t>(middle) > last_seen_) continue;
    if (pick_ == Pick::strongest && detections.size() > before) {
      if (a <= detections.back().amplitude) continue;
      detections.pop_back();
    }
    Echo echo;
    echo.range = first_range_ + static_cast<double>(middle) * bin_size_;
    echo.amplitude = a;
    detections.push_back(echo);
    if (pick_ == Pick::first) return;
  }
}

void Receiver::set_velocities(std::span<const Return> returns, std::span<Echo> tops, Scratch& scratch) const {
  scratch.weight.assign(bins_, 0.0);
  scratch.moving.assign(bins_, 0.0);
  for (const Return& r : returns) {
    const double place = (r.range - first_range_) / bin_size_ + 0.5;
    if (!(r.range >= range_min_ && r.range <= range_max_ && place >= 0.0 && place < static_cast<double>(bins_))) continue;
    const auto bin = static_cast<std::size_t>(place);
    scratch.weight[bin] += static_cast<double>(r.strength);
    scratch.moving[bin] += static_cast<double>(r.strength) * static_cast<double>(r.radial_velocity);
  }
  for (Echo& top : tops) {
    const std::int64_t bin = std::llround((top.range - first_range_) / bin_size_);
    const std::int64_t end = std::min<std::int64_t>(bins_, bin + velocity_reach_ + 1);
    double weight = 0.0, moving = 0.0;
    for (std::int64_t b = std::max<std::int64_t>(0, bin - velocity_reach_); b < end; ++b) {
      // As the pulse weighs it; what smoothing brings in is as near as its pulse's.
      const auto off = static_cast<std::size_t>(std::max<std::int64_t>(0, std::abs(b - bin) - smoothed_after_));
      const double share = off < pulse_.size() ? static_cast<double>(pulse_[off]) : 1.0;
      weight += share * scratch.weight[static_cast<std::size_t>(b)];
      moving += share * scratch.moving[static_cast<std::size_t>(b)];
    }
    if (weight > 0.0) top.radial_velocity = static_cast<float>(moving / weight);
  }
}

void Receiver::receive(std::span<const Return> returns, std::span<const Return> ground, const Random& random, std::uint64_t scan, std::uint32_t beam, Profiles& profiles,
                       std::vector<Echo>& detections) const {
  thread_local Scratch scratch;
  const std::size_t offset = static_cast<std::size_t>(beam) * bins_;
  const auto amplitude = std::span(profiles.amplitude).subspan(offset, bins_), threshold = std::span(profiles.threshold).subspan(offset, bins_);

  const bool moves = deposit(returns, scratch);
  std::vector<float>& signal = scratch.signal[0];
  const auto clutter_power = static_cast<float>(clutter_ * clutter_);
  if (sum_ == Sum::powers)
    for (float& s : signal) s = std::sqrt(s + clutter_power);
  else if (sum_ == Sum::amplitudes && clutter_ > 0.0)
    for (float& s : signal) s = std::sqrt(s * s + clutter_power);
  add_noise(random, scan, beam, scratch);
  for (std::size_t part = 0; part < parts(); ++part) smooth(scratch.signal[part], scratch);

  const auto saturation = static_cast<float>(saturation_);
  if (sum_ == Sum::fields) {
    const std::vector<float>& quadrature = scratch.signal[1];
    for (std::size_t i = 0; i < bins_; ++i) amplitude[i] = std::min(std::sqrt(signal[i] * signal[i] + quadrature[i] * quadrature[i]), saturation);
    for (std::size_t i = 0; i < bins_; ++i) profiles.iq[offset + i] = {signal[i], quadrature[i]};
  } else {
    for (std::size_t i = 0; i < bins_; ++i) amplitude[i] = std::min(signal[i], saturation);
  }

  if (cfar_factor_.empty()) std::fill(threshold.begin(), threshold.end(), static_cast<float>(threshold_));
  else cfar_threshold(amplitude, threshold, scratch);
  if (floor_gate_ && !ground.empty()) {
    amplitude_of_ground(ground, scratch);
    for (std::size_t i = 0; i < bins_; ++i) threshold[i] += floor_gate_margin * scratch.ground[i];
  }

  const std::size_t before = detections.size();
  detect(amplitude, threshold, detections);
  if (moves && detections.size() > before) set_velocities(returns, std::span(detections).subspan(before), scratch);
}

}  // namespace thicket
