// `thicket picture`, and the page that `thicket help world --markdown` is a part of.
#include <doctest/doctest.h>

#include <string>
#include <utility>

#include "program_call.hpp"
#include "thicket/base/files.hpp"
#include "thicket/base/image.hpp"

namespace thicket {
TEST_CASE("picture draws a shipped world") {
  const TemporaryFolder folder;
  const Answer answer = call(folder, "picture solids/smoke --out s.png --size 64x40");
  CHECK(answer.err == "");
  CHECK(answer.code == 0);
  CHECK(has(answer.out, "camera     --from "));
  const auto image = read_image(folder.path() / "s.png");
  REQUIRE(image);
  CHECK(image->width == 64);
  CHECK(image->height == 40);
  // The camera that it tells draws the same picture.
  const std::string camera = answer.out.substr(11, answer.out.find('\n') - 11);
  CHECK(call(folder, "picture solids/smoke --out t.png --size 64x40 " + camera).out == answer.out.substr(0, answer.out.find("s.png")) + "t.png\n");
}

TEST_CASE("picture refuses what makes no sense, with exit code 2") {
  const TemporaryFolder folder;
  for (const auto& [arguments, words] :
       {std::pair{"picture solids/box", "--out is required"}, {"picture nowhere --out p.png", "there is no world 'nowhere'"}, {"picture foliage_wall/bug2 --out p.png", "this is a mission and not a world"},
        {"picture solids/box --out p.jpg", "expected a name ending in .png"}, {"picture solids/box --out p.png --size 10", "--size is '10', expected WIDTHxHEIGHT"},
        {"picture solids/box --out p.png --size 0x10", "expected 1 to 8192"}, {"picture solids/box --out p.png --from 1,2", "--from is '1,2', expected X,Y,Z"},
        {"picture solids/box --out p.png --at 1,2,x", "--at is '1,2,x', expected X,Y,Z"}, {"picture solids/box --out p.png --fov-deg 0", "expected 1 to 150"},
        {"picture solids/box --out p.png --hide crat", "there is no solid 'crat' to hide"}, {"picture solids/box --out p.png --time inf", "--time is inf"}, {"help mission --markdown", "--markdown is for"}}) {
    CAPTURE(arguments);
    const Answer answer = call(folder, arguments);
    CHECK(answer.code == 2);
    CHECK_MESSAGE(has(answer.err, words), answer.err);
  }
  CHECK_FALSE(std::filesystem::exists(folder.path() / "p.png"));
}

TEST_CASE("the keys in docs/worlds.md are those of the program") {
  const TemporaryFolder folder;
  const Answer answer = call(folder, "help world --markdown");
  REQUIRE(answer.code == 0);
  const auto page = read_text_file(THICKET_SOURCE_ROOT "/docs/worlds.md");
  REQUIRE(page);
  const std::string begin = "<!-- keys: thicket help world --markdown -->\n", end = "<!-- end of keys -->";
  const std::size_t from = page->find(begin), to = page->find(end);
  REQUIRE(from != std::string::npos);
  REQUIRE(to != std::string::npos);
  const std::string block = page->substr(from + begin.size(), to - from - begin.size());
  CHECK_MESSAGE(block == "\n" + answer.out + "\n", "docs/worlds.md is out of date: docs/keys.sh renews it");
}

TEST_CASE("worlds of each solid are shipped and can be read") {
  const TemporaryFolder folder;
  for (const char* name : {"box", "sphere", "cylinder", "wall", "prism", "map", "mesh", "tree", "hedge", "tilted", "instances", "motion", "smoke"}) {
    const Answer answer = call(folder, std::string("check solids/") + name);
    CHECK_MESSAGE(answer.code == 0, answer.err);
    CHECK_FALSE(has(answer.out + answer.err, "has been left out"));
  }
}

}  // namespace thicket
