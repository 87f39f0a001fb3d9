// `thicket experiments`: the page, and short versions of the experiments of 2012 with what they must show.
#include <doctest/doctest.h>

#include <algorithm>
#include <string>

#include "experiments/context.hpp"
#include "program_call.hpp"
#include "temporary_folder.hpp"
#include "thicket/base/files.hpp"

namespace thicket {
namespace {

const Experiment& experiment(const std::string& name) {
  const auto found = std::find_if(experiments().begin(), experiments().end(), [&](const Experiment& e) { return e.name == name; });
  if (found == experiments().end()) FAIL("there is no experiment " << name);
  return *found;
}

/// The section of a short version. Its pictures are in the folder.
std::string section(const TemporaryFolder& folder, const std::string& name) {
  const auto text = make_section(experiment(name), {folder.path(), "pictures/", true});
  if (!text) FAIL(text.error().message);
  CHECK(has(*text, "**What differs.**") != (name == "failures"));
  return *text;
}

/// A cell of the row of a table that begins so, as text, and as a number.
std::string cell(const std::string& text, const std::string& row, std::size_t column) {
  auto from = text.find("\n| " + row + " |");
  if (from == std::string::npos) FAIL("there is no row " << row);
  for (from += 2; column > 0; --column) from = text.find('|', from + 1);
  return text.substr(from + 2, text.find(" |", from + 2) - from - 2);
}
double value(const std::string& text, const std::string& row, std::size_t column) { return std::stod(cell(text, row, column)); }

}  // namespace

TEST_CASE("dust hides from a laser what is in it and behind it, and nothing from a radar") {
  const TemporaryFolder folder;
  const Experiment none;
  const ExperimentContext context(none, {folder.path(), "", true});
  const Scene clear = context.scene("clearing/clearing"), dust = context.scene("clearing/clearing_in_dust");
  const ScanPose pose{{-10.0, 0.0, 0.4}, 0.0, 0.0, {}};
  LidarSpec laser;
  laser.range_max_m = 30.0;
  const Scan by_laser = context.look(dust, laser, pose)[0];
  for (const Beam& beam : by_laser.beams) {
    const double angle = degrees(beam.azimuth);
    if (std::abs(angle) > 20.0 || (angle < -14.0)) continue;
    // The front of the cloud is a circle of 7 m about (2, -0.5); light gets 2 m into it (extinction 0.5 per metre, to the optical depth of 1).
    const glm::dvec2 at(-12.0, 0.5), ahead(std::cos(beam.azimuth), std::sin(beam.azimuth));
    const double along = -glm::dot(at, ahead), front = along - std::sqrt(along * along - (glm::dot(at, at) - 49.0));
    const auto echoes = by_laser.echoes_of(beam);
    REQUIRE(echoes.size() == 1);
    CHECK(echoes[0].range == doctest::Approx(front + 2.0).epsilon(1e-6));
  }
  const SensorSpec radar = context.sensor("", "usarsim2012").spec;
  const Scan in_clear = context.look(clear, radar, pose)[0], in_dust = context.look(dust, radar, pose)[0];
  REQUIRE(in_clear.echoes.size() == in_dust.echoes.size());
  for (std::size_t i = 0; i < in_clear.echoes.size(); ++i) CHECK(in_clear.echoes[i].range == doctest::Approx(in_dust.echoes[i].range).epsilon(1e-9));
}

TEST_CASE("the clearing's table tells as much, and its pictures are small") {
  const TemporaryFolder folder;
  const std::string text = section(folder, "rozeboom2012/clearing");
  CHECK(value(text, "radar | dust", 3) == 100.0);
  CHECK(cell(text, "radar | dust", 2) == cell(text, "radar | clear air", 2));
  CHECK(value(text, "laser | clear air", 2) >= 10.0);
  CHECK(value(text, "laser | dust", 2) <= 4.0);
  CHECK(value(text, "laser | dust", 4) < 0.65 * value(text, "laser | clear air", 4));
  CHECK(value(text, "radar | dust", 4) == value(text, "radar | clear air", 4));
  for (const char* name : {"scene", "dust", "readings"}) {
    const auto file = folder.path() / ("rozeboom2012_clearing_" + std::string(name) + ".png");
    REQUIRE(std::filesystem::exists(file));
    CHECK(std::filesystem::file_size(file) < 150000);
    CHECK(has(text, "(pictures/" + file.filename().string() + ")"));
  }
}

TEST_CASE("through foliage a radar maps, a laser of the same range does not, nor a radar of the laser's range from afar") {
  const TemporaryFolder folder;
  const std::string text = section(folder, "rozeboom2012/foliage_room");
  CHECK(value(text, "radar | 30 m", 2) > 65.0);
  CHECK(value(text, "radar, first echoes only | 30 m", 2) == 0.0);
  CHECK(value(text, "laser | 30 m", 2) == 0.0);
  CHECK(value(text, "laser over 240°, as the Hokuyo's | 4 m", 2) == 0.0);
}

TEST_CASE("side beams: the larger N, the more ragged; at the sensor more than at the end of the range; and twice the same page") {
  const TemporaryFolder folder;
  const std::string text = section(folder, "rozeboom2012/side_beams");
  CHECK(value(text, "N = 100 | parallel", 2) > 1.5 * value(text, "N = 50 | parallel", 2));
  CHECK(value(text, "N = 50 | parallel", 2) > 2.0 * value(text, "N = 50 | diverging", 2));
  CHECK(value(text, "N = 100 | diverging", 2) > 1.5 * value(text, "N = 50 | diverging", 2));
  const auto picture = read_text_file(folder.path() / "rozeboom2012_side_beams_fans.png");
  CHECK(section(folder, "rozeboom2012/side_beams") == text);
  CHECK(*read_text_file(folder.path() / "rozeboom2012_side_beams_fans.png") == *picture);
}

TEST_CASE("Bug1 and Bug2 end as drawn in 2012, and the text's rule of failure gives up too early") {
  const TemporaryFolder folder;
  const std::string text = section(folder, "rozeboom2012/bugs");
  CHECK(cell(text, "13, top", 2) == "reached");
  CHECK(cell(text, "13, bottom", 2) == "unreachable");
  CHECK(cell(text, "14, top", 2) == "reached");
  CHECK(cell(text, "14, bottom", 2) == "unreachable");
}

TEST_CASE("an explorer maps the other side through the foliage, but not the cores of the bushes") {
  const TemporaryFolder folder;
  const std::string text = section(folder, "rozeboom2012/explored");
  CHECK(value(text, "of the free area behind the foliage, mapped", 1) > 50.0);
  CHECK(value(text, "of the free area behind the foliage, mapped", 2) == 0.0);
  CHECK(value(text, "cells in the cores of bushes known, of 120", 1) == 0.0);
}

TEST_CASE("real leaves let the radar through, boxes in their place do not") {
  const TemporaryFolder folder;
  const std::string text = section(folder, "rozeboom2012/leaves");
  CHECK(value(text, "leaves | radar", 2) > 80.0);
  CHECK(value(text, "leaves | laser of the same range", 2) < 10.0);
  CHECK(value(text, "the boxes around them, as in USARSim | radar", 2) < 1.0);
}

TEST_CASE("a section is replaced alone, a new one stands where the list has it, and what was measured is told apart") {
  const auto part = [](const std::string& name, const char* body) { return "<!-- begin " + name + " -->\n" + body + "<!-- end " + name + " -->\n"; };
  const std::string first = experiments()[0].name, second = experiments()[1].name, last = experiments().back().name;
  std::string page = with_section("", last, part(last, "z\n"));
  CHECK(has(page, "No measured radar data can be had"));
  page = with_section(page, first, part(first, "a\n"));
  page = with_section(page, second, part(second, "b\n"));
  CHECK(page.find("a\n<!-- end") < page.find("b\n<!-- end"));
  CHECK(page.find("b\n<!-- end") < page.find("z\n<!-- end"));
  const std::string changed = with_section(page, second, part(second, "c\n"));
  CHECK(changed.size() == page.size());
  CHECK(has(changed, "c\n<!-- end"));
  CHECK_FALSE(has(changed, "b\n<!-- end"));
  CHECK(with_section(changed, second, part(second, "b\n")) == page);
  CHECK(without_measured("a" + measured("3 s\n") + "b" + measured("4 s\n")) == without_measured("a" + measured("5 s\n") + "b" + measured("6 s\n")));
}

TEST_CASE("experiments from the command line") {
  const TemporaryFolder folder;
  const Answer list = call(folder, "experiments --list");
  CHECK(list.code == 0);
  for (const Experiment& e : experiments()) CHECK(has(list.out, e.name));
  const Answer wrong = call(folder, "experiments rozeboom2012/foliage_rom");
  CHECK(wrong.code == 2);
  CHECK_MESSAGE(has(wrong.err, "rozeboom2012/foliage_room"), wrong.err);
  folder.write("page.md", "My page.\n");
  for (int i = 0; i < 2; ++i) {
    const Answer answer = call(folder, "experiments rozeboom2012/side_beams --short --quiet --out pictures --page page.md");
    CHECK_MESSAGE(answer.code == 0, answer.err);
  }
  const std::string page = *read_text_file(folder.path() / "page.md");
  CHECK(page.starts_with("My page.\n"));
  CHECK(has(page, "(pictures/rozeboom2012_side_beams_fans.png)"));
  CHECK(page.find("## Side beams") == page.rfind("## Side beams"));
  CHECK(std::filesystem::exists(folder.path() / "pictures" / "rozeboom2012_side_beams_fans.png"));
}

TEST_CASE("failures of the sources: ours are better in each number that a short version tells") {
  const TemporaryFolder folder;
  const std::string text = section(folder, "failures");
  CHECK(value(text, "a wire answers like a plate of the ray spacing", 3) > 20.0);
  CHECK(value(text, "a wire answers like a plate of the ray spacing", 4) == doctest::Approx(1.0).epsilon(0.35));
  CHECK(value(text, "a tilted plate is far too strong", 3) > -8.0);
  CHECK(value(text, "a tilted plate is far too strong", 4) < -25.0);
  CHECK(value(text, "standing still writes obstacles that do not exist", 3) > 10.0);
  CHECK(value(text, "standing still writes obstacles that do not exist", 4) == 0.0);
  CHECK(value(text, "space behind walls is mapped when turning", 4) == 0.0);
  CHECK(value(text, "no multipath", 3) == 0.0);
  CHECK(value(text, "no multipath", 4) > 100.0);
  CHECK(value(text, "the floor's echo hides what is behind it", 3) < 2.0);
  CHECK(value(text, "the floor's echo hides what is behind it", 4) == doctest::Approx(5.0).epsilon(0.02));
  CHECK(value(text, "only the strongest echo of a direction is kept", 3) == 0.0);
  CHECK(value(text, "only the strongest echo of a direction is kept", 4) > 5.0);
  CHECK(cell(text, "Bug2 gives up where there is a way", 3) == "unreachable");
  CHECK(cell(text, "Bug2 gives up where there is a way", 4) == "reached");
}

}  // namespace thicket
