// The receiver, against closed forms and counted false alarms.
#include "receiver.hpp"

#include <doctest/doctest.h>
#include <rapidcheck.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <limits>
#include <thread>
#include <vector>

#include "thicket/base/pose.hpp"

using namespace thicket;

namespace {

constexpr double light_speed = 299792458.0;

/// Standard deviation in range, m, of the field of a pulse with a bandwidth in GHz at -10 dB.
double pulse_deviation(double bandwidth_ghz) {
  return 0.5 * light_speed * std::sqrt(std::log(10.0)) / (pi * bandwidth_ghz * 1e9);
}

/// A receiver without noise whose threshold nothing but a return exceeds.
ReceiverSpec quiet() {
  ReceiverSpec spec;
  spec.noise = 0.0;
  spec.threshold = 1e-6;
  spec.bin_size_m = 0.01;
  spec.bin_count = 1000;
  spec.detection = "all";
  return spec;
}
RadarSpec x4_wave() {
  RadarSpec wave;
  wave.frequency_ghz = 7.29;
  return wave;
}
RadarSpec printed() {
  RadarSpec wave = x4_wave();
  wave.law = "printed";
  return wave;
}

/// One receiver, and what it last measured.
struct Bench {
  Receiver receiver;
  Profiles profiles;
  std::vector<Echo> found;
  Random random{1, 0};

  explicit Bench(const ReceiverSpec& spec, const RadarSpec& wave = x4_wave(), double range_min = 0.0, double range_max = 100.0) : receiver(spec, wave, range_min, range_max) {
    receiver.start(1, profiles);
  }
  Bench& receive(const std::vector<Return>& returns, std::uint64_t scan = 0, const std::vector<Return>& ground = {}) {
    found.clear();
    receiver.receive(returns, ground, random, scan, 0, profiles, found);
    return *this;
  }
  double operator[](std::size_t bin) const { return static_cast<double>(profiles.amplitude[bin]); }
  double sum() const {
    double sum = 0.0;
    for (const float a : profiles.amplitude) sum += static_cast<double>(a);
    return sum;
  }
};

doctest::Approx about(double value) { return doctest::Approx(value).epsilon(1e-5); }

/// Bins whose amplitude reaches the threshold, of `scans` scans without returns.
struct Alarms {
  double bins = 0.0, alarms = 0.0;
  double rate() const { return alarms / bins; }
  /// That `chance` is what was counted, but for 4 standard deviations of the count (more where `together` bins are not independent).
  bool agree_with(double chance, double together = 1.0) const { return std::abs(rate() - chance) < 4.0 * std::sqrt(together * chance * (1.0 - chance) / bins); }
};
/// `edge` bins at either end do not count.
Alarms false_alarms(const ReceiverSpec& spec, std::uint64_t scans, std::size_t edge = 0) {
  Bench bench(spec);
  Alarms counted;
  for (std::uint64_t scan = 0; scan < scans; ++scan) {
    bench.receive({}, scan);
    for (std::size_t bin = edge; bin + edge < bench.receiver.bins(); ++bin) {
      counted.bins += 1.0;
      counted.alarms += bench.profiles.amplitude[bin] >= bench.profiles.threshold[bin];
    }
  }
  return counted;
}

bool same_bits(const std::vector<float>& a, const std::vector<float>& b) { return a == b; }

}  // namespace

// --- bins ---

TEST_CASE("receiver: a pulse no longer than a bin is shared by the two bins that a return is between") {
  Bench bench(quiet());
  bench.receive({{2.0, 0.25f}});
  CHECK(bench[200] == about(0.5));
  CHECK(bench.sum() == about(0.5));
  bench.receive({{2.0025, 0.16f}});  // a quarter of the way to the next bin
  CHECK(bench[200] == about(std::sqrt(0.75 * 0.16)));
  CHECK(bench[201] == about(std::sqrt(0.25 * 0.16)));
  CHECK(bench[199] == 0.0);
  CHECK(bench[202] == 0.0);
}

TEST_CASE("receiver: bins start at the offset, and returns on both sides of the profile are left out") {
  ReceiverSpec spec = quiet();
  spec.bin_offset_m = -0.18;
  spec.bin_count = 40;
  Bench bench(spec);
  CHECK(bench.profiles.first_range == -0.18);
  CHECK(bench.profiles.bin_size == 0.01);
  CHECK(bench.profiles.amplitude.size() == 40);
  CHECK(bench.profiles.iq.empty());
  bench.receive({{0.02, 1.0f}});
  CHECK(bench[20] == about(1.0));
  bench.receive({{0.0, 1.0f}, {0.21, 4.0f}});
  CHECK(bench[18] == about(1.0));
  CHECK(bench[39] == about(2.0));
  bench.receive({{0.215, 1.0f}});  // half of it is beyond the last bin
  CHECK(bench[39] == about(std::sqrt(0.5)));
  bench.receive({{0.22, 1.0f}, {5.0, 1.0f}, {99.0, 1.0f}, {std::numeric_limits<double>::quiet_NaN(), 1.0f}, {std::numeric_limits<double>::infinity(), 1.0f}});
  CHECK(bench.sum() < 1e-5);
}

TEST_CASE("receiver: returns out of the sensor's range are left out, those at its ends are not") {
  Bench bench(quiet(), x4_wave(), 1.0, 3.0);
  bench.receive({{0.9999, 1.0f}, {3.0001, 1.0f}, {-5.0, 1.0f}});
  CHECK(bench.sum() == 0.0);
  bench.receive({{1.0, 1.0f}, {3.0, 1.0f}});
  CHECK(bench[100] == about(1.0));
  CHECK(bench[300] == about(1.0));
  REQUIRE(bench.found.size() == 2);
}

TEST_CASE("receiver: without a number of bins it has those whose middles are in range") {
  const auto bins = [](double offset, double size, double range_max) {
    ReceiverSpec spec = quiet();
    spec.bin_count = 0;
    spec.bin_offset_m = offset;
    spec.bin_size_m = size;
    return Receiver(spec, x4_wave(), 0.0, range_max).bins();
  };
  CHECK(bins(0.0, 0.05, 30.0) == 601);
  CHECK(bins(0.0, 0.1, 0.3) == 4);  // 0.3 / 0.1 is less than 3 as the machine has it
  CHECK(bins(0.0, 0.1, 0.29) == 3);
  CHECK(bins(-0.2, 0.1, 0.3) == 6);
  CHECK(bins(5.0, 0.1, 0.3) == 1);
}

TEST_CASE("receiver: the bins of the X4") {
  for (const auto& [count, size] : {std::pair{1536, 0.0064256}, {188, 0.0514}}) {
    CAPTURE(count);
    ReceiverSpec spec = quiet();
    spec.bin_count = count;
    spec.bin_size_m = size;
    spec.bandwidth_ghz = 1.5;
    Bench bench(spec, x4_wave(), 0.0, 9.87);
    REQUIRE(bench.receiver.bins() == static_cast<std::uint32_t>(count));
    CHECK(bench.profiles.range(bench.receiver.bins() - 1) == doctest::Approx((count - 1) * size));
    CHECK(count * size == doctest::Approx(9.87).epsilon(0.03));
    for (const std::size_t bin : {std::size_t{0}, static_cast<std::size_t>(count) / 3, static_cast<std::size_t>(count) - 1}) {
      const double range = bench.profiles.range(static_cast<std::uint32_t>(bin));
      bench.receive({{range, 0.01f}});
      CHECK(bench[bin] == about(0.1));
      REQUIRE(bench.found.size() == 1);
      CHECK(bench.found[0].range == doctest::Approx(range));
      CHECK(static_cast<double>(bench.found[0].amplitude) == about(0.1));
    }
  }
}

// --- the pulse ---

TEST_CASE("receiver: the pulse is down by 3 dB where a Gaussian of its bandwidth is") {
  CHECK(pulse_deviation(1.5) == doctest::Approx(0.0483).epsilon(1e-3));
  // Its spectrum, integrated: a tenth of the power at half the bandwidth.
  const double deviation_s = 2.0 * pulse_deviation(1.5) / light_speed, step = 0.01 * deviation_s;
  double at_middle = 0.0, at_edge = 0.0;
  for (int i = -1000; i <= 1000; ++i) {
    const double t = i * step, field = std::exp(-0.5 * t * t / (deviation_s * deviation_s));
    at_middle += field;
    at_edge += field * std::cos(2.0 * pi * 0.75e9 * t);
  }
  CHECK(at_edge * at_edge / (at_middle * at_middle) == doctest::Approx(0.1).epsilon(1e-6));

  for (const char* signal : {"amplitude", "iq"}) {
    for (const auto& wave : {x4_wave(), printed()}) {
      if (wave.law == "printed" && signal == std::string("iq")) continue;
      CAPTURE(signal);
      CAPTURE(wave.law);
      ReceiverSpec spec = quiet();
      spec.signal = signal;
      spec.bin_size_m = 0.001;
      spec.bin_count = 4000;
      spec.bandwidth_ghz = 1.5;
      Bench bench(spec, wave);
      bench.receive({{2.0, 1.0f}});
      CHECK(bench[2000] == about(1.0));
      std::size_t low = 2000, high = 2000;
      while (bench[low] * bench[low] >= 0.5) --low;
      while (bench[high] * bench[high] >= 0.5) ++high;
      CHECK(static_cast<double>(high - low) * 0.001 == doctest::Approx(2.0 * std::sqrt(std::log(2.0)) * pulse_deviation(1.5)).epsilon(0.02));
      // Everywhere the Gaussian, and the same on both sides, bit for bit; nothing but the end, at -80 dB, is missing.
      for (int i = 0; i < 400; ++i) {
        const double x = 0.001 * i / pulse_deviation(1.5), expected = x <= 4.3 ? std::exp(-0.5 * x * x) : 0.0;
        REQUIRE(bench[static_cast<std::size_t>(2000 + i)] == doctest::Approx(expected).epsilon(1e-5));
        REQUIRE(std::abs(bench[static_cast<std::size_t>(2000 - i)] - bench[static_cast<std::size_t>(2000 + i)]) < 1e-6);
      }
    }
  }
}

TEST_CASE("receiver: the pulse of a return outside the profile reaches into it") {
  ReceiverSpec spec = quiet();
  spec.bin_count = 100;
  spec.bandwidth_ghz = 1.5;
  Bench bench(spec);
  bench.receive({{1.03, 1.0f}});  // four bins beyond the last
  CHECK(bench[99] == about(std::exp(-0.5 * std::pow(0.04 / pulse_deviation(1.5), 2))));
  CHECK(bench.found.empty() == false);  // it rises up to the last bin
}

TEST_CASE("receiver: many returns, wherever they are, are the sum of their pulses") {
  rc::check("amplitudes against the sum over all returns", [] {
    const bool add_powers = *rc::gen::arbitrary<bool>();
    ReceiverSpec spec = quiet();
    spec.bin_size_m = 0.01 * *rc::gen::inRange(1, 20);
    spec.bin_count = *rc::gen::inRange(1, 300);
    spec.bin_offset_m = 0.01 * *rc::gen::inRange(-100, 100);
    spec.bandwidth_ghz = 0.1 * *rc::gen::inRange(1, 30);
    Bench bench(spec, add_powers ? x4_wave() : printed(), 0.0, 20.0);
    std::vector<Return> returns;
    const int count = *rc::gen::inRange(0, 20);
    // In the middles of bins (also of those that are not there): there a return is not shared.
    for (int i = 0; i < count; ++i) returns.push_back({spec.bin_offset_m + spec.bin_size_m * *rc::gen::inRange(-50, 350), 0.01f * static_cast<float>(*rc::gen::inRange(0, 100))});
    bench.receive(returns);
    const double deviation = pulse_deviation(spec.bandwidth_ghz);
    for (std::uint32_t bin = 0; bin < bench.receiver.bins(); ++bin) {
      double expected = 0.0;
      for (const Return& r : returns) {
        if (r.range < 0.0 || r.range > 20.0) continue;
        const double x = (bench.profiles.range(bin) - r.range) / deviation;
        if (std::abs(x) < 4.3) expected += static_cast<double>(r.strength) * std::exp((add_powers ? -1.0 : -0.5) * x * x);
      }
      if (add_powers) expected = std::sqrt(expected);
      RC_ASSERT(std::abs(bench[bin] - expected) < 1e-3 * expected + 2e-3);  // (a return at the very end of a pulse may count or not)
    }
  });
}

TEST_CASE("receiver: a return between bins loses to the split no more than the pulse is curved") {
  ReceiverSpec spec = quiet();
  spec.bin_size_m = 0.0064256;
  spec.bandwidth_ghz = 1.5;
  Bench bench(spec);
  bench.receive({{spec.bin_size_m * 300.5, 1.0f}});
  const double half = 0.5 * spec.bin_size_m / pulse_deviation(1.5);
  CHECK(bench[300] == doctest::Approx(std::exp(-0.5 * half * half)).epsilon(0.01));
  CHECK(bench[300] == bench[301]);
  REQUIRE(bench.found.size() == 1);  // two bins, but one top
}

// --- what is added up ---

TEST_CASE("receiver: powers add, under the printed law amplitudes") {
  ReceiverSpec spec = quiet();
  spec.bandwidth_ghz = 1.5;
  Bench powers(spec), amplitudes(spec, printed());
  const double deviation = pulse_deviation(1.5);
  const std::vector<Return> two = {{2.0, 0.09f}, {2.05, 0.16f}};
  powers.receive(two);
  amplitudes.receive(two);
  const double first = std::exp(-0.5 * std::pow(0.02 / deviation, 2)), second = std::exp(-0.5 * std::pow(0.03 / deviation, 2));
  CHECK(powers[202] == about(std::sqrt(0.09 * first * first + 0.16 * second * second)));
  CHECK(amplitudes[202] == about(0.09 * first + 0.16 * second));
  // Twice the strength.
  std::vector<Return> twice = two;
  for (Return& r : twice) r.strength *= 2.0f;
  const double before = powers[202], before_printed = amplitudes[202];
  CHECK(powers.receive(twice)[202] == about(std::sqrt(2.0) * before));
  CHECK(amplitudes.receive(twice)[202] == about(2.0 * before_printed));
  // 4000 at one place, whose powers add exactly.
  CHECK(powers.receive(std::vector<Return>(4000, {3.0, 1e-4f}))[300] == about(std::sqrt(0.4)));
}

TEST_CASE("receiver: clutter is in every bin and its power is added") {
  ReceiverSpec spec = quiet();
  spec.clutter_floor = 0.3;
  spec.threshold = 0.4;
  Bench powers(spec), amplitudes(spec, printed());
  powers.receive({{2.0, 0.16f}});
  amplitudes.receive({{2.0, 0.4f}});
  for (const Bench* bench : {&powers, &amplitudes}) {
    CHECK((*bench)[200] == about(0.5));
    CHECK((*bench)[0] == about(0.3));
    CHECK((*bench)[999] == about(0.3));
    CHECK(bench->found.size() == 1);
  }
  // With I and Q it has a random phase, and that mean power.
  spec.signal = "iq";
  Bench fields(spec);
  double power = 0.0;
  for (std::uint64_t scan = 0; scan < 100; ++scan) {
    fields.receive({}, scan);
    for (const float a : fields.profiles.amplitude) power += static_cast<double>(a) * static_cast<double>(a);
  }
  CHECK(std::abs(power / 1e5 - 0.09) < 4.0 * 0.09 / std::sqrt(1e5));
}

TEST_CASE("receiver: I and Q keep the phase of the way, and fields cancel or add by it") {
  const double wavelength = light_speed / 7.29e9;
  ReceiverSpec spec = quiet();
  spec.signal = "iq";
  spec.bandwidth_ghz = 0.05;  // a pulse much longer than a wave: the two are equally strong
  Bench bench(spec);
  bench.receive({{5.0, 1.0f}, {5.0 + wavelength / 2.0, 1.0f}});
  CHECK(bench[500] == doctest::Approx(2.0).epsilon(1e-3));
  const double alone = bench.receive({{5.0, 1.0f}})[500];
  CHECK(alone == about(1.0));
  CHECK(bench.receive({{5.0, 1.0f}, {5.0 + wavelength / 4.0, 1.0f}})[500] < 1e-4);
  CHECK(bench.receive({{5.0, 1.0f}, {5.0 + wavelength / 8.0, 1.0f}})[500] == doctest::Approx(std::sqrt(2.0)).epsilon(1e-3));

  // Phases and strengths from near to 10 km, in the middles of bins.
  for (const double range : {0.0, 0.01, 1.0, 9.87, 123.45, 9999.99}) {
    CAPTURE(range);
    ReceiverSpec one = quiet();
    one.signal = "iq";
    one.bin_offset_m = range;
    one.bin_count = 2;
    Bench there(one, x4_wave(), 0.0, 1e4);
    there.receive({{range, 0.49f}});
    const long double turns = 2.0L * static_cast<long double>(range) * 7.29e9L / 299792458.0L, fraction = turns - std::floor(turns);
    const auto phase = static_cast<double>(-2.0L * std::numbers::pi_v<long double> * fraction);
    REQUIRE(there.profiles.iq.size() == 2);
    const std::complex<double> sample = there.profiles.iq[0];
    CHECK(std::abs(sample - std::polar(0.7, phase)) < 2e-7);
    CHECK(there[0] == about(0.7));
  }
}

TEST_CASE("receiver: what moves by a wave's eighth turns the phase by a quarter, backwards as it recedes") {
  ReceiverSpec spec = quiet();
  spec.signal = "iq";
  spec.bandwidth_ghz = 0.05;
  Bench bench(spec);
  const std::complex<float> before = bench.receive({{5.0, 1.0f}}).profiles.iq[500];
  const std::complex<float> after = bench.receive({{5.0 + light_speed / 7.29e9 / 8.0, 1.0f}}).profiles.iq[500];
  CHECK(static_cast<double>(std::arg(after / before)) == doctest::Approx(-0.5 * pi).epsilon(1e-3));
}

// --- noise ---

TEST_CASE("receiver: the noise of a bin has the deviation that was asked for, and no bin's depends on another's") {
  for (const char* signal : {"amplitude", "iq"}) {
    CAPTURE(signal);
    ReceiverSpec spec = quiet();
    spec.signal = signal;
    spec.noise = 0.02;
    const bool iq = spec.signal == "iq";
    Bench bench(spec);
    CHECK(bench.receiver.noise() == 0.02);
    double sum = 0.0, squares = 0.0, neighbours = 0.0, components = 0.0, n = 0.0;
    for (std::uint64_t scan = 0; scan < 100; ++scan) {
      bench.receive({{2.0, iq ? 0.0f : 1.0f}}, scan);
      double last = 0.0;
      for (std::size_t bin = 0; bin < 1000; ++bin) {
        const double x = (iq ? static_cast<double>(bench.profiles.iq[bin].real()) : bench[bin] - (bin == 200 ? 1.0 : 0.0)) / 0.02;
        const double y = iq ? static_cast<double>(bench.profiles.iq[bin].imag()) / 0.02 : 0.0;
        sum += x;
        squares += iq ? 0.5 * (x * x + y * y) : x * x;
        neighbours += x * last;
        components += x * y;
        last = x;
        n += 1.0;
      }
    }
    CHECK(std::abs(sum / n) < 4.0 / std::sqrt(n));
    CHECK(std::abs(squares / n - 1.0) < 4.0 * std::sqrt((iq ? 1.0 : 2.0) / n));
    CHECK(std::abs(neighbours / n) < 4.0 / std::sqrt(n));
    CHECK(std::abs(components / n) < 4.0 / std::sqrt(n));
  }
}

TEST_CASE("receiver: a random walk takes steps of the deviation that was asked for") {
  for (const char* signal : {"amplitude", "iq"}) {
    CAPTURE(signal);
    ReceiverSpec spec = quiet();
    spec.signal = signal;
    spec.noise_walk = 0.01;
    Bench bench(spec);
    double steps = 0.0, ends = 0.0, n = 0.0;
    const auto value = [&](std::size_t bin) { return spec.signal == "iq" ? static_cast<double>(bench.profiles.iq[bin].imag()) : bench[bin]; };
    for (std::uint64_t scan = 0; scan < 200; ++scan) {
      bench.receive({}, scan);
      for (std::size_t bin = 1; bin < 1000; ++bin) steps += std::pow((value(bin) - value(bin - 1)) / 0.01, 2);
      ends += std::pow(value(999) / 0.01, 2) / 1000.0;
      n += 999.0;
    }
    CHECK(std::abs(steps / n - 1.0) < 4.0 * std::sqrt(2.0 / n));
    CHECK(std::abs(ends / 200.0 - 1.0) < 4.0 * std::sqrt(2.0 / 200.0));
  }
}

TEST_CASE("receiver: numbers depend on seed, sensor, scan, beam and bin alone") {
  ReceiverSpec spec = quiet();
  spec.noise = 0.1;
  spec.noise_walk = 0.01;
  spec.bandwidth_ghz = 1.5;
  const std::vector<Return> returns = {{1.003, 0.3f}, {2.7, 0.1f}, {2.71, 0.7f}};
  for (const char* signal : {"amplitude", "iq"}) {
    spec.signal = signal;
    const Receiver receiver(spec, x4_wave(), 0.0, 100.0);
    Profiles profiles;
    receiver.start(3, profiles);
    const auto profile = [&](const Random& random, std::uint64_t scan, std::uint32_t beam) {
      std::vector<Echo> found;
      receiver.receive(returns, {}, random, scan, beam, profiles, found);
      const auto of_beam = profiles.amplitude_of(beam);
      return std::vector<float>(of_beam.begin(), of_beam.end());
    };
    const Random random(7, 1);
    const auto once = profile(random, 4, 1);
    const auto other_scan = profile(random, 5, 1);
    CHECK(same_bits(profile(random, 4, 1), once));
    CHECK_FALSE(same_bits(other_scan, once));
    CHECK_FALSE(same_bits(profile(random, 4, 2), once));
    CHECK_FALSE(same_bits(profile(Random(8, 1), 4, 1), once));
    CHECK_FALSE(same_bits(profile(Random(7, 2), 4, 1), once));
    // Fewer bins have the same noise where they are.
    ReceiverSpec fewer = spec;
    fewer.bin_count = 501;
    Bench half(fewer);
    half.random = random;
    half.receive(returns, 4);
    const auto beam_zero = profile(random, 4, 0);
    CHECK(std::equal(half.profiles.amplitude.begin(), half.profiles.amplitude.end(), beam_zero.begin()));
  }
}

TEST_CASE("receiver: beams of several threads are what they are one after another") {
  ReceiverSpec spec = quiet();
  spec.noise = 0.01;
  spec.bandwidth_ghz = 1.5;
  spec.smoothing_bins = 3;
  spec.detector = "ca_cfar";
  spec.false_alarm_rate = 1e-3;
  const Receiver receiver(spec, x4_wave(), 0.0, 100.0);
  constexpr std::uint32_t beams = 64;
  Profiles in_turn, at_once;
  receiver.start(beams, in_turn);
  receiver.start(beams, at_once);
  const auto work = [&](Profiles& profiles, std::uint32_t first, std::uint32_t step) {
    std::vector<Echo> found;
    for (std::uint32_t beam = first; beam < beams; beam += step) receiver.receive(std::vector<Return>{{0.1 * beam, 0.5f, 1.0f}}, {}, Random(1, 0), 9, beam, profiles, found);
  };
  work(in_turn, 0, 1);
  std::vector<std::thread> threads;
  for (std::uint32_t first = 0; first < 4; ++first) threads.emplace_back(work, std::ref(at_once), first, 4);
  for (std::thread& thread : threads) thread.join();
  CHECK(same_bits(in_turn.amplitude, at_once.amplitude));
  CHECK(same_bits(in_turn.threshold, at_once.threshold));
}

TEST_CASE("receiver: without a noise, it is what gives the rate of false alarms at the threshold") {
  ReceiverSpec spec = quiet();
  spec.noise = {};
  spec.threshold = 0.038;
  for (const double rate : {1e-15, 1e-9, 1e-6, 1e-3, 0.1, 0.4}) {
    for (const std::int64_t smoothing : {1, 2, 9}) {
      spec.false_alarm_rate = rate;
      spec.smoothing_bins = smoothing;
      spec.signal = "amplitude";
      const double deviation = Receiver(spec, x4_wave(), 0.0, 10.0).noise() / std::sqrt(static_cast<double>(smoothing));
      CHECK(std::abs(0.5 * std::erfc(0.038 / deviation / std::numbers::sqrt2) / rate - 1.0) < 1e-9);
      spec.signal = "iq";
      const double component = Receiver(spec, x4_wave(), 0.0, 10.0).noise() / std::sqrt(static_cast<double>(smoothing));
      CHECK(std::abs(std::exp(-0.5 * std::pow(0.038 / component, 2)) / rate - 1.0) < 1e-9);
    }
  }
}

TEST_CASE("receiver: as many false alarms are counted as were asked for, at a threshold") {
  ReceiverSpec spec = quiet();
  spec.noise = {};
  spec.threshold = 0.038;
  for (const char* signal : {"amplitude", "iq"}) {
    for (const double rate : {1e-2, 1e-3}) {
      CAPTURE(signal);
      CAPTURE(rate);
      spec.signal = signal;
      spec.false_alarm_rate = rate;
      spec.smoothing_bins = 1;
      CHECK(false_alarms(spec, 1000).agree_with(rate));
      // Neighbours that share noise exceed the threshold together: the count varies more. Fewer bins are averaged at the ends.
      for (const std::int64_t smoothing : {4, 5}) {
        spec.smoothing_bins = smoothing;
        CHECK(false_alarms(spec, 1000, 5).agree_with(rate, 5.0));
      }
    }
  }
}

TEST_CASE("receiver: as many false alarms are counted as were asked for, with CFAR on I and Q") {
  ReceiverSpec spec = quiet();
  spec.signal = "iq";
  spec.noise = 0.7;
  spec.detector = "ca_cfar";
  for (const double rate : {1e-2, 1e-3}) {
    for (const auto& [training, guard] : {std::pair{16, 4}, {2, 0}, {4, 10}}) {
      CAPTURE(rate);
      CAPTURE(training);
      spec.false_alarm_rate = rate;
      spec.cfar_training_bins = training;
      spec.cfar_guard_bins = guard;
      // (Alarms of neighbours are nearly independent but for few training bins, which they share.)
      const Alarms all = false_alarms(spec, 1200);
      CHECK(all.bins >= 1e6);
      CHECK(all.agree_with(rate, 1.5));
    }
  }
  // At the ends, where fewer bins train.
  spec.bin_count = 20;
  spec.cfar_training_bins = 16;
  spec.cfar_guard_bins = 4;
  spec.false_alarm_rate = 1e-2;
  CHECK(false_alarms(spec, 50000).agree_with(1e-2, 1.5));
}

TEST_CASE("receiver: CFAR on amplitudes gives more false alarms than were asked for, as its description says") {
  ReceiverSpec spec = quiet();
  spec.noise = 0.7;
  spec.detector = "ca_cfar";
  for (const auto& [asked, described] : {std::pair{1e-2, 1.7e-2}, {1e-3, 4.6e-3}, {1e-4, 1.3e-3}}) {
    CAPTURE(asked);
    spec.false_alarm_rate = asked;
    const Alarms all = false_alarms(spec, 2000, 20);
    CHECK(all.rate() == doctest::Approx(described).epsilon(0.05));
    // A normal number over the root of the mean square of n others: Student's distribution of n degrees.
    const double n = 32.0, limit = std::sqrt(n * (std::pow(asked, -1.0 / n) - 1.0));
    double chance = 0.0;
    for (double t = limit + 0.0005; t < 40.0; t += 0.001) chance += 0.001 * std::pow(1.0 + t * t / n, -0.5 * (n + 1.0));
    chance *= std::exp(std::lgamma(0.5 * (n + 1.0)) - std::lgamma(0.5 * n)) / std::sqrt(n * pi);
    CHECK(all.agree_with(chance, 1.5));
  }
}

// --- smoothing, saturation ---

TEST_CASE("receiver: the moving average is centred, and shorter at the ends") {
  ReceiverSpec spec = quiet();
  spec.bin_count = 10;
  const std::vector<Return> one = {{0.05, 1.0f}};
  spec.smoothing_bins = 3;
  Bench bench(spec);
  bench.receive(one);
  for (std::size_t bin = 0; bin < 10; ++bin) CHECK(bench[bin] == doctest::Approx(bin >= 4 && bin <= 6 ? 1.0 / 3.0 : 0.0));
  REQUIRE(bench.found.size() == 1);
  CHECK(bench.found[0].range == about(0.05));  // the middle of three equal bins
  bench.receive({{0.0, 1.0f}});
  CHECK(bench[0] == about(0.5));
  CHECK(bench[1] == about(1.0 / 3.0));
  bench.receive({{0.09, 1.0f}});
  CHECK(bench[9] == about(0.5));
  spec.smoothing_bins = 4;  // the bin, two before it and one behind it
  Bench even(spec);
  even.receive(one);
  for (std::size_t bin = 0; bin < 10; ++bin) CHECK(even[bin] == doctest::Approx(bin >= 4 && bin <= 7 ? 0.25 : 0.0));
  REQUIRE(even.found.size() == 1);
  CHECK(even.found[0].range == about(0.05));
  spec.smoothing_bins = 100;  // more than there are
  Bench all(spec);
  all.receive(one);
  for (std::size_t bin = 0; bin < 10; ++bin) CHECK(all[bin] == about(0.1));
}

TEST_CASE("receiver: smoothing over m bins lowers the noise by the root of m") {
  for (const char* signal : {"amplitude", "iq"}) {
    for (const std::int64_t m : {2, 9}) {
      CAPTURE(signal);
      CAPTURE(m);
      ReceiverSpec spec = quiet();
      spec.signal = signal;
      spec.noise = 1.0;
      spec.smoothing_bins = m;
      Bench bench(spec);
      double squares = 0.0, n = 0.0;
      for (std::uint64_t scan = 0; scan < 300; ++scan) {
        bench.receive({}, scan);
        for (std::size_t bin = 10; bin < 990; bin += static_cast<std::size_t>(m)) {  // those that share nothing
          squares += spec.signal == "iq" ? 0.5 * static_cast<double>(std::norm(bench.profiles.iq[bin])) : bench[bin] * bench[bin];
          n += 1.0;
        }
      }
      CHECK(std::abs(squares / n * static_cast<double>(m) - 1.0) < 4.0 * std::sqrt(2.0 / n));
    }
  }
}

TEST_CASE("receiver: amplitudes are clipped at the saturation, and a clipped top is one detection in its middle") {
  ReceiverSpec spec = quiet();
  spec.bandwidth_ghz = 1.5;
  spec.saturation = 0.5;
  for (const char* signal : {"amplitude", "iq"}) {
    CAPTURE(signal);
    spec.signal = signal;
    Bench bench(spec);
    bench.receive({{2.0, 4.0f}, {5.0, 0.04f}});
    CHECK(bench[200] == 0.5);
    CHECK(bench[500] == about(0.2));
    CHECK(std::count(bench.profiles.amplitude.begin(), bench.profiles.amplitude.end(), 0.5f) > 10);
    REQUIRE(bench.found.size() == 2);
    CHECK(bench.found[0].range == about(2.0));
    CHECK(bench.found[0].amplitude == 0.5f);
    if (spec.signal == "iq") CHECK(static_cast<double>(std::abs(bench.profiles.iq[200])) == about(2.0));
  }
}

// --- detection ---

TEST_CASE("receiver: first, strongest and all") {
  ReceiverSpec spec = quiet();
  spec.bandwidth_ghz = 1.5;
  spec.threshold = 0.05;
  const std::vector<Return> returns = {{7.0, 0.25f}, {2.0, 0.01f}, {4.0, 0.25f}, {1.0, 0.0016f}, {8.0, 0.04f}};
  const auto ranges = [&](const char* detection) {
    spec.detection = detection;
    std::vector<double> result;
    Bench bench(spec);
    for (const Echo& e : bench.receive(returns).found) {
      result.push_back(e.range);
      CHECK(e.incidence_cosine == 1.0f);
      CHECK(e.edge == Edge::front);
      CHECK(e.bounces == 1);
      CHECK(e.radial_velocity == 0.0f);
    }
    return result;
  };
  const auto equal = [](const std::vector<double>& a, const std::vector<double>& b) {
    return a.size() == b.size() && std::equal(a.begin(), a.end(), b.begin(), [](double x, double y) { return std::abs(x - y) < 1e-9; });
  };
  CHECK(equal(ranges("first"), {2.0}));
  CHECK(equal(ranges("strongest"), {4.0}));  // the nearest of two that are equal
  CHECK(equal(ranges("all"), {2.0, 4.0, 7.0, 8.0}));
  spec.threshold = 0.6;
  for (const char* detection : {"first", "strongest", "all"}) CHECK(ranges(detection).empty());
}

TEST_CASE("receiver: a top reaches the threshold, and what only rises or falls is none") {
  ReceiverSpec spec = quiet();
  spec.threshold = 0.5;
  CHECK(Bench(spec).receive({{2.0, 0.25f}}).found.size() == 1);
  CHECK(Bench(spec).receive({{2.0, 0.2499f}}).found.empty());
  // 1 2 2 3 2 2 1: one top.
  const std::vector<Return> steps = {{2.0, 1.0f}, {2.01, 2.0f}, {2.02, 2.0f}, {2.03, 3.0f}, {2.04, 2.0f}, {2.05, 2.0f}, {2.06, 1.0f}};
  Bench bench(spec, printed());
  bench.receive(steps);
  REQUIRE(bench.found.size() == 1);
  CHECK(bench.found[0].range == about(2.03));
  // Its bin is in the sensor's range.
  ReceiverSpec wide = quiet();
  wide.bandwidth_ghz = 1.5;
  CHECK(Bench(wide, x4_wave(), 2.004, 100.0).receive({{2.004, 1.0f}}).found.empty());
  CHECK(Bench(wide, x4_wave(), 2.006, 100.0).receive({{2.006, 1.0f}}).found.size() == 1);
  CHECK(Bench(wide, x4_wave(), 0.0, 3.004).receive({{3.004, 1.0f}}).found.size() == 1);
  CHECK(Bench(wide, x4_wave(), 0.0, 3.006).receive({{3.006, 1.0f}}).found.empty());
  // Nothing at all is not a top either, even where the threshold is 0.
  wide.detector = "ca_cfar";
  CHECK(Bench(wide).receive({}).found.empty());
}

TEST_CASE("receiver: detections are appended") {
  Bench bench(quiet());
  bench.receive({{2.0, 1.0f}});
  bench.receiver.receive(std::vector<Return>{{1.0, 1.0f}}, {}, bench.random, 0, 0, bench.profiles, bench.found);
  REQUIRE(bench.found.size() == 2);
  CHECK(bench.found[1].range == about(1.0));
}

TEST_CASE("receiver: the threshold of CFAR is its factor times the mean of the training bins") {
  ReceiverSpec spec = quiet();
  spec.detector = "ca_cfar";
  spec.cfar_training_bins = 3;
  spec.cfar_guard_bins = 2;
  spec.false_alarm_rate = 1e-3;
  spec.bin_count = 30;
  std::vector<Return> returns;
  for (int bin = 0; bin < 30; ++bin) returns.push_back({0.01 * bin, 0.1f * static_cast<float>((7 * bin) % 11)});
  Bench bench(spec);
  bench.receive(returns);
  for (int bin = 0; bin < 30; ++bin) {
    double power = 0.0, n = 0.0;
    for (int other = 0; other < 30; ++other) {
      const int distance = std::abs(other - bin);
      if (distance <= 2 || distance > 5) continue;
      power += bench[static_cast<std::size_t>(other)] * bench[static_cast<std::size_t>(other)];
      n += 1.0;
    }
    CHECK(static_cast<double>(bench.profiles.threshold[static_cast<std::size_t>(bin)]) == about(std::sqrt(n * (std::pow(1e-3, -1.0 / n) - 1.0) * power / n)));
  }
  spec.bin_count = 3;  // nothing to train on
  CHECK(std::isinf(Bench(spec).receive({{0.01, 1.0f}}).profiles.threshold[1]));
}

TEST_CASE("receiver: the floor gate hides the ground, and nothing else") {
  for (const char* signal : {"amplitude", "iq"}) {
    for (const std::int64_t smoothing : {1, 5}) {
      CAPTURE(signal);
      CAPTURE(smoothing);
      ReceiverSpec spec = quiet();
      spec.signal = signal;
      spec.bandwidth_ghz = 1.5;
      spec.threshold = 0.01;
      spec.smoothing_bins = smoothing;
      const std::vector<Return> ground = {{1.5, 0.04f}, {1.6, 0.01f}};
      std::vector<Return> both = ground;
      both.push_back({4.0, 0.0025f});
      CHECK(Bench(spec).receive(both, 0, ground).found.size() >= 2);  // without the gate
      spec.floor_gate = true;
      CHECK(Bench(spec).receive(both).found.size() >= 2);  // without ground
      Bench bench(spec);
      bench.receive(both, 0, ground);
      REQUIRE(bench.found.size() == 1);
      CHECK(bench.found[0].range == about(4.0));
      CHECK(static_cast<double>(bench.profiles.threshold[150]) == doctest::Approx(0.01 + 1.5 * bench[150]).epsilon(1e-4));
      CHECK(bench.profiles.threshold[400] == 0.01f);
      // What stands out of the ground by much more is found.
      both.push_back({1.5, 0.36f});
      bench.receive(both, 0, ground);
      CHECK(bench.found.size() == 2);
    }
  }
}

TEST_CASE("receiver: the velocity of a top is the mean of what is in it, by strength") {
  ReceiverSpec spec = quiet();
  spec.bandwidth_ghz = 1.5;
  Bench bench(spec);
  bench.receive({{2.0, 0.3f, 1.0f}, {2.02, 0.1f, -3.0f}, {5.0, 1.0f, 0.5f}, {8.0, 1.0f}});
  REQUIRE(bench.found.size() == 3);
  // Each by its power in the top's bin: exp(-(distance / deviation)^2), the pulse's deviation being 4.8 cm.
  const auto weight = [&](double range) { return std::exp(-std::pow((bench.found[0].range - range) / 0.04829, 2)); };
  const double near = 0.3 * weight(2.0), far = 0.1 * weight(2.02);
  CHECK(static_cast<double>(bench.found[0].radial_velocity) == doctest::Approx((near - 3.0 * far) / (near + far)).epsilon(0.05).scale(1.0));
  CHECK(bench.found[1].radial_velocity == 0.5f);
  CHECK(bench.found[2].radial_velocity == 0.0f);
  bench.receive({{2.0, 0.3f, 1.0f}, {2.5, 10.0f, -3.0f}});  // what is far from it does not count
  REQUIRE(bench.found.size() == 2);
  CHECK(bench.found[0].radial_velocity == 1.0f);
  // A top on the early flank of a pulse, as noise makes them, has the velocity of the pulse.
  spec.noise = 0.01;
  spec.threshold = 0.03;
  Bench noisy(spec);
  int early = 0;
  for (std::uint64_t scan = 0; scan < 200; ++scan) {
    noisy.receive({{4.0, 0.01f, -2.0f}}, scan);
    for (const Echo& e : noisy.found) {
      if (std::abs(e.range - 4.0) > 0.15) continue;
      early += e.range < 3.93;
      CHECK(e.radial_velocity == -2.0f);
    }
  }
  CHECK(early > 5);
}

// --- the least that is detected ---

TEST_CASE("receiver: the floor power is just what is detected") {
  for (const auto& wave : {x4_wave(), printed()}) {
    for (const char* signal : {"amplitude", "iq"}) {
      if (wave.law == "printed" && signal == std::string("iq")) continue;
      for (const double bandwidth : {0.0, 1.5}) {
        for (const std::int64_t smoothing : {1, 4, 9}) {
          for (const double clutter : {0.0, 0.03}) {
            ReceiverSpec spec = quiet();
            spec.signal = signal;
            if (clutter > 0.0 && spec.signal == "iq") continue;  // random
            spec.bandwidth_ghz = bandwidth;
            spec.smoothing_bins = smoothing;
            spec.clutter_floor = clutter;
            spec.threshold = 0.038;
            CAPTURE(wave.law);
            CAPTURE(signal);
            CAPTURE(bandwidth);
            CAPTURE(smoothing);
            CAPTURE(clutter);
            Bench bench(spec, wave);
            const double power = bench.receiver.floor_power(), strength = wave.law == "printed" ? std::sqrt(power) : power;
            CHECK(power >= 0.038 * 0.038 - clutter * clutter - 1e-12);
            CHECK(bench.receive({{2.0, static_cast<float>(strength * 1.0001)}}).found.size() == 1);
            CHECK(bench.receive({{2.0, static_cast<float>(strength * 0.9999)}}).found.empty());
          }
        }
      }
    }
  }
  ReceiverSpec spec = quiet();
  spec.threshold = 0.038;
  CHECK(Receiver(spec, x4_wave(), 0.0, 10.0).floor_power() == doctest::Approx(0.038 * 0.038).epsilon(1e-12));
  spec.clutter_floor = 0.04;
  CHECK(Receiver(spec, x4_wave(), 0.0, 10.0).floor_power() == 0.0);
  spec.clutter_floor = 0.0;
  spec.saturation = 0.03;
  CHECK(std::isinf(Receiver(spec, x4_wave(), 0.0, 10.0).floor_power()));
}

TEST_CASE("receiver: with CFAR the floor power is that against the mean noise") {
  ReceiverSpec spec = quiet();
  spec.detector = "ca_cfar";
  spec.false_alarm_rate = 1e-4;
  spec.noise = 0.01;
  spec.signal = "iq";
  const double factor = 32.0 * (std::pow(1e-4, -1.0 / 32.0) - 1.0);
  CHECK(Receiver(spec, x4_wave(), 0.0, 10.0).floor_power() == doctest::Approx(factor * 2e-4).epsilon(1e-9));
  spec.signal = "amplitude";
  CHECK(Receiver(spec, x4_wave(), 0.0, 10.0).floor_power() == doctest::Approx(factor * 1e-4).epsilon(1e-9));
}
