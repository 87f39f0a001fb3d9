// Tables of poses for many instances of one solid. Private to the room.
#pragma once

#include <filesystem>
#include <vector>

#include <glm/vec3.hpp>

#include "thicket/base/result.hpp"

namespace thicket {

struct TablePose {
  glm::dvec3 position{0.0};
  double yaw = 0.0, pitch = 0.0, roll = 0.0;  ///< rad
  double scale = 1.0;
};

/// Reads a CSV file: the first line names the columns (x_m and y_m; z_m, yaw_deg, pitch_deg, roll_deg and scale where they are wanted, in any order), each other line
/// is a pose. Empty lines and lines that begin with # are passed over. Errors: up to 20 faults as `file:line:column: what, expected`; more than a million poses.
Result<std::vector<TablePose>> read_pose_table(const std::filesystem::path& file);

}  // namespace thicket
