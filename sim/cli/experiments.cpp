// `thicket experiments`: the experiments of both sources, as a page with pictures.
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>

#include "program.hpp"
#include "thicket/base/files.hpp"
#include "thicket/base/text.hpp"
#include "thicket/sim/experiments.hpp"

namespace thicket::cli {
namespace {

namespace fs = std::filesystem;

int list_experiments() {
  std::vector<Row> rows = {{"name", "figures", "title"}};
  for (const Experiment& e : experiments()) rows.push_back({e.name, e.figures, e.title});
  fmt::print("{}", aligned(rows, {"figures"}));
  return done;
}

/// Those of these names, in the order of the page; all if there are none.
Result<std::vector<const Experiment*>> chosen(const std::vector<std::string>& names) {
  std::vector<std::string> known;
  for (const Experiment& e : experiments()) known.push_back(e.name);
  for (const std::string& name : names)
    if (std::find(known.begin(), known.end(), name) == known.end())
      return Error{fmt::format("there is no experiment '{}'{}; `thicket experiments --list` lists them", name, did_you_mean(name, known))};
  std::vector<const Experiment*> list;
  for (const Experiment& e : experiments())
    if (names.empty() || std::find(names.begin(), names.end(), e.name) != names.end()) list.push_back(&e);
  return list;
}

/// Where the page and its pictures are: beside the docs if it is called in the tree, where short versions have no business.
void find_places(const ExperimentsArguments& a, fs::path& page, fs::path& pictures) {
  const bool in_tree = !a.brief && fs::exists("docs/missions.md") && fs::exists("sim/experiments");
  page = a.page;
  pictures = a.out;
  if (page.empty() && pictures.empty()) page = in_tree ? "docs/experiments.md" : "thicket-out/experiments/experiments.md";
  if (page.empty()) page = pictures / "experiments.md";
  if (pictures.empty()) pictures = page == "docs/experiments.md" ? fs::path("docs/experiments") : page.has_parent_path() ? page.parent_path() : fs::path(".");
}

}  // namespace

int make_experiments(const ExperimentsArguments& a) {
  if (a.list) return list_experiments();
  const auto wanted = chosen(a.names);
  if (!wanted) return complain(wanted.error());
  fs::path page, pictures;
  find_places(a, page, pictures);
  ExperimentOptions options;
  options.pictures = pictures;
  options.brief = a.brief;
  const std::string between = pictures.lexically_normal().lexically_proximate(page.lexically_normal().parent_path()).generic_string();
  options.link = between == "." || between.empty() ? "" : between + "/";
  std::string text;
  if (fs::exists(page)) {
    const auto old = read_text_file(page);
    if (!old) return complain(old.error());
    text = *old;
  }
  for (const Experiment* experiment : *wanted) {
    if (!a.quiet) fmt::print("{} ...\n", experiment->name);
    std::fflush(stdout);
    const auto section = make_section(*experiment, options);
    if (!section) return complain(section.error());
    text = with_section(text, experiment->name, *section);
    // After each, so that an interrupted call leaves what is done.
    if (const auto written = write_file(page, text); !written) return complain(written.error());
  }
  fmt::print("written    {}, pictures in {}\n", page.string(), pictures.string());
  return done;
}

}  // namespace thicket::cli
