#include "map_header.hpp"

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <set>
#include <string_view>

#include "printable.hpp"
#include "thicket/base/files.hpp"
#include "thicket/base/map_file.hpp"
#include "thicket/base/text.hpp"

namespace thicket {
namespace {

namespace fs = std::filesystem;

const std::vector<std::string> known_keys = {"image", "mode", "resolution", "origin", "negate", "occupied_thresh", "free_thresh"};
const std::vector<std::string> known_modes = {"trinary", "scale", "raw"};

std::string listed(const std::vector<std::string>& words) {
  std::string list;
  for (const std::string& word : words) list += (list.empty() ? "" : ", ") + word;
  return list;
}

/// `file:line:column`; yaml-cpp counts from 0, and has -1 for what stands nowhere.
std::string place(const fs::path& file, const YAML::Mark& mark) {
  return mark.line < 0 ? file.string() : fmt::format("{}:{}:{}", file.string(), mark.line + 1, mark.column + 1);
}

std::string shown(const YAML::Node& value) {
  if (value.IsScalar()) return fmt::format("'{}'", printable(value.Scalar()));
  if (value.IsSequence()) return "a list";
  return value.IsMap() ? "a map" : "empty";
}

/// Not yaml-cpp's own conversion, which takes infinity, NaN and hexadecimal numbers.
std::optional<double> finite_number(const YAML::Node& value) {
  if (!value.IsScalar()) return std::nullopt;
  std::string_view text = value.Scalar();
  if (text.starts_with('+') && !text.starts_with("+-")) text.remove_prefix(1);
  double number = 0.0;
  const auto [stop, failure] = std::from_chars(text.data(), text.data() + text.size(), number);
  const bool whole = failure == std::errc{} && stop == text.data() + text.size();
  return whole && std::isfinite(number) ? std::optional(number) : std::nullopt;
}

/// Checks the YAML key by key. Faults are gathered, one per line, so that a file can be corrected in one go.
class HeaderReader {
 public:
  explicit HeaderReader(const fs::path& file) : file_(file) {}

  Result<MapHeader> read(const YAML::Node& root, bool image_needed) {
    if (!root.IsMap()) {
      fault(root.Mark(), fmt::format("not a map, expected the keys {}", listed(known_keys)));
      return Error{faults_};
    }
    take_keys(root);
    if (image_needed || entries_.contains("image")) take_image();
    take_resolution();
    take_origin();
    take_negate();
    take_mode();
    take_thresholds();
    if (!faults_.empty()) return Error{faults_};
    return header_;
  }

 private:
  struct Entry {
    YAML::Node value;
    YAML::Mark mark;
  };

  void fault(const YAML::Mark& mark, std::string_view what) {
    faults_ += fmt::format("{}{}: {}", faults_.empty() ? "" : "\n", place(file_, mark), what);
  }

  void fault(std::string_view key, const Entry& entry, std::string_view expected) {
    fault(entry.mark, fmt::format("{} is {}, expected {}", key, shown(entry.value), expected));
  }

  void take_keys(const YAML::Node& root) {
    for (const auto& pair : root) {
      const YAML::Mark mark = pair.first.Mark();
      if (!pair.first.IsScalar()) {
        fault(mark, fmt::format("a key is {}, expected a word", shown(pair.first)));
        continue;
      }
      const std::string& key = pair.first.Scalar();
      if (std::find(known_keys.begin(), known_keys.end(), key) == known_keys.end()) {
        const auto meant = nearest_word(key, known_keys);
        if (meant) misspelt_.insert(*meant);
        const std::string expected = meant ? "" : fmt::format(", expected one of {}", listed(known_keys));
        fault(mark, fmt::format("unknown key '{}'{}{}", printable(key), did_you_mean(key, known_keys), expected));
        continue;
      }
      // What is not there stands, for yaml-cpp, where the next thing begins; its key is the better place to point at.
      const bool added = entries_.try_emplace(key, Entry{pair.second, pair.second.IsNull() ? mark : pair.second.Mark()}).second;
      if (!added) fault(mark, fmt::format("key '{}' is there twice, expected once", key));
    }
  }

  /// The entry of a key that must be there, or a fault. A misspelt key has had its fault already.
  const Entry* required(const std::string& key) {
    const auto found = entries_.find(key);
    if (found != entries_.end()) return &found->second;
    if (!misspelt_.contains(key)) fault(YAML::Mark::null_mark(), fmt::format("key '{}' is missing", key));
    return nullptr;
  }

  void take_image() {
    const Entry* entry = required("image");
    if (entry == nullptr) return;
    if (!entry->value.IsScalar() || entry->value.Scalar().empty()) return fault("image", *entry, "the name of a PGM or PNG file");
    header_.image = entry->value.Scalar();
    header_.image_place = place(file_, entry->mark);
  }

  void take_resolution() {
    const Entry* entry = required("resolution");
    if (entry == nullptr) return;
    const auto number = finite_number(entry->value);
    if (!number || *number <= 0.0) return fault("resolution", *entry, "metres a cell, a finite number greater than 0");
    if (*number < least_cell_m || *number > largest_cell_m) return fault("resolution", *entry, fmt::format("metres a cell, from {} to {}", least_cell_m, largest_cell_m));
    header_.resolution = *number;
  }

  void take_origin() {
    const Entry* entry = required("origin");
    if (entry == nullptr) return;
    header_.origin_place = place(file_, entry->mark);
    if (!entry->value.IsSequence()) return fault("origin", *entry, "[x, y, yaw] in metres and radians");
    if (entry->value.size() != 3) {
      return fault(entry->mark, fmt::format("origin has {} values, expected 3: [x, y, yaw] in metres and radians", entry->value.size()));
    }
    for (std::size_t i = 0; i < 3; ++i) {
      const YAML::Node part = entry->value[i];
      const auto number = finite_number(part);
      if (!number) fault(fmt::format("origin's {}", i == 0 ? "x" : i == 1 ? "y" : "yaw"), Entry{part, part.Mark()}, "a finite number");
      if (number && i < 2 && std::abs(*number) > farthest_origin_m)
        fault(fmt::format("origin's {}", i == 0 ? "x" : "y"), Entry{part, part.Mark()}, fmt::format("metres, from {} to {}", -farthest_origin_m, farthest_origin_m));
      header_.origin[i] = number.value_or(0.0);
    }
  }

  void take_negate() {
    const Entry* entry = required("negate");
    if (entry == nullptr) return;
    const std::string text = entry->value.IsScalar() ? entry->value.Scalar() : "";
    if (text == "1") {
      header_.negate = true;
    } else if (text != "0" && !YAML::convert<bool>::decode(entry->value, header_.negate)) {
      fault("negate", *entry, "0, 1, true or false");
    }
  }

  void take_mode() {
    const auto found = entries_.find("mode");
    if (found == entries_.end()) return;
    const Entry& entry = found->second;
    header_.mode = entry.value.IsScalar() ? entry.value.Scalar() : "";
    if (std::find(known_modes.begin(), known_modes.end(), header_.mode) != known_modes.end()) return;
    fault("mode", entry, fmt::format("{}{}", listed(known_modes), did_you_mean(header_.mode, known_modes)));
  }

  bool take_threshold(const std::string& key, double& threshold) {
    const Entry* entry = required(key);
    if (entry == nullptr) return false;
    const auto number = finite_number(entry->value);
    if (number && *number >= 0.0 && *number <= 1.0) {
      threshold = *number;
      return true;
    }
    fault(key, *entry, "a number from 0 to 1");
    return false;
  }

  void take_thresholds() {
    const bool occupied = take_threshold("occupied_thresh", header_.occupied_thresh);
    const bool free = take_threshold("free_thresh", header_.free_thresh);
    if (!occupied || !free || header_.free_thresh <= header_.occupied_thresh) return;
    fault("free_thresh", entries_.at("free_thresh"), fmt::format("at most occupied_thresh, {}", header_.occupied_thresh));
  }

  const fs::path& file_;
  std::map<std::string, Entry> entries_;
  std::set<std::string> misspelt_;
  std::string faults_;
  MapHeader header_;
};

/// The image that the header names, or an error that helps when it is not there.
Result<fs::path> named_image(const fs::path& yaml, const MapHeader& header) {
  const fs::path image = yaml.parent_path() / header.image;
  std::error_code none;
  if (fs::exists(image, none)) return image;
  const std::string missing = fmt::format("{}: image '{}' does not exist", header.image_place, header.image);
  for (const char* extension : {".pgm", ".png"}) {
    const fs::path beside = fs::path(yaml).replace_extension(extension);
    if (!fs::exists(beside, none)) continue;
    return Error{fmt::format("{}; '{}' is beside it: correct the line, or add --map-image {}", missing, beside.filename().string(),
                             beside.string())};
  }
  return Error{missing + ", expected a PGM or PNG file, relative to the YAML file"};
}

}  // namespace

Result<MapHeader> read_map_header(const fs::path& yaml, bool image_needed) {
  const Result<std::string> text = read_text_file(yaml);
  if (!text) return text.error();
  try {
    return HeaderReader(yaml).read(YAML::Load(*text), image_needed);
  } catch (const YAML::Exception& broken) {
    return Error{fmt::format("{}: {}, expected the YAML of a map", place(yaml, broken.mark), broken.msg)};
  } catch (const std::exception& broken) {
    return Error{fmt::format("{}: {}", yaml.string(), broken.what())};
  }
}

Result<GreyImage> read_map_image(const fs::path& yaml, const MapHeader& header, const fs::path& image_override) {
  const Result<fs::path> file = image_override.empty() ? named_image(yaml, header) : image_override;
  if (!file) return file.error();
  return read_image(*file);
}

std::optional<std::string> unwritable(const MapFrame& map) {
  if (map.width < 1 || map.height < 1) return fmt::format("the map is {} x {} cells, expected at least 1 x 1", map.width, map.height);
  const auto count = static_cast<std::size_t>(map.width) * static_cast<std::size_t>(map.height);
  if (map.cells != count) return fmt::format("the map has {} cells, expected {} x {}", map.cells, map.width, map.height);
  if (!std::isfinite(map.resolution) || map.resolution <= 0.0) {
    return fmt::format("the resolution is {}, expected a finite number greater than 0", map.resolution);
  }
  if (map.resolution < least_cell_m || map.resolution > largest_cell_m)
    return fmt::format("the resolution is {} m, expected {} to {}", map.resolution, least_cell_m, largest_cell_m);
  if (!std::isfinite(map.origin.x) || !std::isfinite(map.origin.y) || !std::isfinite(map.yaw)) {
    return fmt::format("the origin is [{}, {}, {}], expected finite numbers", map.origin.x, map.origin.y, map.yaw);
  }
  if (std::max(std::abs(map.origin.x), std::abs(map.origin.y)) > farthest_origin_m)
    return fmt::format("the origin is [{}, {}, {}], expected metres from {} to {}", map.origin.x, map.origin.y, map.yaw, -farthest_origin_m, farthest_origin_m);
  return std::nullopt;
}

Result<Done> write_map_header(const fs::path& stem, const fs::path& image, std::string_view mode, const MapFrame& map) {
  YAML::Emitter name;
  name << image.filename().string();
  // `#` keeps a decimal point in 1e-07, which other readers of YAML take for a word without it.
  return write_file(
      fs::path(stem) += ".yaml",
      fmt::format("image: {}\nmode: {}\nresolution: {:#}\norigin: [{:#}, {:#}, {:#}]\nnegate: 0\n"
                  "occupied_thresh: {}\nfree_thresh: {}\n",
                  name.c_str(), mode, map.resolution, map.origin.x, map.origin.y, map.yaw, saved_occupied_thresh, saved_free_thresh));
}

}  // namespace thicket
