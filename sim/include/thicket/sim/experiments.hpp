// The experiments of the two source texts, each a section of a page: the source's figure in words, ours as pictures and tables, and what differs. `thicket experiments` is made of this.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "thicket/base/result.hpp"

namespace thicket {

class ExperimentContext;

/// One experiment: what `run` returns is the body of its section, in Markdown.
struct Experiment {
  std::string name;     ///< "rozeboom2012/foliage_room"
  std::string title;
  std::string figures;  ///< "Rozeboom 2012, figures 6 to 8"
  std::string source;   ///< what the source shows or tells there, in words
  std::function<std::string(ExperimentContext&)> run;  ///< may throw what the helpers of the context throw; `make_section` turns that into an error
};

/// All of them, in the order of the page.
const std::vector<Experiment>& experiments();

struct ExperimentOptions {
  std::filesystem::path pictures;  ///< folder that pictures go to; made if need be
  std::string link;                ///< what stands before a picture's name in the page: "experiments/"
  bool brief = false;              ///< shorter drives and fewer scans, for tests: other numbers
};

/// Runs an experiment, writes its pictures, and returns its section between the lines `<!-- begin NAME -->` and `<!-- end NAME -->`. Two calls give the same bytes but for what stands between `<!-- measured -->` and
/// `<!-- end measured -->`: times and memory. Errors: of missions, worlds and files.
Result<std::string> make_section(const Experiment& experiment, const ExperimentOptions& options);

/// The page with this section in place of the one of the same name; if it has none, before the first of those that follow it in `experiments()`, else at the end. An empty page gets its head first.
std::string with_section(const std::string& page, const std::string& name, const std::string& section);

/// The text without what was measured on the machine.
std::string without_measured(const std::string& text);

}  // namespace thicket
