#include "../view.hpp"

namespace thicket::gui {
namespace {

class SpaceView final : public View {
 public:
  const char* name() const override { return "3D"; }
  void draw(const Frame& frame) override;
};

void SpaceView::draw(const Frame& frame) {
  if (!frame.now.simulation) return ImGui::TextUnformatted("Nothing is open.");
  ImGui::Text("%.2f s", frame.now.simulation->time());
}

}  // namespace

std::unique_ptr<View> make_space_view() { return std::make_unique<SpaceView>(); }

}  // namespace thicket::gui
