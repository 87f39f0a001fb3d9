#include "../view.hpp"

namespace thicket::gui {
namespace {

class EditView final : public View {
 public:
  const char* name() const override { return "Edit"; }
  void draw(const Frame& frame) override;
};

void EditView::draw(const Frame& frame) {
  if (!frame.now.simulation) return ImGui::TextUnformatted("Nothing is open.");
  ImGui::Text("%.2f s", frame.now.simulation->time());
}

}  // namespace

std::unique_ptr<View> make_edit_view() { return std::make_unique<EditView>(); }

}  // namespace thicket::gui
