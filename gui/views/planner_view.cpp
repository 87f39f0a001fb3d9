#include "../view.hpp"

namespace thicket::gui {
namespace {

class PlannerView final : public View {
 public:
  const char* name() const override { return "Planner"; }
  void draw(const Frame& frame) override;
};

void PlannerView::draw(const Frame& frame) {
  if (!frame.now.simulation) return ImGui::TextUnformatted("Nothing is open.");
  ImGui::Text("%.2f s", frame.now.simulation->time());
}

}  // namespace

std::unique_ptr<View> make_planner_view() { return std::make_unique<PlannerView>(); }

}  // namespace thicket::gui
