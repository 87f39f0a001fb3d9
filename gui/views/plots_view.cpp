#include "../view.hpp"

namespace thicket::gui {
namespace {

class PlotsView final : public View {
 public:
  const char* name() const override { return "Plots"; }
  void draw(const Frame& frame) override;
};

void PlotsView::draw(const Frame& frame) {
  if (!frame.now.simulation) return ImGui::TextUnformatted("Nothing is open.");
  ImGui::Text("%.2f s", frame.now.simulation->time());
}

}  // namespace

std::unique_ptr<View> make_plots_view() { return std::make_unique<PlotsView>(); }

}  // namespace thicket::gui
