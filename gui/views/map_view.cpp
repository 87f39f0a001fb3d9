#include <fmt/format.h>

#include <chrono>

#include "plan.hpp"

namespace thicket::gui {
namespace {

class MapView final : public View {
 public:
  const char* name() const override { return "Map"; }
  void draw(const Frame& frame) override;
  std::span<const ViewKey> own_keys() const override {
    static constexpr ViewKey list[] = {
        {"F", "fit"},
        {"T", "follow the robot"},
        {"N", "north up, or the robot's heading"},
        {"L", "legend of 2012, or probabilities"},
        {"C", "score against the truth"},
        {"0", "robot and trail"}};
    return list;
  }

 private:
  void toolbar();
  void draw_legend(const Frame& frame, ImDrawList& draw) const;
  void draw_readout(const Frame& frame, ImDrawList& draw) const;
  void judge(const Frame& frame);
  void draw_score(const Frame& frame, ImDrawList& draw) const;

  using Clock = std::chrono::steady_clock;
  struct Judged {
    std::string words;
    double time = 0.0;
  };

  PlanControls controls_;
  MapPicture map_{"map", MapPicture::unknown_colour};
  bool probability_ = false, score_ = false, over_ = true;
  Beside<Judged> judging_;
  Judged judged_;
  std::shared_ptr<const Simulation> judged_of_;
  Clock::time_point judged_at_{};
};

void box_with_words(const Frame& frame, ImVec2 low, const std::string& words, ImDrawList& draw) {
  const ImVec2 size = ImGui::CalcTextSize(words.c_str());
  draw.AddRectFilled({low.x - 6.0f, low.y - 4.0f}, {low.x + size.x + 6.0f, low.y + size.y + 4.0f}, with_alpha(frame.colours.background, 0.85), 3.0f);
  draw.AddText(low, frame.colours.text, words.c_str());
}

void MapView::toolbar() {
  if (ImGui::SmallButton(probability_ ? "probability (L)" : "legend (L)")) probability_ = !probability_;
  beside_if_room("score (C)", true);
  ImGui::Checkbox("score (C)", &score_);
  beside_if_room("robot and way (0)", true);
  ImGui::Checkbox("robot and way (0)", &over_);
  controls_.buttons();
}

void MapView::draw_legend(const Frame& frame, ImDrawList& draw) const {
  struct Entry {
    ImU32 colour;
    const char* words;
  };
  constexpr Entry legend[] = {{IM_COL32(0x2f, 0x4b, 0x8f, 255), "never sensed"}, {IM_COL32(255, 255, 255, 255), "sensed"}, {IM_COL32(0xc9, 0xcc, 0xd1, 255), "clear, surely"}, {IM_COL32(0x93, 0xb4, 0x8c, 255), "sensed through"}, {IM_COL32(0x11, 0x11, 0x11, 255), "obstacle"}};
  constexpr Entry ramp[] = {{IM_COL32(0x2f, 0x4b, 0x8f, 255), "never sensed"}, {IM_COL32(255, 255, 255, 255), "0"}, {IM_COL32(191, 191, 191, 255), "0.25"}, {IM_COL32(127, 127, 127, 255), "0.5"}, {IM_COL32(64, 64, 64, 255), "0.75"}, {IM_COL32(0, 0, 0, 255), "1 matter"}, {IM_COL32(0x76, 0xa3, 0x6c, 255), "greenish: sensed through"}};
  const float line = ImGui::GetFontSize();
  const auto each = [&](auto use) {
    if (probability_) for (const Entry& e : ramp) use(e);
    else for (const Entry& e : legend) use(e);
  };
  const ImVec2 from{controls_.camera.low.x + 10.0f, controls_.camera.low.y + 8.0f};
  const float most = controls_.camera.size.x - 20.0f;
  // Once to see how many lines they take, and once to draw them.
  float widest = 0.0f;
  ImVec2 at = from;
  const auto place = [&](const Entry& e) {
    const float width = line + 5.0f + ImGui::CalcTextSize(e.words).x;
    if (at.x > from.x && at.x + width > from.x + most) at = {from.x, at.y + line + 5.0f};
    const ImVec2 there = at;
    widest = std::max(widest, at.x + width - from.x);
    at.x += width + 13.0f;
    return there;
  };
  each(place);
  draw.AddRectFilled({from.x - 5.0f, from.y - 4.0f}, {from.x + widest + 7.0f, at.y + line + 4.0f}, with_alpha(frame.colours.background, 0.85), 3.0f);
  at = from;
  each([&](const Entry& e) {
    const ImVec2 there = place(e), end{there.x + line, there.y + line};
    draw.AddRectFilled(there, end, e.colour);
    draw.AddRect(there, end, frame.colours.faint);
    draw.AddText({end.x + 5.0f, there.y}, frame.colours.text, e.words);
  });
}

void MapView::draw_readout(const Frame& frame, ImDrawList& draw) const {
  if (!controls_.hovered()) return;
  const std::string words = describe_cell(*frame.now.simulation, controls_.camera.to_world(ImGui::GetIO().MousePos));
  box_with_words(frame, {controls_.camera.low.x + 48.0f, controls_.camera.low.y + controls_.camera.size.y - 3.0f * ImGui::GetFontSize()}, words, draw);
}

/// Beside the drawing: large maps take a second.
void MapView::judge(const Frame& frame) {
  const bool waits = frame.still;
  if (!judging_.busy() && judged_of_ != frame.now.simulation && Clock::now() - judged_at_ > std::chrono::seconds(1)) {
    judged_of_ = frame.now.simulation;
    judged_at_ = Clock::now();
    // A copy: this thread goes on to read the map.
    judging_.start([run = std::make_shared<const Simulation>(*frame.now.simulation)] {
      const auto score = score_run(*run);
      return Judged{score ? score_text(*score) : score.error().message, run->time()};
    });
  }
  judging_.poll(waits, judged_);
}

void MapView::draw_score(const Frame& frame, ImDrawList& draw) const {
  std::string words = judged_.words.empty() ? std::string("judging ...") : fmt::format("against the truth, at {:.1f} s\n{}", judged_.time, judged_.words);
  while (!words.empty() && words.back() == '\n') words.pop_back();
  box_with_words(frame, {controls_.camera.low.x + 12.0f, controls_.camera.low.y + 4.2f * ImGui::GetFontSize()}, words, draw);
}

void MapView::draw(const Frame& frame) {
  if (!frame.now.simulation) return ImGui::TextUnformatted("Nothing is open.");
  if (!frame.still) toolbar();
  controls_.begin(frame, "map");
  controls_.pan(frame, true);
  if (controls_.hovered()) {
    if (key_pressed('L')) probability_ = !probability_;
    if (key_pressed('C')) score_ = !score_;
    if (key_pressed('0')) over_ = !over_;
  }
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  const PlanCamera& camera = controls_.camera;
  const ImVec2 high{camera.low.x + camera.size.x, camera.low.y + camera.size.y};
  draw.PushClipRect(camera.low, high, true);
  map_.draw(frame, camera, probability_, 1.0, draw);
  // The map's ground is dark blue, whatever the window's is.
  static const Palette on_blue = palette(true);
  const Frame over{frame.now, on_blue, frame.textures, frame.desk, frame.post, frame.scale, frame.still};
  controls_.draw_grid(over, draw);
  if (over_) {
    draw_trail(over, camera, draw);
    draw_marks(over, camera, draw);
    draw_places(over, camera, draw);
    draw_robot(over, camera, draw);
  }
  draw_legend(frame, draw);
  if (score_) {
    judge(frame);
    draw_score(frame, draw);
  }
  if (!frame.now.simulation->mission().map.enabled) box_with_words(frame, {camera.low.x + 12.0f, camera.low.y + 0.5f * camera.size.y}, "This mission makes no map: set map.enabled = true.", draw);
  controls_.draw_scale_bar(over, draw);
  draw_readout(frame, draw);
  draw.PopClipRect();
}

}  // namespace

std::unique_ptr<View> make_map_view() { return std::make_unique<MapView>(); }

}  // namespace thicket::gui
