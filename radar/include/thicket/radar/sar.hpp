// Images of synthetic aperture: what one lobe saw along its way, laid together. docs/sar.md explains both methods.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "thicket/base/pose.hpp"
#include "thicket/base/schema.hpp"
#include "thicket/scan/scan.hpp"

namespace thicket {

/// The keys of [sar].
struct SarSpec {
  bool enabled = false;
  std::string sensor;             ///< a lobe radar with a receiver; empty: the first one
  std::string method = "auto";    ///< "simple_sum" | "back_projection" | "auto": back-projection if the sensor has I and Q, else the simple sum
  std::string frame = "world";    ///< "world": x east, y north | "line": y as the lobe looks at its first scan, x to the right of that, the sensor then at 0, 0
  std::optional<glm::dvec4> bounds_m;  ///< x_min, y_min, x_max, y_max in that frame; without them whatever comes into the lobe
  double resolution_m = 0.02;     ///< edge of a pixel
  std::optional<double> height_m; ///< of the plane of the image, in the world; without it that of the sensor at its first scan
  double spacing_m = 0.002;       ///< a scan counts if the sensor has moved (or its axis has swung, at the end of its range) at least as far since the last that did
  std::string window = "none";    ///< "none" | "hann": over the lobe's opening, of back-projection
  double floor_db = -40.0;        ///< of the picture and of the list of peaks, against the brightest pixel
  bool fuse = false;
  double fuse_threshold_db = -20.0;
  double fuse_radius_m = 1.5;
  double fuse_aperture_deg = 20.0;
};
const Section& sar_section();

/// An image as plain data. Pixel (column, row) is at [row * width + column]; row 0 is at the bottom; it covers [column, column + 1] x [row, row + 1] times the resolution from `origin`.
struct SarGrid {
  int width = 0, height = 0;
  double resolution = 0.02;     ///< m
  glm::dvec2 origin{0.0, 0.0};  ///< of the lower-left corner, m, in the image's frame
  std::vector<float> amplitude; ///< of the sum; 0 where no scan had a say
  std::vector<float> looks;     ///< scans that had a say, by their weights
  std::vector<float> aperture;  ///< rad: the angle over which the pixel was seen, as if that had been done evenly
  std::vector<float> bearing;   ///< rad, in the image's frame: the mean direction in which it was seen

  std::size_t index(int column, int row) const { return static_cast<std::size_t>(row) * static_cast<std::size_t>(width) + static_cast<std::size_t>(column); }
  glm::dvec2 centre(int column, int row) const { return origin + resolution * glm::dvec2(column + 0.5, row + 0.5); }
  float brightest() const;
};

/// A bright point of an image.
struct SarPeak {
  glm::dvec2 position{0.0, 0.0};  ///< m, in the image's frame
  double db = 0.0;                ///< against the brightest pixel
  double range_width = 0.0, azimuth_width = 0.0;  ///< m, at -3 dB, along the mean direction in which it was seen and across; NaN where the image ends before
};
/// Points brighter than all within `distance` m, from the brightest down to `floor_db`, at most `most`.
std::vector<SarPeak> sar_peaks(const SarGrid& grid, double floor_db, double distance = 0.1, std::size_t most = 50);

/// m: azimuth width at -3 dB of a point that is seen over an angle, 0.886 lambda / (4 sin(angle / 2)).
double sar_azimuth_width(double frequency_ghz, double angle);

/// The image while it grows: a value. Copies share their tiles until one of both writes. The same scans give the same bytes for any number of threads.
class SarImage {
 public:
  /// `method` is "simple_sum" or "back_projection"; `frequency_ghz` the carrier of the scans' I and Q.
  SarImage(const SarSpec& spec, const std::string& method, double frequency_ghz);

  /// Adds a scan that was made from this pose of the sensor itself, in the world. Back-projection passes over scans without I and Q, both over scans without profiles.
  void add(const Scan& scan, const Pose& sensor);

  const std::string& method() const { return method_; }
  double frequency_ghz() const { return frequency_ghz_; }
  const SarSpec& spec() const { return spec_; }
  std::uint64_t scans() const { return scans_; }  ///< that counted
  double height() const { return height_; }       ///< m, of the image's plane in the world
  const std::vector<glm::dvec2>& track() const { return track_; }  ///< where the sensor was, in the image's frame, a pixel apart or more
  glm::dvec2 to_world(const glm::dvec2& point) const { return frame_.to_outer(point); }
  glm::dvec2 from_world(const glm::dvec2& point) const { return frame_.to_inner(point); }
  std::size_t memory_bytes() const;
  std::uint64_t pixels_added() const { return pixels_added_; }  ///< pixels x scans so far

  /// The image over `bounds_m`, else over all that a scan had a say in (as far as its last pixel); empty before the first scan.
  SarGrid grid() const;

 private:
  struct Tile;
  struct View;
  using Place = std::pair<std::int64_t, std::int64_t>;  ///< row and column of a tile

  bool counts(const Scan& scan, const Pose& sensor);
  View view_of(const Scan& scan, const Pose& sensor) const;
  std::vector<std::pair<Place, Tile*>> tiles_for(const View& view);

  SarSpec spec_;
  std::string method_;
  double frequency_ghz_;
  Pose2 frame_;           ///< the image's in the world
  double height_ = 0.0;
  std::uint64_t scans_ = 0, pixels_added_ = 0;
  Pose last_;             ///< of the sensor at the last scan that counted
  double line_width_ = 0.0;  ///< m, half of what a line of the simple sum covers
  std::vector<glm::dvec2> track_;
  std::map<Place, std::shared_ptr<Tile>> tiles_;
};

}  // namespace thicket
