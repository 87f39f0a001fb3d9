// `thicket tradeoff`: what accuracy costs, of one mission.
#include <fmt/format.h>

#include <csignal>
#include <cstdio>
#include <filesystem>

#include "program.hpp"
#include "thicket/base/files.hpp"
#include "thicket/sim/tradeoff.hpp"

namespace thicket::cli {
namespace {

volatile std::sig_atomic_t interrupted = 0;
void on_interrupt(int) { interrupted = 1; }

}  // namespace

int study_tradeoff(const TradeoffArguments& a) {
  const auto file = find_input(a.mission);
  if (file.empty()) return complain({fmt::format("there is no mission '{}'; shipped ones are listed by `thicket worlds`", a.mission)});
  TradeoffOptions options;
  options.knobs = a.knobs;
  options.budget_s = 60.0 * a.budget_min;
  options.repeats = static_cast<std::size_t>(a.repeats);
  options.seed = static_cast<std::uint64_t>(a.seed);
  options.seconds = a.seconds;
  options.out = a.out.empty() ? std::filesystem::path("thicket-out") / (file.stem().string() + "-tradeoff") : std::filesystem::path(a.out);
  for (const std::string& set : a.sets) {
    const auto equals = set.find('=');
    if (equals == std::string::npos) return complain({"--set is '" + set + "', expected KEY=VALUE, for example sensor.step_deg=2"});
    options.overrides.push_back({set.substr(0, equals), set.substr(equals + 1), "--set " + set.substr(0, equals)});
  }
  options.interrupted = [] { return interrupted != 0; };
  if (!a.quiet) options.progress = [](const std::string& line) { fmt::print(stderr, "{}\n", line); };
  std::signal(SIGINT, on_interrupt);
  std::signal(SIGTERM, on_interrupt);
  const auto study = run_tradeoff(file, options);
  if (!study) return complain(study.error());
  if (const auto written = write_tradeoff(options.out, *study); !written) return complain(written.error());
  fmt::print("{}written    tradeoff.csv, tradeoff.json, tradeoff.png, tradeoff.svg in {}\n", tradeoff_text(*study), options.out.string());
  if (interrupted) return stopped;
  for (const Recommendation& r : study->recommended)
    if (!r.verified) return wrong;
  return done;
}

}  // namespace thicket::cli
