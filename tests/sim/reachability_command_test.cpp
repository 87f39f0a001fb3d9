// `thicket reachability` as it is called.
#include <doctest/doctest.h>

#include <algorithm>

#include "program_call.hpp"

namespace thicket {

TEST_CASE("thicket reachability prints a table, the same for any number of jobs, and rows of CSV") {
  const TemporaryFolder folder;
  const std::string study = "reachability --families convex,enclosed --problems 2 --planners bug1,bug2 --quiet";
  const Answer one = call(folder, study + " --jobs 1 --csv one.csv"), two = call(folder, study + " --jobs 2 --csv two.csv");
  CAPTURE(one.out);
  CHECK(one.code == 0);
  CHECK(one.err.empty());
  CHECK(one.out == two.out);
  CHECK(has(one.out, "planner  family    problems  right  wrong"));
  CHECK(has(one.out, "bug2     all"));
  const std::string csv = *read_text_file(folder.path() / "one.csv");
  CHECK(csv == *read_text_file(folder.path() / "two.csv"));
  CHECK(std::count(csv.begin(), csv.end(), '\n') == 9);
  CHECK(has(csv, "\n\"enclosed\",1,bug2,right,"));
}

TEST_CASE("thicket reachability tells what went wrong by exit code 6, how to repeat it, and keeps missions that run to the same end") {
  const TemporaryFolder folder;
  const Answer study = call(folder, "reachability --families convex --first 4 --problems 1 --planners bug2 --time-limit 1 --keep-failures kept");
  CHECK(study.code == 6);
  CHECK(has(study.out, "convex 4, bug2, left hand: reachable, but stopped: time limit of 1 s"));
  CHECK(has(study.out, "--families convex --first 4 --problems 1 --planners bug2 --hand left"));
  CHECK(has(study.err, "x real time"));
  const Answer run = call(folder, "run kept/convex-4-bug2-left.toml --json --quiet");
  CHECK(run.code == 4);
  CHECK(has(run.out, "\"time limit of 1 s\""));
  CHECK(has(run.out, "\"simulated_time_s\": 1.0"));
}

TEST_CASE("thicket reachability in one world") {
  const TemporaryFolder folder;
  const Answer answer = call(folder, "reachability --world foliage_wall/room_with_way_round --start -2,0,0 --goal -2.3,0.2 --clearance 0.1 --planners bug2 --hand both --csv - --quiet");
  CAPTURE(answer.err);
  CAPTURE(answer.out);
  CHECK(answer.code == 0);
  CHECK(has(answer.out, "\"room_with_way_round\",0,bug2,left,reachable,reached,right,"));
  CHECK(has(answer.out, "\"room_with_way_round\",0,bug2,right,"));
}

TEST_CASE("thicket reachability refuses what it cannot do, in words") {
  const TemporaryFolder folder;
  const auto refused = [&](const std::string& arguments, const std::string& words) {
    const Answer answer = call(folder, "reachability " + arguments);
    CAPTURE(arguments);
    CAPTURE(answer.err);
    CHECK(answer.code == 2);
    CHECK(has(answer.err, words));
  };
  refused("--families convexe --problems 1 --planners bug1", "convex");
  refused("--families convex --problems 1 --planners bug9", "there is no planner 'bug9'");
  refused("--families convex --problems 1 --planners bug1 --hand both_of_them", "there is no hand 'both_of_them'");
  refused("--families convex --problems 0", "--problems");
  refused("--set planner.clearence_m=1", "clearance_m");
  refused("--set nonsense", "expected KEY=VALUE");
  refused("--world foliage_wall/room_with_way_round --start 0 --goal 1,1", "--start is '0'");
  refused("--world nowhere.toml --start 0,0 --goal 1,1", "nowhere.toml");
}

}  // namespace thicket
