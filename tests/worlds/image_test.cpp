#include "thicket/base/image.hpp"

#include <doctest/doctest.h>

#include <numeric>
#include <string>
#include <string_view>

#include "../outside_data.hpp"
#include "../temporary_folder.hpp"
#include "thicket/base/files.hpp"

using namespace thicket;
namespace fs = std::filesystem;
using Bytes = std::vector<std::uint8_t>;

namespace {

/// An image file that is read, and the message without the folder's name if it cannot be.
struct Reading {
  GreyImage image;
  std::string error;
};

Reading read_bytes(std::string_view bytes) {
  const TemporaryFolder folder;
  const auto image = read_image(folder.write("i", bytes));
  if (image) return {*image, ""};
  return {{}, image.error().message.substr(folder.path().string().size() + 1)};
}

std::string error_of(std::string_view bytes) {
  return read_bytes(bytes).error;
}

// ---- A PNG maker that shares nothing with libspng: stored (uncompressed) deflate blocks, checksums written out.

std::string big_endian(std::uint32_t value) {
  std::string bytes;
  for (const unsigned shift : {24U, 16U, 8U, 0U}) bytes += static_cast<char>(value >> shift & 0xffU);
  return bytes;
}

std::string chunk(const std::string& type, const std::string& data) {
  std::uint32_t crc = 0xffffffffU;
  for (const char byte : type + data) {
    crc ^= static_cast<std::uint8_t>(byte);
    for (int bit = 0; bit < 8; ++bit) crc = crc >> 1U ^ (crc & 1U ? 0xedb88320U : 0U);
  }
  return big_endian(static_cast<std::uint32_t>(data.size())) + type + data + big_endian(~crc);
}

std::string stored(const std::string& data) {
  std::uint32_t low = 1, high = 0;
  for (const char byte : data) {
    low = (low + static_cast<std::uint8_t>(byte)) % 65521U;
    high = (high + low) % 65521U;
  }
  const auto size = static_cast<std::uint16_t>(data.size());
  const auto byte = [](int value) { return static_cast<char>(value & 0xff); };
  return std::string("\x78\x01\x01", 3) + byte(size) + byte(size >> 8) + byte(~size) + byte(~size >> 8) + data +
         big_endian(high << 16U | low);
}

struct Png {
  std::uint32_t width, height;
  int depth, colour_type, interlace = 0;
  std::string extra{};  ///< chunks between header and data
};

/// `rows` holds each row with its filter byte (0) in front.
std::string png(const Png& header, const std::string& rows) {
  std::string head = big_endian(header.width) + big_endian(header.height);
  for (const int value : {header.depth, header.colour_type, 0, 0, header.interlace}) head += static_cast<char>(value);
  return "\x89PNG\r\n\x1a\n" + chunk("IHDR", head) + header.extra + chunk("IDAT", stored(rows)) + chunk("IEND", "");
}

std::string bytes(std::initializer_list<int> values) {
  std::string text;
  for (const int value : values) text += static_cast<char>(value);
  return text;
}

}  // namespace

TEST_CASE("PGM, binary") {
  const auto [image, error] = read_bytes("P5\n3 2\n255\n" + bytes({0, 1, 2, 253, 254, 255}));
  REQUIRE(error == "");
  CHECK(image.width == 3);
  CHECK(image.height == 2);
  CHECK(image.pixels == Bytes{0, 1, 2, 253, 254, 255});
  CHECK(image.alpha.empty());
  CHECK(image.at(2, 0) == 2);
  CHECK(image.at(0, 1) == 253);
}

TEST_CASE("PGM, text") {
  CHECK(read_bytes("P2\n3 2\n255\n0 1 2\n253\t254\r\n255\n").image.pixels == Bytes{0, 1, 2, 253, 254, 255});
  CHECK(read_bytes("P2 3 2 255 0 1 2 253 254 255").image.pixels == Bytes{0, 1, 2, 253, 254, 255});
  CHECK(read_bytes("P2 2 2 9 0 9 9 0").image.pixels == Bytes{0, 255, 255, 0});  // the shortest text there is
}

TEST_CASE("PGM, comments anywhere in the header") {
  CHECK(read_bytes("P5#a\n#b 9 9\n 2 #c\n#d\n1\n#e\n255#f\n" + bytes({7, 8})).image.pixels == Bytes{7, 8});
  CHECK(read_bytes("P2\n# CREATOR: x\n2 1\n255\n7 # seven\n8#eight").image.pixels == Bytes{7, 8});
}

TEST_CASE("PGM, binary data may look like anything") {
  CHECK(read_bytes("P5 3 1 255\n" + bytes({'\n', '#', ' '})).image.pixels == Bytes{'\n', '#', ' '});
  CHECK(read_bytes("P5 1 1 255\n" + bytes({9, 26, 26})).image.pixels == Bytes{9});  // what follows is not looked at
}

TEST_CASE("PGM, lines ended by an editor for Windows") {
  CHECK(read_bytes("P5\r\n2 1\r\n255\r\n" + bytes({7, 8})).image.pixels == Bytes{7, 8});
}

TEST_CASE("PGM, other maxima are scaled to 255 and rounded") {
  CHECK(read_bytes("P2 4 1 3 0 1 2 3").image.pixels == Bytes{0, 85, 170, 255});
  CHECK(read_bytes("P2 3 1 100 0 50 100").image.pixels == Bytes{0, 128, 255});  // 127.5
  CHECK(read_bytes("P5 2 1 1\n" + bytes({0, 1})).image.pixels == Bytes{0, 255});
  CHECK(read_bytes("P2 4 1 65535 0 52685 65278 65535").image.pixels == Bytes{0, 205, 254, 255});
}

TEST_CASE("PGM, 16 bits are big-endian") {
  CHECK(read_bytes("P5 3 1 65535\n" + bytes({0x00, 0xff, 0xcd, 0xcd, 0xff, 0x00})).image.pixels == Bytes{1, 205, 254});
  CHECK(read_bytes("P5 2 1 256\n" + bytes({0x00, 0x80, 0x01, 0x00})).image.pixels == Bytes{128, 255});
}

TEST_CASE("PGM, truncated") {
  CHECK(error_of("P5 3 2 255\n12345") == "i: PGM: truncated: expected 6 bytes of pixels after the header, found 5");
  CHECK(error_of("P5 3 2 65535\n12345678901") == "i: PGM: truncated: expected 12 bytes of pixels after the header, found 11");
  CHECK(error_of("P5 3 2 255\n") == "i: PGM: truncated: expected 6 bytes of pixels after the header, found 0");
  CHECK(error_of("P5 3 2 255") == "i: PGM: truncated: expected 6 bytes of pixels after the header, found 0");
  CHECK(error_of("P5 3 2 255#") == "i: PGM: truncated: expected 6 bytes of pixels after the header, found 0");
  CHECK(error_of("P2 3 2 255\n1 2 3 4 5\n") == "i: PGM: truncated: expected 6 values after the header, found 5");
  CHECK(error_of("P2 3 2 255") == "i: PGM: truncated: expected 6 values after the header, found 0");
  CHECK(error_of("P5 3 2 ") == "i: PGM: truncated: the file ends before its maximum");
  CHECK(error_of("P5 3#") == "i: PGM: truncated: the file ends before its height");
  CHECK(error_of("P2\n") == "i: PGM: truncated: the file ends before its width");
}

TEST_CASE("PGM, a large header takes no memory that the data does not fill") {
  CHECK(error_of("P5 16384 16384 255\n") == "i: PGM: truncated: expected 268435456 bytes of pixels after the header, found 0");
  CHECK(error_of("P2 16384 16384 255\n1 2") == "i: PGM: truncated: expected 268435456 values after the header, found 2");
  CHECK(error_of("P5 16384 16385 255\n") == "i: PGM: the size is 16384 x 16385, expected at most 268435456 pixels");
  CHECK(error_of("P2 2147483647 2147483647 255\n") == "i: PGM: the size is 2147483647 x 2147483647, expected at most 268435456 pixels");
}

TEST_CASE("PGM, numbers that are none or out of range") {
  CHECK(error_of("P5 2147483648 1 255\n") == "i:1: PGM: the width is '2147483648', expected a whole number from 0 to 2147483647");
  CHECK(error_of("P5\n99999999999999999999 1 255\n").starts_with("i:2: PGM: the width is '99999999999999999999', expected"));
  CHECK(error_of("P5 0 1 255\n") == "i: PGM: the size is 0 x 1, expected at least 1 x 1");
  CHECK(error_of("P5 1 0 255\n") == "i: PGM: the size is 1 x 0, expected at least 1 x 1");
  CHECK(error_of("P5 1 1 0\n1") == "i: PGM: the maximum is 0, expected 1 to 65535");
  CHECK(error_of("P5 1 1 65536\n11") == "i:1: PGM: the maximum is '65536', expected a whole number from 0 to 65535");
  CHECK(error_of("P5\n3\n-2 255\n") == "i:3: PGM: the height is '-2', expected a whole number from 0 to 2147483647");
  CHECK(error_of("P5 3 2.5 255\n") == "i:1: PGM: the height is '2.5', expected a whole number from 0 to 2147483647");
  CHECK(error_of("P2\n2 2\n9\n1 2\n3 x\n") == "i:5: PGM: the pixel in column 1, row 1 is 'x', expected a whole number from 0 to 9");
  CHECK(error_of("P2\n2 2\n9\n1 2\n10 3\n") == "i:5: PGM: the pixel in column 0, row 1 is '10', expected a whole number from 0 to 9");
  CHECK(error_of("P5 2 2 9\n" + bytes({1, 2, 3, 10})) == "i: PGM: the pixel in column 1, row 1 is 10, expected 0 to 9");
  CHECK(error_of("P5 1 1 256\n" + bytes({1, 1})) == "i: PGM: the pixel in column 0, row 0 is 257, expected 0 to 256");
  CHECK(error_of("P5 1 1 25\x01\xff\n1") == "i:1: PGM: the maximum is '25..', expected a whole number from 0 to 65535");
}

TEST_CASE("the format is told by the first bytes") {
  CHECK(error_of("") == "i: is empty, expected PGM (P5 or P2) or PNG");
  CHECK(error_of("P5") == "i: begins with 'P5', expected PGM (P5 or P2) or PNG");
  CHECK(error_of("P6 1 1 255\n123") == "i: begins with 'P6 1 1 2', expected PGM (P5 or P2) or PNG");
  CHECK(error_of("P51 1 255\n1") == "i: begins with 'P51 1 25', expected PGM (P5 or P2) or PNG");
  CHECK(error_of("\xff\xd8\xff\xe0") == "i: begins with '....', expected PGM (P5 or P2) or PNG");
  CHECK(read_image("/nowhere/map.pgm").error().message == "/nowhere/map.pgm: does not exist");
  const TemporaryFolder folder;
  CHECK(read_image(folder.write("named.png", "P2 1 1 9 9"))->pixels == Bytes{255});
}

TEST_CASE("PNG, grey of every depth") {
  CHECK(read_bytes(png({3, 1, 8, 0}, bytes({0, 0, 205, 255}))).image.pixels == Bytes{0, 205, 255});
  CHECK(read_bytes(png({3, 1, 1, 0}, bytes({0, 0b10100000}))).image.pixels == Bytes{255, 0, 255});
  CHECK(read_bytes(png({4, 1, 2, 0}, bytes({0, 0b00011011}))).image.pixels == Bytes{0, 85, 170, 255});
  CHECK(read_bytes(png({2, 1, 4, 0}, bytes({0, 0x3f}))).image.pixels == Bytes{51, 255});
  CHECK(read_bytes(png({2, 1, 16, 0}, bytes({0, 0xcd, 0xcd, 0xff, 0xff}))).image.pixels == Bytes{205, 255});
  CHECK(read_bytes(png({1, 1, 8, 0}, bytes({0, 9}))).image.alpha.empty());
}

TEST_CASE("PNG, colours become the mean of red, green and blue") {
  const auto [image, error] = read_bytes(png({4, 1, 8, 2}, bytes({0, 10, 20, 30, 255, 0, 0, 0, 0, 2, 255, 255, 255})));
  REQUIRE(error == "");
  CHECK(image.pixels == Bytes{20, 85, 1, 255});  // (0 + 0 + 2) / 3 is nearer to 1
  CHECK(image.alpha.empty());
  CHECK(read_bytes(png({1, 1, 16, 2}, bytes({0, 10, 0, 20, 0, 30, 0}))).image.pixels == Bytes{20});
  const std::string palette = chunk("PLTE", bytes({0, 0, 0, 30, 60, 90}));
  CHECK(read_bytes(png({2, 1, 8, 3, 0, palette}, bytes({0, 1, 0}))).image.pixels == Bytes{60, 0});
}

TEST_CASE("PNG, transparency") {
  const auto grey = read_bytes(png({2, 1, 8, 4}, bytes({0, 50, 0, 60, 255}))).image;
  CHECK(grey.pixels == Bytes{50, 60});
  CHECK(grey.alpha == Bytes{0, 255});
  const auto colour = read_bytes(png({2, 1, 8, 6}, bytes({0, 10, 20, 30, 7, 0, 0, 0, 255}))).image;
  CHECK(colour.pixels == Bytes{20, 0});
  CHECK(colour.alpha == Bytes{7, 255});
  // One grey, or entries of the palette, declared transparent.
  const auto keyed = read_bytes(png({2, 1, 8, 0, 0, chunk("tRNS", bytes({0, 205}))}, bytes({0, 205, 254}))).image;
  CHECK(keyed.pixels == Bytes{205, 254});
  CHECK(keyed.alpha == Bytes{0, 255});
  const std::string palette = chunk("PLTE", bytes({9, 9, 9, 30, 60, 90})) + chunk("tRNS", bytes({0}));
  CHECK(read_bytes(png({2, 1, 8, 3, 0, palette}, bytes({0, 1, 0}))).image.alpha == Bytes{255, 0});
}

TEST_CASE("PNG, rows in order") {
  CHECK(read_bytes(png({2, 3, 8, 0}, bytes({0, 1, 2, 0, 3, 4, 0, 5, 6}))).image.pixels == Bytes{1, 2, 3, 4, 5, 6});
}

TEST_CASE("PNG, interlaced: each pixel comes to its place") {
  // Pixel (x, y) is 10 y + x. The passes of Adam7, for every size up to 9 x 9, so that some passes are empty.
  constexpr struct {
    std::uint32_t x, y, dx, dy;
  } passes[] = {{0, 0, 8, 8}, {4, 0, 8, 8}, {0, 4, 4, 8}, {2, 0, 4, 4}, {0, 2, 2, 4}, {1, 0, 2, 2}, {0, 1, 1, 2}};
  for (std::uint32_t width = 1; width <= 9; ++width) {
    for (std::uint32_t height = 1; height <= 9; ++height) {
      CAPTURE(width);
      CAPTURE(height);
      std::string rows;
      for (const auto& pass : passes) {
        for (std::uint32_t y = pass.y; y < height && pass.x < width; y += pass.dy) {
          rows += '\0';
          for (std::uint32_t x = pass.x; x < width; x += pass.dx) rows += static_cast<char>(10 * y + x);
        }
      }
      Bytes expected;
      for (std::uint32_t y = 0; y < height; ++y) {
        for (std::uint32_t x = 0; x < width; ++x) expected.push_back(static_cast<std::uint8_t>(10 * y + x));
      }
      const auto [image, error] = read_bytes(png({width, height, 8, 0, 1}, rows));
      CHECK(error == "");
      CHECK(image.pixels == expected);
    }
  }
}

TEST_CASE("PNG, broken in every way that a byte can be missing or wrong") {
  const std::string whole = png({3, 2, 8, 0}, bytes({0, 1, 2, 3, 0, 4, 5, 6}));
  REQUIRE(error_of(whole) == "");
  for (std::size_t size = 8; size < whole.size() - 4; ++size) {  // the last four bytes are a checksum of nothing
    CAPTURE(size);
    CHECK(error_of(whole.substr(0, size)) == "i: PNG: truncated: the file ends before the image does");
  }
  for (std::size_t at = 8; at < whole.size(); ++at) {
    CAPTURE(at);
    std::string broken = whole;
    broken[at] = static_cast<char>(broken[at] ^ 0x10);
    CHECK(error_of(broken) != "");
  }
  CHECK(error_of(png({3, 2, 8, 0}, bytes({0, 1, 2, 3}))) != "");  // one row of two
}

TEST_CASE("PNG, a large header is refused before memory is taken") {
  CHECK(error_of(png({16384, 16385, 8, 0}, "")) == "i: PNG: the size is 16384 x 16385, expected at most 268435456 pixels");
  CHECK(error_of(png({0, 1, 8, 0}, "")).starts_with("i: PNG: "));
  const std::string small = png({16384, 16384, 8, 0}, "x");
  CHECK(error_of(small) == "i: PNG: truncated: " + std::to_string(small.size()) + " bytes cannot hold 16384 x 16384 pixels");
}

TEST_CASE("what is written is read again") {
  const TemporaryFolder folder;
  GreyImage image{16, 16, Bytes(256), {}};
  std::iota(image.pixels.begin(), image.pixels.end(), std::uint8_t{0});
  const fs::path pgm = folder.path() / "new" / "all.pgm", png_file = folder.path() / "all.png";
  REQUIRE(write_pgm(pgm, image));
  REQUIRE(write_png(png_file, image));
  for (const fs::path& file : {pgm, png_file}) {
    const auto again = read_image(file);
    REQUIRE(again);
    CHECK(again->width == 16);
    CHECK(again->height == 16);
    CHECK(again->pixels == image.pixels);
    CHECK(again->alpha.empty());
  }
  CHECK(read_text_file(pgm)->substr(0, 15) == std::string("P5\n16 16\n255\n\0\1", 15));

  image.alpha.assign(image.pixels.rbegin(), image.pixels.rend());
  REQUIRE(write_png(png_file, image));
  CHECK(read_image(png_file)->pixels == image.pixels);
  CHECK(read_image(png_file)->alpha == image.alpha);
  REQUIRE(write_pgm(pgm, image));
  CHECK(read_image(pgm)->alpha.empty());
}

TEST_CASE("an image that does not fit its size is not written") {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "x";
  for (const auto write : {write_pgm, write_png}) {
    CHECK(write(file, {2, 2, Bytes(3), {}}).error().message ==
          file.string() + ": 3 pixels and 0 values of alpha, expected 2 x 2 of each (or no alpha)");
    CHECK(write(file, {2, 2, Bytes(4), Bytes(1)}).error().message ==
          file.string() + ": 4 pixels and 1 values of alpha, expected 2 x 2 of each (or no alpha)");
    CHECK(write(file, {0, 2, {}, {}}).error().message == file.string() + ": the size is 0 x 2, expected at least 1 x 1");
    CHECK(write(file, {-1, -1, Bytes(1), {}}).error().message == file.string() + ": the size is -1 x -1, expected at least 1 x 1");
  }
  CHECK_FALSE(fs::exists(file));
}

TEST_CASE("images from elsewhere") {
  struct Expected {
    const char* name;
    int width, height;
  };
  for (const Expected& expected : {Expected{"ros_maps/turtlebot3_world.pgm", 384, 384}, Expected{"ros_maps/nav2_depot.pgm", 604, 307},
                                   Expected{"ros_maps/tuw_test04.pgm", 500, 500}, Expected{"ros_maps/nav2_TenByTen.pgm", 10, 10}}) {
    const auto file = outside_data(expected.name);
    if (!file) {
      MESSAGE("skipped: no outside data");
      return;
    }
    const auto image = read_image(*file);
    REQUIRE(image);
    CHECK(image->width == expected.width);
    CHECK(image->height == expected.height);
  }
}
