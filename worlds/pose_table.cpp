#include "pose_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <string_view>

#include "thicket/base/document.hpp"
#include "thicket/base/files.hpp"
#include "thicket/base/pose.hpp"
#include "thicket/base/text.hpp"
#include "world_keys.hpp"

namespace thicket {
namespace {

const std::vector<std::string> columns = {"x_m", "y_m", "z_m", "yaw_deg", "pitch_deg", "roll_deg", "scale"};
constexpr std::size_t most_faults = 20;

struct Field {
  std::string_view text;
  int column = 0;  ///< where it begins, from 1
};

std::vector<Field> fields_of(std::string_view line) {
  std::vector<Field> fields;
  std::size_t begin = 0;
  for (;;) {
    const std::size_t comma = std::min(line.find(',', begin), line.size());
    std::size_t first = begin, last = comma;
    while (first < last && (line[first] == ' ' || line[first] == '\t')) ++first;
    while (last > first && (line[last - 1] == ' ' || line[last - 1] == '\t' || line[last - 1] == '\r')) --last;
    fields.push_back({line.substr(first, last - first), static_cast<int>(first) + 1});
    if (comma == line.size()) return fields;
    begin = comma + 1;
  }
}

class TableReader {
 public:
  explicit TableReader(const std::filesystem::path& file) : file_(file) {}

  Result<std::vector<TablePose>> read(std::string_view text) {
    int number = 0;
    if (text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);  // spreadsheets write it
    while (!text.empty() && faults_ < most_faults) {
      const std::size_t end = std::min(text.find('\n'), text.size());
      const std::string_view line = text.substr(0, end);
      text.remove_prefix(std::min(end + 1, text.size()));
      ++number;
      const auto fields = fields_of(line);
      if ((fields.size() == 1 && fields[0].text.empty()) || line.starts_with('#')) continue;
      if (order_.empty()) read_head(fields, number);
      else read_line(fields, number);
      if (order_.empty()) break;  // without columns no line makes sense
      if (poses_.size() > most_solids) {
        fault(number, 1, fmt::format("more than {} poses, expected at most that", most_solids));
        break;
      }
    }
    if (faults_ == 0 && order_.empty()) fault(1, 1, "the table is empty, expected a line of column names, for example x_m, y_m, yaw_deg");
    if (faults_ == 0 && poses_.empty()) fault(number, 1, "the table has no poses, expected a line for each");
    if (faults_ >= most_faults && !text.empty()) messages_.add({file_.string(), number, 1}, fmt::format("{} faults so far, the rest of the table has not been read", faults_));
    if (faults_ > 0) return messages_.error();
    return std::move(poses_);
  }

 private:
  void fault(int line, int column, const std::string& what) {
    messages_.add({file_.string(), line, column}, what);
    ++faults_;
  }

  void read_head(const std::vector<Field>& fields, int line) {
    std::vector<std::size_t> order;
    for (const Field& field : fields) {
      const std::string name(field.text);
      const auto found = std::find(columns.begin(), columns.end(), name);
      if (found == columns.end()) {
        fault(line, field.column, fmt::format("unknown column '{}', expected some of '{}'{}", name, fmt::join(columns, "', '"), did_you_mean(name, columns)));
        continue;
      }
      const auto index = static_cast<std::size_t>(found - columns.begin());
      if (std::find(order.begin(), order.end(), index) != order.end()) fault(line, field.column, fmt::format("column '{}' is there twice, expected once", name));
      order.push_back(index);
    }
    for (const std::size_t needed : {std::size_t{0}, std::size_t{1}})
      if (faults_ == 0 && std::find(order.begin(), order.end(), needed) == order.end()) fault(line, 1, fmt::format("column '{}' is missing, expected x_m and y_m, and others as they are wanted", columns[needed]));
    if (faults_ == 0) order_ = std::move(order);
  }

  void read_line(const std::vector<Field>& fields, int line) {
    if (fields.size() != order_.size()) return fault(line, 1, fmt::format("{} field{}, expected {}, one for each column that the first line names", fields.size(), fields.size() == 1 ? "" : "s", order_.size()));
    TablePose pose;
    for (std::size_t i = 0; i < fields.size(); ++i) {
      const Field& field = fields[i];
      std::string_view digits = field.text;
      if (digits.starts_with('+')) digits.remove_prefix(1);
      double value = 0.0;
      const auto [stop, failure] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
      const bool is_scale = order_[i] == 6, is_place = order_[i] < 3;
      const bool number = failure == std::errc{} && stop == digits.data() + digits.size() && std::isfinite(value);
      if (!number || (is_scale && !(value >= 1e-6 && value <= 1e6)) || (is_place && std::abs(value) > largest_m) || (!is_scale && !is_place && std::abs(value) > 36000.0)) {
        const char* range = is_scale ? " from 1e-6 to 1e6" : is_place ? " of at most 1e9 m" : " of at most 36000 degrees";
        fault(line, field.column, fmt::format("'{}' is '{}', expected a number{}", columns[order_[i]], field.text, range));
        continue;
      }
      switch (order_[i]) {
        case 0: pose.position.x = value; break;
        case 1: pose.position.y = value; break;
        case 2: pose.position.z = value; break;
        case 3: pose.yaw = radians(value); break;
        case 4: pose.pitch = radians(value); break;
        case 5: pose.roll = radians(value); break;
        default: pose.scale = value;
      }
    }
    poses_.push_back(pose);
  }

  const std::filesystem::path& file_;
  std::vector<std::size_t> order_;  ///< which column each field is
  std::vector<TablePose> poses_;
  Faults messages_;
  std::size_t faults_ = 0;
};

}  // namespace

Result<std::vector<TablePose>> read_pose_table(const std::filesystem::path& file) {
  const auto text = read_text_file(file);
  if (!text) return text.error();
  return TableReader(file).read(*text);
}

}  // namespace thicket
