#include "thicket/sim/experiments.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "context.hpp"

namespace thicket {
namespace {

constexpr const char* head =
    "# The experiments of both sources\n"
    "\n"
    "**No measured radar data can be had** to hold these experiments against: neither text prints any. So they are held against what the texts *report*: the source's figure in words, ours as pictures and numbers, and what\n"
    "differs. Sizes that the texts do not print are ours, and the worlds say so.\n"
    "\n"
    "This page and all its pictures are made by `thicket experiments`. `thicket experiments NAME` makes one section anew, `thicket experiments --list` lists them. All of it is the same bytes each time, but for tables of times and\n"
    "memory, which say so.\n"
    "\n";

std::string begin_of(const std::string& name) { return fmt::format("<!-- begin {} -->\n", name); }
std::string end_of(const std::string& name) { return fmt::format("<!-- end {} -->\n", name); }

}  // namespace

const std::vector<Experiment>& experiments() {
  static const std::vector<Experiment> list = [] {
    std::vector<Experiment> all;
    for (auto* part : {rozeboom2012_experiments, billdal2018_experiments, failure_experiments})
      for (Experiment& experiment : part()) all.push_back(std::move(experiment));
    return all;
  }();
  return list;
}

Result<std::string> make_section(const Experiment& experiment, const ExperimentOptions& options) {
  try {
    ExperimentContext context(experiment, options);
    const std::string body = experiment.run(context);
    return fmt::format("{}\n## {}\n\n{}; `thicket experiments {}`\n\n**The source.** {}\n\n**Ours.** {}\n{}", begin_of(experiment.name), experiment.title, experiment.figures, experiment.name, experiment.source, body,
                       end_of(experiment.name));
  } catch (const ExperimentFailure& failure) {
    return Error{fmt::format("experiment '{}': {}", experiment.name, failure.what())};
  }
}

std::string with_section(const std::string& page, const std::string& name, const std::string& section) {
  if (page.empty()) return with_section(head, name, section);
  const auto from = page.find(begin_of(name)), to = from == std::string::npos ? from : page.find(end_of(name), from);
  if (to != std::string::npos) return page.substr(0, from) + section + page.substr(to + end_of(name).size());
  const auto& all = experiments();
  auto next = std::find_if(all.begin(), all.end(), [&](const Experiment& e) { return e.name == name; });
  for (next = next == all.end() ? next : next + 1; next != all.end(); ++next)
    if (const auto at = page.find(begin_of(next->name)); at != std::string::npos) return page.substr(0, at) + section + "\n" + page.substr(at);
  return page + (page.ends_with("-->\n") ? "\n" : "") + section;
}

std::string without_measured(const std::string& text) {
  const std::string begin = "<!-- measured -->", end = "<!-- end measured -->";
  std::string rest = text;
  for (auto from = rest.find(begin); from != std::string::npos; from = rest.find(begin, from)) {
    const auto to = rest.find(end, from);
    if (to == std::string::npos) break;
    rest.erase(from, to + end.size() - from);
  }
  return rest;
}

}  // namespace thicket
