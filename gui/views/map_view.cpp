#include "../view.hpp"

namespace thicket::gui {
namespace {

class MapView final : public View {
 public:
  const char* name() const override { return "Map"; }
  void draw(const Frame& frame) override;
};

void MapView::draw(const Frame& frame) {
  if (!frame.now.simulation) return ImGui::TextUnformatted("Nothing is open.");
  ImGui::Text("%.2f s", frame.now.simulation->time());
}

}  // namespace

std::unique_ptr<View> make_map_view() { return std::make_unique<MapView>(); }

}  // namespace thicket::gui
