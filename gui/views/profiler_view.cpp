#include "../view.hpp"

namespace thicket::gui {
namespace {

class ProfilerView final : public View {
 public:
  const char* name() const override { return "Profiler"; }
  void draw(const Frame& frame) override;
};

void ProfilerView::draw(const Frame& frame) {
  if (!frame.now.simulation) return ImGui::TextUnformatted("Nothing is open.");
  ImGui::Text("%.2f s", frame.now.simulation->time());
}

}  // namespace

std::unique_ptr<View> make_profiler_view() { return std::make_unique<ProfilerView>(); }

}  // namespace thicket::gui
