// NumPy's .npy (NEP 1, "A simple file format for NumPy arrays", R. Kern 2007): six magic bytes, version, length of the header, a Python dictionary, the numbers.
#include <fmt/format.h>

#include <charconv>

#include "map_header.hpp"
#include "printable.hpp"
#include "probability_parts.hpp"
#include "thicket/base/files.hpp"
#include "thicket/base/image.hpp"

namespace thicket {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view magic = "\x93NUMPY";

class NpyReader {
 public:
  NpyReader(const fs::path& file, std::string_view content) : file_(file), rest_(content) {}

  Result<ProbabilityGrid> read(double cell_size, const glm::dvec2& origin) {
    if (!rest_.starts_with(magic)) return fault(fmt::format("begins with '{}', expected a file that numpy.save wrote", printable(rest_.substr(0, 6))));
    if (rest_.size() < 10) return fault("truncated: the file ends before its header");
    const int version = static_cast<std::uint8_t>(rest_[6]);
    if (version < 1 || version > 3) return fault(fmt::format("the format is {}.{}, expected 1.0, 2.0 or 3.0", version, static_cast<std::uint8_t>(rest_[7])));
    const std::size_t at = version == 1 ? 10 : 12;
    const std::size_t length = version == 1 ? little<std::uint16_t>(rest_.substr(8)) : rest_.size() < at ? rest_.size() : little<std::uint32_t>(rest_.substr(8));
    if (length > rest_.size() || rest_.size() - length < at) return fault("truncated: the file ends before its header does");
    header_ = rest_.substr(at, length);
    rest_.remove_prefix(at + length);

    const std::string_view type = word_after("'descr':");
    if (type != "'<f4'" && type != "'<f8'") return fault(fmt::format("the type of the numbers is {}, expected '<f4': numpy.save(file, array.astype('<f4'))", printable(type)));
    if (word_after("'fortran_order':") != "False") return fault("the array is in Fortran's order, expected C's: numpy.save(file, numpy.ascontiguousarray(array))");
    ProbabilityGrid grid{0, 0, cell_size, origin, {}, {}};
    if (!take_shape(grid)) return fault(fmt::format("the shape is {}, expected (height, width), 2 numbers from 1 on whose product is at most {}", printable(shape()), max_image_pixels));
    const std::size_t count = static_cast<std::size_t>(grid.width) * static_cast<std::size_t>(grid.height), each = type == "'<f4'" ? 4 : 8;
    if (rest_.size() != count * each) return fault(fmt::format("{} bytes of numbers after the header, expected {} x {} x {}{}", rest_.size(), grid.height, grid.width, each, rest_.size() < count * each ? ": the file is truncated" : ""));
    grid.probability.resize(count);
    for (std::size_t i = 0; i < count; ++i) {
      const double p = each == 4 ? static_cast<double>(std::bit_cast<float>(little<std::uint32_t>(rest_.substr(i * 4, 4)))) : std::bit_cast<double>(little<std::uint64_t>(rest_.substr(i * 8, 8)));
      if (!std::isnan(p) && !(p >= 0.0 && p <= 1.0)) {
        const auto width = static_cast<std::size_t>(grid.width);
        return fault(fmt::format("the number [{}, {}] is {}, expected a probability, 0 to 1, or NaN for unknown", i / width, i % width, p));
      }
      grid.probability[i] = std::isnan(p) ? ProbabilityGrid::unknown : inside(p);
    }
    if (const auto wrong = unwritable(MapFrame{grid.width, grid.height, count, cell_size, origin, 0.0})) return fault(*wrong);
    return grid;
  }

 private:
  Error fault(std::string_view what) const { return Error{fmt::format("{}: NPY: {}", file_.string(), what)}; }

  std::string_view after(std::string_view key) const {
    const auto found = header_.find(key);
    if (found == std::string_view::npos) return {};
    const std::string_view rest = header_.substr(found + key.size());
    return rest.substr(std::min(rest.find_first_not_of(' '), rest.size()));
  }
  /// Up to a comma or the end: of a record of several types that is not one of those that are known.
  std::string_view word_after(std::string_view key) const {
    const std::string_view rest = after(key);
    return rest.substr(0, rest.find_first_of(",} "));
  }
  std::string_view shape() const {
    const std::string_view rest = after("'shape':");
    return rest.substr(0, std::min(rest.find(')'), rest.size() - 1) + 1);
  }

  bool take_shape(ProbabilityGrid& grid) const {
    std::string_view text = shape();
    if (!text.starts_with('(') || !text.ends_with(')')) return false;
    text = text.substr(1, text.size() - 2);
    for (int* edge : {&grid.height, &grid.width}) {
      const auto [stop, failure] = std::from_chars(text.data(), text.data() + text.size(), *edge);
      if (failure != std::errc{} || *edge < 1) return false;
      text.remove_prefix(static_cast<std::size_t>(stop - text.data()));
      if (edge == &grid.height && !text.starts_with(',')) return false;
      text.remove_prefix(std::min(text.find_first_not_of(", "), text.size()));
    }
    return text.empty() && grid.width <= max_image_pixels / grid.height;
  }

  const fs::path& file_;
  std::string_view rest_, header_;
};

}  // namespace

Result<Done> write_npy(const fs::path& file, const ProbabilityGrid& grid) {
  if (auto wrong = unwritable(file, grid)) return *wrong;
  std::string header = fmt::format("{{'descr': '<f4', 'fortran_order': False, 'shape': ({}, {}), }}", grid.height, grid.width);
  // The numbers begin at a multiple of 64 bytes, and a line ends before them.
  header.resize((magic.size() + 4 + header.size() + 1 + 63) / 64 * 64 - magic.size() - 4 - 1, ' ');
  header += '\n';
  std::string content(magic);
  content += std::string("\x01\x00", 2);
  append_little(content, static_cast<std::uint16_t>(header.size()));
  content += header;
  content.reserve(content.size() + 4 * grid.probability.size());
  // One bit pattern for all that is unknown, so that the same map gives the same bytes.
  for (const float p : grid.probability) append_little(content, std::bit_cast<std::uint32_t>(std::isnan(p) ? ProbabilityGrid::unknown : p));
  return write_file(file, content);
}

Result<ProbabilityGrid> read_npy(const fs::path& file, double cell_size, const glm::dvec2& origin) {
  const Result<std::string> content = read_text_file(file);
  if (!content) return content.error();
  return NpyReader(file, *content).read(cell_size, origin);
}

}  // namespace thicket
