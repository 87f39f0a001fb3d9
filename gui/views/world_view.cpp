#include "../view.hpp"

namespace thicket::gui {
namespace {

class WorldView final : public View {
 public:
  const char* name() const override { return "World"; }
  void draw(const Frame& frame) override;
};

void WorldView::draw(const Frame& frame) {
  if (!frame.now.simulation) return ImGui::TextUnformatted("Nothing is open.");
  ImGui::Text("%.2f s", frame.now.simulation->time());
}

}  // namespace

std::unique_ptr<View> make_world_view() { return std::make_unique<WorldView>(); }

}  // namespace thicket::gui
