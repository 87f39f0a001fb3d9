// `thicket scan` and `thicket sensors`.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "program_call.hpp"
#include "thicket/base/files.hpp"
#include "thicket/base/image.hpp"

namespace thicket {
namespace {

using Rows = std::vector<std::map<std::string, std::string>>;

std::vector<std::string> fields_of(const std::string& line) {
  std::vector<std::string> fields;
  std::stringstream stream(line + ",");
  for (std::string field; std::getline(stream, field, ',');) fields.push_back(field);
  return fields;
}

/// CSV by its header.
Rows rows_of(const std::string& csv) {
  std::stringstream stream(csv);
  std::string line;
  REQUIRE(std::getline(stream, line));
  const auto head = fields_of(line);
  Rows rows;
  while (std::getline(stream, line)) {
    const auto fields = fields_of(line);
    REQUIRE_MESSAGE(fields.size() == head.size(), line);
    auto& row = rows.emplace_back();
    for (std::size_t i = 0; i < head.size(); ++i) row[head[i]] = fields[i];
  }
  return rows;
}

double number(const std::string& text) { return std::stod(text); }

/// A wall with its face at x = 5, of opaque matter with a reflectivity of 0.25: squarely, an echo of amplitude 0.5.
void write_wall(const TemporaryFolder& folder) {
  folder.write("wall.toml", "name = \"wall\"\n[material.stuff]\nreflectivity = 0.25\nattenuation_db_per_m = inf\n[[solid]]\ntype = \"box\"\nname = \"wall\"\nmaterial = \"stuff\"\n"
                            "position_m = [5.5, 0.0, 0.0]\nsize_m = [1.0, 20.0, 3.0]\n");
}

const std::string ahead = "scan wall.toml --pose 0,0,1,0 --sensor usarsim2012 --set fov_deg=60 --set step_deg=30 ";

}  // namespace

TEST_CASE("scan tells a wall at 5 m as a table, as CSV and as JSON") {
  const TemporaryFolder folder;
  write_wall(folder);
  const Answer table = call(folder, ahead);
  CHECK(table.err == "");
  CHECK(table.code == 0);
  CHECK_MESSAGE(has(table.out, "   0.00 deg  stopped   at    5.000 m     5.000 m    -6.0 dB front\n"), table.out);
  CHECK_MESSAGE(has(table.out, "3 echoes in 3 beams, 3 rays"), table.out);

  const Answer csv = call(folder, ahead + "--csv -");
  REQUIRE(csv.code == 0);
  const Rows rows = rows_of(csv.out);
  REQUIRE(rows.size() == 3);
  for (const auto& row : rows) {
    const double azimuth = number(row.at("azimuth_deg")), cosine = std::cos(azimuth * 3.14159265358979 / 180.0);
    CHECK(number(row.at("range_m")) == doctest::Approx(5.0 / cosine));
    CHECK(number(row.at("amplitude")) == doctest::Approx(0.5 * std::sqrt(cosine)));
    CHECK(number(row.at("power_db")) == doctest::Approx(20.0 * std::log10(0.5 * std::sqrt(cosine))));
    CHECK(number(row.at("incidence_deg")) == doctest::Approx(std::abs(azimuth)).epsilon(1e-4));
    CHECK(row.at("edge") == "front");
    CHECK(row.at("bounces") == "1");
    CHECK(row.at("echo") == "0");
    CHECK(row.at("radial_velocity_m_s") == "");
  }

  const Answer json = call(folder, ahead + "--json s.json --csv s.csv --png s.png --number 7");
  CHECK(json.out == "written    s.csv\nwritten    s.json\nwritten    s.png\n");
  CHECK(*read_text_file(folder.path() / "s.csv") == csv.out);
  const auto tree = nlohmann::json::parse(*read_text_file(folder.path() / "s.json"));
  CHECK(tree["world"] == "wall.toml");
  const auto& sensor = tree["sensors"][0];
  CHECK(sensor["type"] == "scanning_radar");
  CHECK(sensor["keys"]["step_deg"] == 30.0);
  const auto& scan = sensor["scans"][0];
  CHECK(scan["number"] == 7);
  CHECK(scan["pose"]["position_m"] == nlohmann::json({0.0, 0.0, 1.0}));
  REQUIRE(scan["beams"].size() == 3);
  for (std::size_t b = 0; b < 3; ++b) {
    const auto& echo = scan["beams"][b]["echoes"][0];
    CHECK(scan["beams"][b]["end"] == "stopped");
    CHECK(echo["range_m"] == number(rows[b].at("range_m")));
    CHECK(echo["amplitude"].get<double>() == doctest::Approx(number(rows[b].at("amplitude"))));
  }
  const auto image = read_image(folder.path() / "s.png");
  REQUIRE(image);
  CHECK(image->width >= 900);
  CHECK(image->width <= 1200);
  CHECK(image->height >= 500);
}

TEST_CASE("scan turns with yaw and pitch, and leaves the mount out") {
  const TemporaryFolder folder;
  write_wall(folder);
  const auto ranges = [&](const std::string& pose) {
    const Answer answer = call(folder, "scan wall.toml --pose " + pose + " --sensor usarsim2012 --set fov_deg=1 --set step_deg=1 --set range_max_m=100 --csv -");
    REQUIRE_MESSAGE(answer.code == 0, answer.err);
    const Rows rows = rows_of(answer.out);
    return rows.empty() ? 0.0 : number(rows.front().at("range_m"));
  };
  CHECK(ranges("1,0,0.5,0") == doctest::Approx(4.0).epsilon(1e-3));
  CHECK(ranges("10,2,0.5,180") == doctest::Approx(4.0).epsilon(1e-3));
  CHECK(ranges("0,0,0.5,180") == 0.0);
  CHECK(ranges("0,0,2.6,0,20") == doctest::Approx(5.0 / std::cos(20.0 * 3.14159265358979 / 180.0)).epsilon(1e-3));
  CHECK(ranges("0,0,0.5,0,-60") == 0.0);
}

TEST_CASE("scan compares two sensors, and --set changes the one that it names") {
  const TemporaryFolder folder;
  write_wall(folder);
  const Answer answer = call(folder, "scan wall.toml --pose 0,0,1,0 --sensor usarsim2012 --compare utm30lx --set utm30lx.step_deg=45 --csv two.csv --png two.png");
  REQUIRE_MESSAGE(answer.code == 0, answer.err);
  const Rows rows = rows_of(*read_text_file(folder.path() / "two.csv"));
  const auto of = [&](const std::string& sensor) { return std::count_if(rows.begin(), rows.end(), [&](const auto& row) { return row.at("sensor") == sensor; }); };
  CHECK(of("usarsim2012") == 127);             // the wall is seen to 10 m aside: atan(10 / 5) = 63.4 degrees
  CHECK(of("utm30lx with step_deg=45") == 3);  // at -45, 0 and 45 degrees
  const Answer table = call(folder, "scan wall.toml --pose 0,0,1,0 --sensor usarsim2012 --compare utm30lx --set range_max_m=4");
  CHECK_MESSAGE(has(table.out, "usarsim2012 with range_max_m=4: scanning_radar, 24 GHz, 360 deg in steps of 1 deg, 0 to 4 m"), table.out);
  CHECK_MESSAGE(has(table.out, "utm30lx: lidar, 270 deg in steps of 0.25 deg, 0.1 to 30 m"), table.out);
  CHECK(std::filesystem::exists(folder.path() / "two.png"));
}

TEST_CASE("scan along a way has a row for each pose") {
  const TemporaryFolder folder;
  write_wall(folder);
  const std::string way = "scan wall.toml --pose 0,0,1,0 --to 2,0,1,0 --steps 5 --sensor usarsim2012 --set fov_deg=60 --set step_deg=30 ";
  const Answer table = call(folder, way);
  REQUIRE_MESSAGE(table.code == 0, table.err);
  CHECK_MESSAGE(has(table.out, "     2.000       3.000      -6.0       3.000      -6.0       3"), table.out);
  REQUIRE(call(folder, way + "--csv way.csv --png way.png --json way.json --number 3").code == 0);
  const Rows rows = rows_of(*read_text_file(folder.path() / "way.csv"));
  REQUIRE(rows.size() == 5);
  for (std::size_t i = 0; i < 5; ++i) {
    const double x = 0.5 * static_cast<double>(i);
    CHECK(number(rows[i].at("scan")) == static_cast<double>(3 + i));
    CHECK(number(rows[i].at("way_m")) == doctest::Approx(x));
    CHECK(number(rows[i].at("x_m")) == doctest::Approx(x));
    CHECK(number(rows[i].at("first_range_m")) == doctest::Approx(5.0 - x));
    CHECK(number(rows[i].at("strongest_amplitude")) == doctest::Approx(0.5));
    // Two beams beside, at 30 degrees.
    CHECK(number(rows[i].at("sum_power_db")) == doctest::Approx(10.0 * std::log10(0.25 * (1.0 + std::sqrt(3.0)))));
    CHECK(rows[i].at("echoes") == "3");
  }
  CHECK(nlohmann::json::parse(*read_text_file(folder.path() / "way.json"))["sensors"][0]["scans"].size() == 5);
  CHECK(read_image(folder.path() / "way.png"));
}

TEST_CASE("scan that turns on the spot goes over its yaw, and one that tilts over its pitch") {
  const TemporaryFolder folder;
  write_wall(folder);
  const Answer turn = call(folder, "scan wall.toml --pose 0,-0.8,1,-30 --to 0,-0.8,1,30 --steps 7 --sensor usarsim2012 --set fov_deg=1 --png turn.png");
  CHECK(turn.code == 0);
  CHECK(has(call(folder, "scan wall.toml --pose 0,-0.8,1,-30 --to 0,-0.8,1,30 --steps 7 --sensor usarsim2012 --set fov_deg=1").out, "  yaw, deg  "));
  CHECK(has(call(folder, "scan wall.toml --pose 0,-0.8,1,0,-9 --to 0,-0.8,1,0,9 --steps 7 --sensor usarsim2012 --set fov_deg=1").out, "pitch, deg  "));
  CHECK(has(call(folder, "scan wall.toml --pose 0,-0.8,1,0 --to 0,-0.8,1,0 --steps 3 --number 4 --sensor usarsim2012 --set fov_deg=1").out, "\n     6.000  "));
}

TEST_CASE("scan reads poses from a table, with a label to draw over") {
  const TemporaryFolder folder;
  write_wall(folder);
  folder.write("p.csv", "x_m,y_m,z_m,yaw_deg,pitch_deg,label\n0,0,1,0,0,10\n1, 0, 1, 0, 0, 20\r\n\n# a remark\n2,0,1,0,0,30\n");
  const Answer answer = call(folder, "scan wall.toml --poses p.csv --x-label 'tilt, deg' --sensor usarsim2012 --csv o.csv --png o.png");
  REQUIRE_MESSAGE(answer.code == 0, answer.err);
  const Rows rows = rows_of(*read_text_file(folder.path() / "o.csv"));
  REQUIRE(rows.size() == 3);
  CHECK(rows[1].at("label") == "20");
  CHECK(rows[2].at("first_range_m") == "3");
  CHECK(has(call(folder, "scan wall.toml --poses p.csv --x-label 'tilt, deg' --sensor usarsim2012").out, " tilt, deg "));

  for (const auto& [text, words] : {std::pair{"", "the file is empty, expected a header"}, {"x_m,y_m,z_m\n0,0,0\n", "bad.csv:1: the header lacks 'yaw_deg'"},
                                    {"x_m,y_m,z_m,yaw_degg\n", "there is no column 'yaw_degg', expected a header of"}, {"x_m,y_m,z_m,yaw_deg\n", "no pose comes after the header"},
                                    {"x_m,y_m,z_m,yaw_deg\n0,0,0\n", "bad.csv:2: the line has 3 values, expected 4"}, {"x_m,y_m,z_m,yaw_deg\n0,0,zero,0\n", "bad.csv:2: 'z_m' is 'zero', expected a number"},
                                    {"x_m,y_m,z_m,yaw_deg,x_m\n", "the column 'x_m' is there twice"}, {"x_m,y_m,z_m,yaw_deg\n0,0,nan,0\n", "'z_m' is 'nan'"}}) {
    CAPTURE(text);
    folder.write("bad.csv", text);
    const Answer bad = call(folder, "scan wall.toml --poses bad.csv --sensor usarsim2012");
    CHECK(bad.code == 2);
    CHECK_MESSAGE(has(bad.err, words), bad.err);
  }
}

TEST_CASE("scan refuses what makes no sense, with exit code 2 and a hint") {
  const TemporaryFolder folder;
  write_wall(folder);
  folder.write("p.csv", "x_m,y_m,z_m,yaw_deg\n0,0,1,0\n");
  const std::string from = "scan wall.toml --pose 0,0,1,0 ", full = from + "--sensor usarsim2012 ";
  for (const auto& [arguments, words] : std::vector<std::pair<std::string, std::string>>{
           {"scan", "scan lacks a world and --pose X,Y,Z,YAW_DEG (or --poses FILE.csv) and --sensor NAME"},
           {"scan", "for example: thicket scan solids/wall --pose 0,-0.8,0.5,90 --sensor usarsim2012"},
           {from, "scan lacks --sensor NAME (`thicket sensors` lists them), for example"},
           {"scan wall.toml --sensor usarsim2012", "scan lacks --pose X,Y,Z,YAW_DEG"},
           {"scan nowhere --pose 0,0,1,0 --sensor usarsim2012", "there is no world 'nowhere'"},
           {from + "--sensor usarsim2013", "did you mean 'usarsim2012'?"},
           {full + "--compare utm30ly", "--compare: there is no sensor preset 'utm30ly'"},
           {full + "--set step_dg=2", "did you mean 'step_deg'?"},
           {full + "--set step_deg", "--set is 'step_deg', expected KEY=VALUE"},
           {full + "--set step_deg=wide", "'step_deg' is"},
           {full + "--set usarsim2011.step_deg=2", "did you mean 'usarsim2012'?"},
           {"scan wall.toml --pose 0,0,1 --sensor usarsim2012", "--pose is '0,0,1', expected X,Y,Z,YAW_DEG"},
           {"scan wall.toml --pose 0,0,1,north --sensor usarsim2012", "--pose is '0,0,1,north'"},
           {"scan wall.toml --pose 0,0,1e10,0 --sensor usarsim2012", "expected numbers of at most 1e9"},
           {full + "--to 1,0,1,0", "--to lacks --steps N"},
           {full + "--steps 5", "--steps lacks --to X,Y,Z,YAW_DEG"},
           {full + "--to 1,0,1,0 --steps 1", "--steps is 1, expected 2 to"},
           {full + "--to 1,0,1 --steps 3", "--to is '1,0,1'"},
           {full + "--poses p.csv", "leave --pose, --to and --steps out"},
           {full + "--x-label tilt", "--x-label names the column 'label'"},
           {"scan wall.toml --poses p.csv --x-label tilt --sensor usarsim2012", "there is no column 'label'"},
           {"scan wall.toml --poses q.csv --sensor usarsim2012", "q.csv"},
           {full + "--velocity 1", "--velocity is '1', expected VX,VY,VZ"},
           {full + "--time nan", "--time is nan"},
           {full + "--seed -1", "--seed is -1"},
           {full + "--number -1", "--number is -1"},
           {full + "--png o.jpg", "expected a name ending in .png"},
           {full + "--csv o --json o", "two outputs go to 'o'"},
           {full + "--csv wall.toml", "would be overwritten while it is read"},
           {full + "--profile-csv o.csv", "no sensor has a receiver with range bins"},
       }) {
    CAPTURE(arguments);
    const Answer answer = call(folder, arguments);
    CHECK(answer.code == 2);
    CHECK_MESSAGE(has(answer.err, words), answer.err);
  }
  for (const char* name : {"o", "o.jpg", "o.csv"}) CHECK_FALSE(std::filesystem::exists(folder.path() / name));
}

TEST_CASE("sensors lists what can scan, and writes the keys of one so that they read back") {
  const TemporaryFolder folder;
  write_wall(folder);
  const Answer all = call(folder, "sensors");
  CHECK(all.code == 0);
  CHECK_MESSAGE(has(all.out, "usarsim2012  scanning_radar"), all.out);
  CHECK_MESSAGE(has(all.out, "utm30lx      lidar"), all.out);
  const Answer one = call(folder, "sensors usarsim2012");
  CHECK(one.out.starts_with("# The penetrating scanning radar of"));
  CHECK(has(one.out, "\ntype = \"scanning_radar\"\n"));
  CHECK(has(one.out, "\nscattering = \"lambert\"\n"));
  folder.write("mine.toml", one.out);
  CHECK(call(folder, "scan wall.toml --pose 0,0,1,0 --sensor mine.toml --csv -").out == call(folder, "scan wall.toml --pose 0,0,1,0 --sensor usarsim2012 --csv -").out);
  CHECK(call(folder, "sensors mine.toml").out == one.out);
  const Answer none = call(folder, "sensors usarsim2013");
  CHECK(none.code == 2);
  CHECK_MESSAGE(has(none.err, "did you mean 'usarsim2012'?"), none.err);
}

}  // namespace thicket
