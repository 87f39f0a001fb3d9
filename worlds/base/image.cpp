#include "thicket/base/image.hpp"

#include <fmt/format.h>
#include <spng.h>

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "printable.hpp"
#include "thicket/base/files.hpp"

namespace thicket {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view png_signature = "\x89PNG\r\n\x1a\n";

/// Why an image of this size is not read, or nothing.
std::optional<std::string> size_fault(std::int64_t width, std::int64_t height) {
  if (width < 1 || height < 1) return fmt::format("the size is {} x {}, expected at least 1 x 1", width, height);
  if (width > max_image_pixels / height) {
    return fmt::format("the size is {} x {}, expected at most {} pixels", width, height, max_image_pixels);
  }
  return std::nullopt;
}

std::size_t pixel_count(const GreyImage& image) {
  return static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
}

bool is_space(char letter) {
  return letter == ' ' || (letter >= '\t' && letter <= '\r');
}

/// Reads one PGM whose first two bytes are known to be P5 or P2.
class PgmReader {
 public:
  PgmReader(const fs::path& file, std::string_view content) : file_(file), content_(content) {}

  Result<GreyImage> read() {
    constexpr std::int64_t largest[] = {0x7fffffff, 0x7fffffff, 65535};
    constexpr const char* names[] = {"width", "height", "maximum"};
    std::int64_t header[3] = {};
    for (int i = 0; i < 3; ++i) {
      if (!next_word()) return fault(fmt::format("truncated: the file ends before its {}", names[i]));
      const auto number = word_as_number(largest[i]);
      if (!number) return bad_word(fmt::format("the {}", names[i]), largest[i]);
      header[i] = *number;
    }
    if (const auto wrong = size_fault(header[0], header[1])) return fault(*wrong);
    if (header[2] == 0) return fault("the maximum is 0, expected 1 to 65535");
    image_.width = static_cast<int>(header[0]);
    image_.height = static_cast<int>(header[1]);
    maximum_ = static_cast<std::uint32_t>(header[2]);
    return content_[1] == '5' ? read_binary() : read_text();
  }

 private:
  Result<GreyImage> read_binary() {
    const std::size_t bytes_each = maximum_ > 255 ? 2 : 1;
    const std::size_t expected = pixel_count(image_) * bytes_each;
    // One space, or a comment's end, closes the header. A Windows editor makes two bytes of a line's end: the file's length tells.
    if (position_ < content_.size() && content_[position_] == '#') position_ = std::min(content_.find('\n', position_), content_.size());
    if (content_.substr(position_, 2) == "\r\n" && content_.size() == position_ + 2 + expected) ++position_;
    const std::string_view data = content_.substr(std::min(position_ + 1, content_.size()));
    if (data.size() < expected) {
      return fault(fmt::format("truncated: expected {} bytes of pixels after the header, found {}", expected, data.size()));
    }
    image_.pixels.resize(pixel_count(image_));
    for (std::size_t i = 0; i < image_.pixels.size(); ++i) {
      std::uint32_t value = static_cast<std::uint8_t>(data[i * bytes_each]);
      if (bytes_each == 2) value = value << 8U | static_cast<std::uint8_t>(data[2 * i + 1]);
      if (value > maximum_) return fault(fmt::format("{} is {}, expected 0 to {}", pixel_name(i), value, maximum_));
      image_.pixels[i] = scaled(value);
    }
    return std::move(image_);
  }

  Result<GreyImage> read_text() {
    // A value takes a digit and a space, the last one only a digit: no memory is taken for more than the file can hold.
    image_.pixels.reserve(std::min(pixel_count(image_), (content_.size() - position_ + 1) / 2));
    while (image_.pixels.size() < pixel_count(image_)) {
      if (!next_word()) {
        return fault(fmt::format("truncated: expected {} values after the header, found {}", pixel_count(image_), image_.pixels.size()));
      }
      const auto value = word_as_number(maximum_);
      if (!value) return bad_word(pixel_name(image_.pixels.size()), maximum_);
      image_.pixels.push_back(scaled(static_cast<std::uint32_t>(*value)));
    }
    return std::move(image_);
  }

  /// Passes spaces and comments (to the end of their line) and takes what follows as `word_`; false at the end of the file.
  bool next_word() {
    while (position_ < content_.size() && (is_space(content_[position_]) || content_[position_] == '#')) {
      position_ = content_[position_] == '#' ? std::min(content_.find('\n', position_), content_.size()) : position_ + 1;
    }
    const std::size_t begin = position_;
    while (position_ < content_.size() && !is_space(content_[position_]) && content_[position_] != '#') ++position_;
    word_ = content_.substr(begin, position_ - begin);
    return !word_.empty();
  }

  std::optional<std::int64_t> word_as_number(std::int64_t largest) const {
    std::int64_t number = 0;
    const char* const end = word_.data() + word_.size();
    const auto [stop, failure] = std::from_chars(word_.data(), end, number);
    if (failure != std::errc{} || stop != end || number < 0 || number > largest) return std::nullopt;
    return number;
  }

  std::uint8_t scaled(std::uint32_t value) const { return static_cast<std::uint8_t>((value * 255 + maximum_ / 2) / maximum_); }

  std::string pixel_name(std::size_t index) const {
    const auto width = static_cast<std::size_t>(image_.width);
    return fmt::format("the pixel in column {}, row {}", index % width, index / width);
  }

  Error fault(std::string_view what) const { return Error{fmt::format("{}: PGM: {}", file_.string(), what)}; }

  Error bad_word(std::string_view what, std::int64_t largest) const {
    const auto line = 1 + std::count(content_.data(), word_.data(), '\n');
    const auto expected = fmt::format("expected a whole number from 0 to {}", largest);
    return Error{fmt::format("{}:{}: PGM: {} is '{}', {}", file_.string(), line, what, printable(word_), expected)};
  }

  const fs::path& file_;
  std::string_view content_;
  std::size_t position_ = 2;
  std::string_view word_;
  std::uint32_t maximum_ = 255;
  GreyImage image_;
};

using PngContext = std::unique_ptr<spng_ctx, decltype(&spng_ctx_free)>;

Error png_fault(const fs::path& file, std::string_view what) {
  return Error{fmt::format("{}: PNG: {}", file.string(), what)};
}

Error png_fault(const fs::path& file, int code) {
  if (code == SPNG_IO_EOF) return png_fault(file, "truncated: the file ends before the image does");
  return png_fault(file, spng_strerror(code));
}

/// Turns one row of RGBA into grey, and into alpha where the image has it.
void take_row(const std::uint8_t* rgba, std::size_t row, GreyImage& image) {
  const auto width = static_cast<std::size_t>(image.width);
  for (std::size_t column = 0; column < width; ++column) {
    const std::uint8_t* pixel = rgba + 4 * column;
    const std::uint32_t sum = std::uint32_t{pixel[0]} + pixel[1] + pixel[2];
    image.pixels[row * width + column] = static_cast<std::uint8_t>((sum + 1) / 3);
    if (!image.alpha.empty()) image.alpha[row * width + column] = pixel[3];
  }
}

Result<GreyImage> read_png(const fs::path& file, std::string_view content) {
  const PngContext png(spng_ctx_new(0), &spng_ctx_free);
  // Texts and colour profiles are of no use here, and a small file can unpack to much of them.
  spng_set_chunk_limits(png.get(), std::size_t{1} << 26, std::size_t{1} << 26);
  spng_set_png_buffer(png.get(), content.data(), content.size());
  spng_ihdr header{};
  if (const int code = spng_get_ihdr(png.get(), &header)) return png_fault(file, code);
  if (const auto wrong = size_fault(header.width, header.height)) return png_fault(file, *wrong);
  // Deflate shrinks to no less than 1/1032, so a short file with a large header is broken, and is found out before memory is taken.
  std::size_t unpacked = 0;
  spng_decoded_image_size(png.get(), SPNG_FMT_PNG, &unpacked);
  if (unpacked / 1032 > content.size()) {
    return png_fault(file, fmt::format("truncated: {} bytes cannot hold {} x {} pixels", content.size(), header.width, header.height));
  }

  spng_trns keyed{};
  const int keyed_code = spng_get_trns(png.get(), &keyed);
  if (keyed_code != SPNG_OK && keyed_code != SPNG_ECHUNKAVAIL) return png_fault(file, keyed_code);
  const bool has_alpha =
      keyed_code == SPNG_OK || header.color_type == SPNG_COLOR_TYPE_GRAYSCALE_ALPHA || header.color_type == SPNG_COLOR_TYPE_TRUECOLOR_ALPHA;

  GreyImage image{static_cast<int>(header.width), static_cast<int>(header.height), {}, {}};
  image.pixels.resize(pixel_count(image));
  if (has_alpha) image.alpha.resize(pixel_count(image));

  // Row by row, since the whole in colour takes four times the memory; an interlaced image comes in passes that need all rows at once.
  const std::size_t row_bytes = std::size_t{header.width} * 4;
  const bool interlaced = header.interlace_method != SPNG_INTERLACE_NONE;
  std::vector<std::uint8_t> rows(interlaced ? row_bytes * header.height : row_bytes);
  int code = spng_decode_image(png.get(), nullptr, 0, SPNG_FMT_RGBA8, SPNG_DECODE_TRNS | SPNG_DECODE_PROGRESSIVE);
  while (code == SPNG_OK) {
    spng_row_info info{};
    if ((code = spng_get_row_info(png.get(), &info)) != SPNG_OK) break;
    std::uint8_t* const row = rows.data() + (interlaced ? info.row_num * row_bytes : 0);
    code = spng_decode_row(png.get(), row, row_bytes);
    if (code == SPNG_OK || code == SPNG_EOI) take_row(row, info.row_num, image);
  }
  if (code == SPNG_EOI) code = spng_decode_chunks(png.get());
  if (code != SPNG_OK) return png_fault(file, code);
  return image;
}

/// Why an image that a caller made cannot be written, or nothing.
std::optional<Error> unwritable(const fs::path& file, const GreyImage& image) {
  if (const auto wrong = size_fault(image.width, image.height)) return Error{file.string() + ": " + *wrong};
  const std::size_t count = pixel_count(image);
  if (image.pixels.size() != count || (!image.alpha.empty() && image.alpha.size() != count)) {
    return Error{fmt::format("{}: {} pixels and {} values of alpha, expected {} x {} of each (or no alpha)", file.string(),
                             image.pixels.size(), image.alpha.size(), image.width, image.height)};
  }
  return std::nullopt;
}

}  // namespace

Result<GreyImage> read_image(const fs::path& file) {
  const Result<std::string> content = read_text_file(file);
  if (!content) return content.error();
  const std::string_view bytes = *content;
  if (bytes.starts_with(png_signature)) return read_png(file, bytes);
  const bool is_pgm = bytes.size() > 2 && (bytes.starts_with("P5") || bytes.starts_with("P2")) && (is_space(bytes[2]) || bytes[2] == '#');
  if (is_pgm) return PgmReader(file, bytes).read();
  if (bytes.empty()) return Error{file.string() + ": is empty, expected PGM (P5 or P2) or PNG"};
  return Error{fmt::format("{}: begins with '{}', expected PGM (P5 or P2) or PNG", file.string(), printable(bytes.substr(0, 8)))};
}

Result<Done> write_pgm(const fs::path& file, const GreyImage& image) {
  if (auto wrong = unwritable(file, image)) return *wrong;
  std::string content = fmt::format("P5\n{} {}\n255\n", image.width, image.height);
  content.append(image.pixels.begin(), image.pixels.end());
  return write_file(file, content);
}

Result<Done> write_png(const fs::path& file, const GreyImage& image) {
  if (auto wrong = unwritable(file, image)) return *wrong;
  std::vector<std::uint8_t> samples = image.pixels;
  if (!image.alpha.empty()) {
    samples.resize(2 * image.pixels.size());
    for (std::size_t i = 0; i < image.pixels.size(); ++i) {
      samples[2 * i] = image.pixels[i];
      samples[2 * i + 1] = image.alpha[i];
    }
  }
  const PngContext png(spng_ctx_new(SPNG_CTX_ENCODER), &spng_ctx_free);
  spng_set_option(png.get(), SPNG_ENCODE_TO_BUFFER, 1);
  spng_ihdr header{};
  header.width = static_cast<std::uint32_t>(image.width);
  header.height = static_cast<std::uint32_t>(image.height);
  header.bit_depth = 8;
  header.color_type = image.alpha.empty() ? SPNG_COLOR_TYPE_GRAYSCALE : SPNG_COLOR_TYPE_GRAYSCALE_ALPHA;
  spng_set_ihdr(png.get(), &header);
  if (const int code = spng_encode_image(png.get(), samples.data(), samples.size(), SPNG_FMT_PNG, SPNG_ENCODE_FINALIZE)) {
    return png_fault(file, code);
  }
  std::size_t size = 0;
  int code = SPNG_OK;
  const std::unique_ptr<void, decltype(&std::free)> encoded(spng_get_png_buffer(png.get(), &size, &code), &std::free);
  if (!encoded) return png_fault(file, code);
  return write_file(file, {static_cast<const char*>(encoded.get()), size});
}

}  // namespace thicket
