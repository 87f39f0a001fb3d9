// A map's probabilities as a picture for people.
#pragma once

#include <filesystem>
#include <string>

#include "thicket/base/probability_grid.hpp"
#include "thicket/base/result.hpp"

namespace thicket {

/// Draws a map as a PNG: a ramp from white (free) to black (occupied), blue where nothing is known, tinted green where it was sensed through; with a title, a legend and a scale bar. Of a map with more than about 2200 cells along an
/// edge, every so-manieth is drawn. The same grid gives the same bytes. An empty grid is an error.
Result<Done> write_probability_picture(const std::filesystem::path& file, const ProbabilityGrid& grid, const std::string& title);

}  // namespace thicket
