// The image of synthetic aperture as it grows.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "axes.hpp"
#include "thicket/sim/sar.hpp"
#include "waterfall.hpp"

namespace thicket::gui {
namespace {

/// Pixels of the picture along either edge; a larger image is shown by the brightest of several.
constexpr int most_across = 1024;

class SarView final : public View {
 public:
  const char* name() const override { return "SAR"; }
  void draw(const Frame& frame) override;

 private:
  void take(const Frame& frame, const SarImage& image);
  void draw_image(const Frame& frame, const SarImage& image);
  void draw_bar(const Frame& frame, const Chart& chart, double floor_db) const;
  void read_out(const Frame& frame, const SarImage& image, const Chart& chart) const;

  SarGrid grid_;
  double brightest_ = 0.0;
  std::shared_ptr<const Simulation> of_;
  std::uint64_t scans_ = 0, run_ = 0, world_ = 0;
  int width_ = 0, height_ = 0;  ///< of the texture
  std::vector<std::uint32_t> pixels_;
};

double relative_db(float amplitude, double brightest) { return amplitude > 0.0f && brightest > 0.0 ? decibels(static_cast<double>(amplitude) / brightest) : -240.0; }

/// A new image only where there is one: it costs the more, the larger it is.
void SarView::take(const Frame& frame, const SarImage& image) {
  const Snapshot& now = frame.now;
  bool fresh = false;
  if (width_ > 0) frame.textures.get("sar", width_, height_, fresh);
  const bool same = of_ && scans_ == image.scans() && run_ == now.run_revision && world_ == now.world_revision;
  if (same && !fresh) return;
  of_ = now.simulation;
  scans_ = image.scans();
  run_ = now.run_revision;
  world_ = now.world_revision;
  grid_ = image.grid();
  brightest_ = static_cast<double>(grid_.brightest());
  if (grid_.amplitude.empty()) return;
  const int step = 1 + (std::max(grid_.width, grid_.height) - 1) / most_across;
  width_ = (grid_.width + step - 1) / step;
  height_ = (grid_.height + step - 1) / step;
  std::vector<float> most(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_), 0.0f);
  for (int row = 0; row < grid_.height; ++row) {
    for (int column = 0; column < grid_.width; ++column) {
      float& there = most[static_cast<std::size_t>(height_ - 1 - row / step) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(column / step)];
      there = std::max(there, grid_.amplitude[grid_.index(column, row)]);
    }
  }
  pixels_.resize(most.size());
  const double floor_db = image.spec().floor_db;
  std::transform(most.begin(), most.end(), pixels_.begin(), [&](float a) { return heat(1.0 - relative_db(a, brightest_) / floor_db); });
  frame.textures.get("sar", width_, height_, fresh);
  frame.textures.update("sar", 0, 0, width_, height_, pixels_.data());
}

void SarView::draw(const Frame& frame) {
  if (!frame.now.simulation) return ImGui::TextUnformatted("Nothing is open.");
  const SarImage* image = frame.now.simulation->sar();
  if (!image) {
    ImGui::TextWrapped("This mission makes no image of synthetic aperture: set sar.enabled = true (in Mission, or --set sar.enabled=true).");
    if (!sar_sensor(frame.now.simulation->mission())) ImGui::TextWrapped("It takes a lobe radar with echoes = \"receiver\", such as the preset x4m05; with signal = \"iq\" for back-projection.");
    return;
  }
  take(frame, *image);
  if (grid_.amplitude.empty()) return ImGui::TextUnformatted("No scan has come into the image yet.");
  ImGui::Text("%s of %llu scans, %d x %d pixels of %g m, 0 dB is %.4g", image->method() == "back_projection" ? "back-projection" : "simple sum", static_cast<unsigned long long>(image->scans()), grid_.width, grid_.height,
              grid_.resolution, brightest_);
  draw_image(frame, *image);
}

void SarView::draw_image(const Frame& frame, const SarImage& image) {
  // Metres are as long up as across: the axes show more than the image where the view is wider or higher.
  const ImVec2 room = ImGui::GetContentRegionAvail();
  const double wide = grid_.width * grid_.resolution, high = grid_.height * grid_.resolution, shape = std::clamp(static_cast<double>((room.x - 120.0f) / std::max(40.0f, room.y - 60.0f)), 0.1, 10.0);
  const glm::dvec2 middle = grid_.origin + 0.5 * glm::dvec2(wide, high);
  const double half_x = 0.52 * std::max(wide, high * shape), half_y = 0.52 * std::max(high, wide / shape);
  const bool line = image.spec().frame == "line";
  const Chart chart = begin_chart(frame, "sar", {room.x - 70.0f, room.y}, {middle.x - half_x, middle.x + half_x}, {middle.y - half_y, middle.y + half_y}, line ? "along the line (m)" : "x (m)",
                                  line ? "away from the line (m)" : "y (m)");
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  bool fresh = false;
  if (const ImTextureID texture = frame.textures.get("sar", width_, height_, fresh))
    draw.AddImage(texture, {chart.to_x(grid_.origin.x), chart.to_y(grid_.origin.y + high)}, {chart.to_x(grid_.origin.x + wide), chart.to_y(grid_.origin.y)});
  std::vector<ImVec2> points;
  for (const glm::dvec2& p : image.track()) points.push_back({chart.to_x(p.x), chart.to_y(p.y)});
  draw.AddPolyline(points.data(), static_cast<int>(points.size()), frame.colours.robot, ImDrawFlags_None, 1.5f);
  read_out(frame, image, chart);
  end_chart();
  draw_bar(frame, chart, image.spec().floor_db);
}

void SarView::draw_bar(const Frame& frame, const Chart& chart, double floor_db) const {
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  const float left = chart.high.x + 10.0f, right = left + 12.0f, length = chart.high.y - chart.low.y;
  constexpr int parts = 64;
  for (int i = 0; i < parts; ++i) {
    const float from = chart.high.y - length * static_cast<float>(i) / parts, to = chart.high.y - length * static_cast<float>(i + 1) / parts;
    draw.AddRectFilled({left, to}, {right, from}, heat((i + 0.5) / parts));
  }
  const Ticks ticks = nice_ticks(floor_db, 0.0, 6);
  for (const double db : ticks.at) {
    const float y = chart.high.y - length * static_cast<float>(1.0 - db / floor_db);
    draw.AddText({right + 4.0f, y - 0.5f * ImGui::GetTextLineHeight()}, frame.colours.grid_text, (tick_text(db, ticks.step) + (db == 0.0 ? " dB" : "")).c_str());
  }
}

void SarView::read_out(const Frame& frame, const SarImage& image, const Chart& chart) const {
  if (!chart.hovered || frame.still) return;
  const ImVec2 mouse = ImGui::GetIO().MousePos;
  const glm::dvec2 at(chart.x_at(mouse.x), chart.y_at(mouse.y)), pixel = glm::floor((at - grid_.origin) / grid_.resolution);
  std::string words = fmt::format("{:.3f}, {:.3f} m", at.x, at.y);
  if (pixel.x >= 0.0 && pixel.y >= 0.0 && pixel.x < grid_.width && pixel.y < grid_.height) {
    const std::size_t i = grid_.index(static_cast<int>(pixel.x), static_cast<int>(pixel.y));
    words += grid_.looks[i] > 0.0f ? fmt::format(": {:.1f} dB ({:.4g}), {:.0f} looks over {:.0f} deg", relative_db(grid_.amplitude[i], brightest_), grid_.amplitude[i], grid_.looks[i], degrees(static_cast<double>(grid_.aperture[i])))
                                   : std::string(": not seen");
  }
  if (image.spec().frame == "line") {
    const glm::dvec2 world = image.to_world(at);
    words += fmt::format("; in the world {:.3f}, {:.3f} m", world.x, world.y);
  }
  label(frame, {chart.low.x + 6.0f, chart.high.y - 1.5f * ImGui::GetTextLineHeight()}, words, frame.colours.text);
}

}  // namespace

std::unique_ptr<View> make_sar_view() { return std::make_unique<SarView>(); }

}  // namespace thicket::gui
