#include "../view.hpp"

namespace thicket::gui {
namespace {

class MissionView final : public View {
 public:
  const char* name() const override { return "Mission"; }
  void draw(const Frame& frame) override;
};

void MissionView::draw(const Frame& frame) {
  if (!frame.now.simulation) return ImGui::TextUnformatted("Nothing is open.");
  ImGui::Text("%.2f s", frame.now.simulation->time());
}

}  // namespace

std::unique_ptr<View> make_mission_view() { return std::make_unique<MissionView>(); }

}  // namespace thicket::gui
