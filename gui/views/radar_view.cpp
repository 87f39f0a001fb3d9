#include "../view.hpp"

namespace thicket::gui {
namespace {

class RadarView final : public View {
 public:
  const char* name() const override { return "Radar"; }
  void draw(const Frame& frame) override;
};

void RadarView::draw(const Frame& frame) {
  if (!frame.now.simulation) return ImGui::TextUnformatted("Nothing is open.");
  ImGui::Text("%.2f s", frame.now.simulation->time());
}

}  // namespace

std::unique_ptr<View> make_radar_view() { return std::make_unique<RadarView>(); }

}  // namespace thicket::gui
