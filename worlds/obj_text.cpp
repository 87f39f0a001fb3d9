#include "obj_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <sstream>
#include <string_view>
#include <type_traits>
#include <utility>

#include <tiny_obj_loader.h>

#include "base/printable.hpp"
#include "thicket/base/document.hpp"

namespace thicket {
namespace {

constexpr std::size_t max_vertices = 100'000'000, max_triangles = 20'000'000, max_faults = 20;
constexpr std::size_t max_number_length = 64;
constexpr double max_coordinate = 1e12;  // far beyond any world, and the squares still fit Embree's floats

bool is_blank(char c) {
  return c == ' ' || c == '\t';
}

/// One line, or several that were joined, cut at its blanks.
class Words {
 public:
  explicit Words(std::string_view line) : line_(line) { skip(); }

  bool end() const { return at_ == line_.size(); }
  std::size_t offset() const { return at_; }
  std::string_view rest() const {
    std::string_view rest = line_.substr(at_);
    while (!rest.empty() && is_blank(rest.back())) rest.remove_suffix(1);
    return rest;
  }
  std::string_view next() {
    const std::size_t begin = at_;
    while (at_ < line_.size() && !is_blank(line_[at_])) ++at_;
    const std::string_view word = line_.substr(begin, at_ - begin);
    skip();
    return word;
  }

 private:
  void skip() {
    while (at_ < line_.size() && is_blank(line_[at_])) ++at_;
  }
  std::string_view line_;
  std::size_t at_ = 0;
};

/// A text in the form that tinyobjloader takes: every line ends with '\n', joined lines are one, and nothing follows the data of a line.
/// Offsets stay as they were.
class Lines {
 public:
  explicit Lines(std::string text) : text_(std::move(text)) {
    if (text_.starts_with("\xef\xbb\xbf")) std::fill_n(text_.begin(), 3, ' ');
    char first = '\n';  // of the line, blanks apart; '\n' if there is none yet
    bool comment = false;
    for (std::size_t i = 0; i < text_.size(); ++i) {
      char& c = text_[i];
      if (c == '\r') c = i + 1 < text_.size() && text_[i + 1] == '\n' ? ' ' : '\n';
      if (c == '\n') {
        first = '\n';
        comment = false;
        continue;
      }
      // A comment that ends with a backslash (a path, mostly) does not take the next line along.
      if (c == '\\' && !comment) {
        std::size_t end = i + 1;
        if (end + 1 < text_.size() && text_[end] == '\r' && text_[end + 1] == '\n') text_[end++] = ' ';
        if (end == text_.size()) c = ' ';
        if (end < text_.size() && (text_[end] == '\n' || text_[end] == '\r')) {
          c = text_[end] = ' ';
          joined_.push_back(end);
          i = end;
        }
        continue;
      }
      if (first == '\n' && !is_blank(c)) first = c;
      const bool begins = i == 0 || is_blank(text_[i - 1]) || text_[i - 1] == '\n';  // "1.#IND" has no comment
      if (c == '#' && begins && (first == '#' || first == 'v' || first == 'f')) comment = true;
      if (comment && first != '#') c = ' ';
    }
  }

  /// Calls `visit` with each line and its offset.
  template <class Visit>
  void for_each(Visit&& visit) const {
    const std::string_view all = text_;
    for (std::size_t begin = 0; begin < all.size();) {
      const std::size_t end = std::min(all.find('\n', begin), all.size());
      visit(all.substr(begin, end - begin), begin);
      begin = end + 1;
    }
  }

  Place place(const std::string& file, std::size_t offset) const {
    const std::string_view before = std::string_view(text_).substr(0, offset);
    const auto joins_end = std::lower_bound(joined_.begin(), joined_.end(), offset);
    std::size_t line_begin = before.rfind('\n') + 1;  // npos + 1 is 0
    if (joins_end != joined_.begin()) line_begin = std::max(line_begin, *(joins_end - 1) + 1);
    const auto line = std::count(before.begin(), before.end(), '\n') + (joins_end - joined_.begin()) + 1;
    return {file, static_cast<int>(line), static_cast<int>(offset - line_begin) + 1};
  }

  /// Makes a line empty.
  void blank_out(std::size_t offset, std::size_t length) { std::fill_n(text_.begin() + static_cast<std::ptrdiff_t>(offset), length, ' '); }
  std::string take() { return std::move(text_); }

 private:
  std::string text_;
  std::vector<std::size_t> joined_;  // where a line end was
};

/// All of the text as a number, or nothing. from_chars takes everything that tinyobj takes but a leading '+'.
template <class Number>
std::optional<Number> number_of(std::string_view text) {
  if (text.starts_with('+') && !text.starts_with("+-")) text.remove_prefix(1);
  Number number{};
  const auto [end, fault] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (end != text.data() + text.size() || text.empty()) return std::nullopt;
  if (fault == std::errc{}) return number;
  // Too small is 0, too large is nothing.
  if constexpr (std::is_floating_point_v<Number>) {
    const std::size_t exponent = text.find_first_of("eE");
    if (exponent != std::string_view::npos && text[exponent + 1] == '-') return 0.0;
  }
  return std::nullopt;
}

/// tinyobjloader takes what it cannot read for 0, and indices as they come. So everything is looked at before it gets to it.
class Checker {
 public:
  Checker(const Lines& lines, std::string name) : lines_(lines), name_(std::move(name)) {}

  std::optional<Error> check() {
    count();
    if (total_.vertices > max_vertices)
      return Error{fmt::format("{}: has {} vertices, expected at most {}", name_, total_.vertices, max_vertices)};
    if (triangles_ > max_triangles)
      return Error{fmt::format("{}: has faces for {} triangles, expected at most {}", name_, triangles_, max_triangles)};
    vertices_.reserve(total_.vertices);
    lines_.for_each([&](std::string_view line, std::size_t offset) { check_line(line, offset); });
    if (more_ > 0) faults_.take(Error{fmt::format("{}: and {} more", name_, more_)});
    if (!faults_.none()) return faults_.error();
    if (faces_ == 0) return Error{name_ + ": has no faces (lines that begin with 'f'), expected an OBJ file with one or more"};
    return std::nullopt;
  }

  /// Rounded right, where tinyobj's reading of "0.75" is 1.1e-16 off: what is written at the same place in a world file shall be there.
  std::vector<glm::dvec3> take_vertices() { return std::move(vertices_); }
  std::size_t faces() const { return faces_; }
  std::size_t triangles() const { return triangles_; }

 private:
  struct Counts {
    std::size_t vertices = 0, textures = 0, normals = 0;
    bool count(std::string_view word) {
      if (word == "v") return ++vertices, true;
      if (word == "vt") return ++textures, true;
      if (word == "vn") return ++normals, true;
      return false;
    }
  };

  void count() {
    lines_.for_each([&](std::string_view line, std::size_t) {
      Words words(line);
      const std::string_view what = words.next();
      if (total_.count(what) || what != "f") return;
      ++faces_;
      std::size_t corners = 0;
      for (; !words.end(); ++corners) words.next();
      triangles_ += std::max<std::size_t>(corners, 2) - 2;
    });
  }

  void fault(std::size_t offset, std::string_view what) {
    if (told_++ < max_faults) {
      faults_.add(lines_.place(name_, offset), what);
    } else {
      ++more_;
    }
  }

  void check_line(std::string_view line, std::size_t offset) {
    if (const std::size_t zero = line.find('\0'); zero != std::string_view::npos)
      return fault(offset + zero, "holds a zero byte, expected text");
    Words words(line);
    const std::size_t begin = offset + words.offset();
    const std::string_view what = words.next();
    if (what == "f") return check_face(words, offset, begin);
    if (so_far_.count(what) && what == "v") check_vertex(words, offset, begin);
  }

  void check_vertex(Words& words, std::size_t offset, std::size_t begin) {
    int numbers = 0;
    glm::dvec3 vertex(0.0);
    for (; !words.end(); ++numbers) {
      const std::size_t at = offset + words.offset();
      const std::string_view word = words.next();
      const auto number = number_of<double>(word);
      if (!number || !std::isfinite(*number) || word.size() > max_number_length) {
        fault(at, fmt::format("'{}' is not a finite number, expected three of at most {} characters after 'v'", printable(word),
                              max_number_length));
      } else if (numbers < 3 && std::abs(*number) > max_coordinate) {
        fault(at, fmt::format("'{}' is too far away, expected a coordinate within {} of 0", printable(word), max_coordinate));
      } else if (numbers < 3) {
        vertex[numbers] = *number;
      }
    }
    vertices_.push_back(vertex);
    if (numbers < 3) fault(begin, fmt::format("a vertex of {} number{}, expected three", numbers, numbers == 1 ? "" : "s"));
  }

  void check_face(Words& words, std::size_t offset, std::size_t begin) {
    std::size_t corners = 0;
    for (; !words.end(); ++corners) {
      std::size_t at = offset + words.offset();
      std::string_view word = words.next();
      const std::pair<std::size_t, std::size_t> limits[] = {
          {total_.vertices, so_far_.vertices}, {total_.textures, so_far_.textures}, {total_.normals, so_far_.normals}};
      const char* const kinds[] = {"vertex", "texture coordinate", "normal"};
      for (std::size_t part = 0; part < 3; ++part) {
        const std::size_t slash = word.find('/');
        const std::string_view index = word.substr(0, slash);
        // Only the vertex is needed: 1, 1/2, 1//3 and 1/2/3 are corners.
        if (part == 0 || !index.empty()) check_index(index, at, kinds[part], limits[part].first, limits[part].second);
        if (slash == std::string_view::npos) break;
        word.remove_prefix(slash + 1);
        at += slash + 1;
        if (part == 2) fault(at - 1, "a corner has at most three indices, expected vertex/texture/normal");
      }
    }
    if (corners < 3) fault(begin, fmt::format("a face of {} corner{}, expected three or more", corners, corners == 1 ? "" : "s"));
  }

  void check_index(std::string_view word, std::size_t at, const char* kind, std::size_t total, std::size_t so_far) {
    const auto index = number_of<std::int64_t>(word);
    if (!index) return fault(at, fmt::format("'{}' is not an index, expected the whole number of a {}", printable(word), kind));
    if (*index > 0 ? static_cast<std::size_t>(*index) <= total : *index < 0 && *index >= -static_cast<std::int64_t>(so_far)) return;
    std::string expected = total == 0 ? "none: the file has none" : fmt::format("1 to {}", total);
    if (so_far > 0) expected += fmt::format(", or -{} to -1", so_far);
    fault(at, fmt::format("there is no {} {}, expected {}", kind, *index, expected));
  }

  const Lines& lines_;
  std::string name_;
  Faults faults_;
  std::vector<glm::dvec3> vertices_;
  std::size_t told_ = 0, more_ = 0, faces_ = 0, triangles_ = 0;
  Counts total_, so_far_;
};

/// Takes what tinyobjloader reads. (Its callbacks, since its own shapes count a face's corners in one byte.)
struct Collector {
  ObjText text;
  int vertices = 0;  // so far
  std::map<std::string, std::uint32_t, std::less<>> numbers;
  std::string material;
  std::optional<std::uint32_t> number;  // of the material, once a face has used it

  void add_face(const tinyobj::index_t* indices, int count) {
    if (!number) {
      const auto [found, added] = numbers.try_emplace(material, static_cast<std::uint32_t>(text.materials.size()));
      if (added) text.materials.push_back(material);
      number = found->second;
    }
    text.faces.push_back({static_cast<std::uint32_t>(text.corners.size()), static_cast<std::uint32_t>(count), *number});
    for (int i = 0; i < count; ++i) {
      const int index = indices[i].vertex_index;
      text.corners.push_back(static_cast<std::uint32_t>(index > 0 ? index - 1 : vertices + index));
    }
  }
};

/// Where the number of an MTL's `d` or `Tr` line cannot be used, what there is instead.
std::optional<std::string_view> bad_dissolve(std::string_view line) {
  Words words(line);
  const std::string_view what = words.next();
  if (what != "d" && what != "Tr") return std::nullopt;
  const std::string_view word = words.next();
  const auto number = number_of<double>(word);
  if (number && std::isgreaterequal(*number, 0.0) && std::islessequal(*number, 1.0) && word.size() <= max_number_length) return std::nullopt;
  return word;
}

}  // namespace

Result<ObjText> parse_obj(std::string text, const std::string& name) {
  Lines lines(std::move(text));
  Checker checker(lines, name);
  if (auto error = checker.check()) return *error;

  Collector collector;
  collector.text.vertices = checker.take_vertices();
  collector.text.faces.reserve(checker.faces());
  collector.text.corners.reserve(checker.triangles() + 2 * checker.faces());
  lines.for_each([&](std::string_view line, std::size_t) {
    Words words(line);
    const std::string_view what = words.next();
    if (what == "mtllib") collector.text.material_files.emplace_back(words.rest());
    if (what == "l" || what == "p" || what == "curv" || what == "curv2" || what == "surf") ++collector.text.left_out;
  });

  tinyobj::callback_t callbacks;
  callbacks.vertex_cb = [](void* to, double, double, double, double) { ++static_cast<Collector*>(to)->vertices; };
  callbacks.index_cb = [](void* to, tinyobj::index_t* indices, int count) { static_cast<Collector*>(to)->add_face(indices, count); };
  callbacks.usemtl_cb = [](void* to, const char* material, int) {
    static_cast<Collector*>(to)->material = Words(material).rest();
    static_cast<Collector*>(to)->number.reset();
  };
  std::istringstream in(lines.take());
  std::string warnings, faults;
  tinyobj::LoadObjWithCallback(in, callbacks, &collector, nullptr, &warnings, &faults);
  return std::move(collector.text);
}

void parse_mtl(std::string text, const std::string& name, std::map<std::string, double>& dissolve, std::vector<std::string>& notices) {
  std::replace(text.begin(), text.end(), '\0', ' ');
  Lines lines(std::move(text));
  std::vector<std::pair<std::size_t, std::size_t>> bad;
  lines.for_each([&](std::string_view line, std::size_t offset) {
    const auto word = bad_dissolve(line);
    if (!word) return;
    bad.emplace_back(offset, line.size());
    notices.push_back(fmt::format("{}: the dissolve '{}' is left out, expected a number from 0 to 1", to_string(lines.place(name, offset)),
                                  printable(*word)));
  });
  for (const auto& [offset, length] : bad) lines.blank_out(offset, length);

  std::istringstream in(lines.take());
  std::map<std::string, int> numbers;
  std::vector<tinyobj::material_t> materials;
  std::string warnings, faults;
  tinyobj::LoadMtl(&numbers, &materials, &in, &warnings, &faults);
  for (const tinyobj::material_t& material : materials)
    if (!material.name.empty()) dissolve.try_emplace(std::string(Words(material.name).rest()), material.dissolve);
}

}  // namespace thicket
