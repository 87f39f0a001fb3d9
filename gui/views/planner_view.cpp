#include <fmt/format.h>

#include <cmath>

#include <glm/geometric.hpp>

#include "../view.hpp"

namespace thicket::gui {
namespace {

class PlannerView final : public View {
 public:
  const char* name() const override { return "Planner"; }
  void draw(const Frame& frame) override;
};

ImVec4 colour_of(ImU32 colour) { return ImGui::ColorConvertU32ToFloat4(colour | IM_COL32_A_MASK); }

void row(const char* what, const std::string& value) {
  ImGui::TableNextRow();
  ImGui::TableNextColumn();
  ImGui::TextUnformatted(what);
  ImGui::TableNextColumn();
  ImGui::TextWrapped("%s", value.c_str());
}

const char* to_words(Outcome outcome) {
  switch (outcome) {
    case Outcome::running: return "under way";
    case Outcome::reached: return "reached";
    case Outcome::unreachable: return "unreachable";
    case Outcome::stuck: return "stuck";
  }
  return "";
}

std::string pose_text(const Pose2& pose) { return fmt::format("({:.3f}, {:.3f}) m, {:.1f} deg", pose.position.x, pose.position.y, degrees(pose.yaw)); }

std::string metres(double distance) { return std::isfinite(distance) ? fmt::format("{:.2f}", distance) : std::string("none"); }

void draw_state(const Frame& frame, const Simulation& s) {
  const Decision& decision = s.decision();
  const std::string state = decision.state.empty() ? "It has not decided anything yet." : decision.state;
  ImGui::PushStyleColor(ImGuiCol_Text, colour_of(frame.colours.dark ? frame.colours.robot : frame.colours.start));
  ImGui::TextWrapped("%s", state.c_str());
  ImGui::PopStyleColor();
  if (!decision.reason.empty()) ImGui::TextWrapped("%s: %s", to_words(decision.outcome), decision.reason.c_str());
  if (const auto& verdict = s.verdict()) {
    const bool good = verdict->kind == Verdict::Kind::reached;
    ImGui::PushStyleColor(ImGuiCol_Text, colour_of(good ? frame.colours.goal : frame.colours.warning));
    ImGui::TextWrapped("Verdict: %s. %s", to_string(verdict->kind), verdict->reason.c_str());
    if (verdict->true_distance_to_goal_m) ImGui::Text("True distance to the goal: %.3f m", *verdict->true_distance_to_goal_m);
    ImGui::PopStyleColor();
  }
  bool by_hand = s.driven_by_hand();
  if (frame.still) return;
  if (ImGui::RadioButton("automatic", !by_hand) && by_hand) frame.post(Drive{});
  ImGui::SameLine();
  if (ImGui::RadioButton("by hand", by_hand) && !by_hand) frame.post(Drive{Command{}});
}

void draw_senses(const Simulation& s) {
  const Mission& mission = s.mission();
  if (!ImGui::BeginTable("senses", 2, ImGuiTableFlags_SizingFixedFit | ImGuiTableFlags_RowBg)) return;
  ImGui::TableSetupColumn("what", 0, 11.0f * ImGui::GetFontSize());
  ImGui::TableSetupColumn("value", ImGuiTableColumnFlags_WidthStretch);
  row("planner", mission.planner.name);
  row("mode", s.driven_by_hand() ? "driven by hand" : to_words(s.decision().outcome));
  row("time, steps", fmt::format("{:.2f} s, {}", s.time(), s.steps()));
  row("pose", pose_text(s.vehicle().pose));
  row("pose as believed", fmt::format("{} (off by {:.3f} m)", pose_text(s.estimate()), glm::distance(s.estimate().position, s.vehicle().pose.position)));
  row("speed", fmt::format("{:.3f} m/s, {:.1f} deg/s", s.vehicle().speed, degrees(s.vehicle().turn_rate)));
  const Command& command = s.decision().command;
  row("the planner wants", fmt::format("{:.3f} m/s, {:.1f} deg/s", command.speed, degrees(command.turn_rate)));
  if (const auto& goal = mission.planner.goal_m)
    row("goal", fmt::format("({:.2f}, {:.2f}) m, {:.2f} m away; {:.2f} m as believed", goal->x, goal->y, glm::distance(*goal, s.vehicle().pose.position), glm::distance(*goal, s.estimate().position)));
  if (!mission.planner.waypoints_m.empty()) row("way-points", fmt::format("{}", mission.planner.waypoints_m.size()));
  row("clearance", fmt::format("{} m; the least so far {} m; kept {:.2f} m", metres(s.clearance().distance), metres(s.totals().least_clearance), mission.planner.clearance_m));
  row("path", fmt::format("{:.2f} m, {} decisions", s.totals().path_length, s.totals().decisions));
  ImGui::EndTable();
}

void draw_bumpers(const Frame& frame, const Simulation& s) {
  const BumperRing& ring = s.bumpers();
  ImGui::Text("Bumpers: pressed within %.2f m of the hull", ring.press_distance());
  if (!ImGui::BeginTable("bumpers", 5, ImGuiTableFlags_SizingFixedFit | ImGuiTableFlags_RowBg | ImGuiTableFlags_BordersInnerV)) return;
  const float em = ImGui::GetFontSize();
  ImGui::TableSetupColumn("sector (deg)", 0, 6.0f * em);
  ImGui::TableSetupColumn("", 0, 5.0f * em);
  ImGui::TableSetupColumn("distance (m)", 0, 6.5f * em);
  ImGui::TableSetupColumn("nearest at (deg)", 0, 8.0f * em);
  ImGui::TableSetupColumn("unseen (deg)", ImGuiTableColumnFlags_WidthStretch);
  ImGui::TableHeadersRow();
  for (const Bumper& bumper : ring.bumpers()) {
    ImGui::TableNextRow();
    ImGui::TableSetBgColor(ImGuiTableBgTarget_RowBg1, bumper.pressed ? frame.colours.pressed : bumper.unseen > 0.0 ? frame.colours.unseen : frame.colours.released);
    ImGui::TableNextColumn();
    ImGui::Text("%+.0f", degrees(bumper.centre));
    ImGui::TableNextColumn();
    ImGui::TextUnformatted(bumper.pressed ? "pressed" : "released");
    ImGui::TableNextColumn();
    ImGui::TextUnformatted(metres(bumper.distance).c_str());
    ImGui::TableNextColumn();
    if (std::isfinite(bumper.distance)) {
      if (bumper.bearing_high > bumper.bearing_low) ImGui::Text("%+.0f to %+.0f", degrees(bumper.bearing_low), degrees(bumper.bearing_high));
      else ImGui::Text("%+.1f", degrees(bumper.bearing));
    }
    ImGui::TableNextColumn();
    ImGui::TextUnformatted(bumper.unseen > 0.0 ? fmt::format("{:.1f}", degrees(bumper.unseen)).c_str() : "-");
  }
  ImGui::EndTable();
}

void draw_marks(const Simulation& s) {
  const std::vector<Mark> marks = s.marks();
  ImGui::Text("Marks: %zu", marks.size());
  if (marks.empty() || !ImGui::BeginTable("marks", 2, ImGuiTableFlags_SizingFixedFit | ImGuiTableFlags_RowBg)) return;
  ImGui::TableSetupColumn("what", 0, 11.0f * ImGui::GetFontSize());
  ImGui::TableSetupColumn("where", ImGuiTableColumnFlags_WidthStretch);
  // Coverage planners leave thousands: only what is in sight is put into words.
  ImGuiListClipper clipper;
  clipper.Begin(static_cast<int>(marks.size()));
  while (clipper.Step())
    for (int i = clipper.DisplayStart; i < clipper.DisplayEnd; ++i) {
      const Mark& mark = marks[static_cast<std::size_t>(i)];
      ImGui::TableNextRow();
      ImGui::TableNextColumn();
      ImGui::TextUnformatted(mark.label.c_str());
      ImGui::TableNextColumn();
      if (mark.kind == Mark::Kind::point) ImGui::Text("(%.2f, %.2f) m", mark.from.x, mark.from.y);
      else ImGui::Text("(%.2f, %.2f) to (%.2f, %.2f) m", mark.from.x, mark.from.y, mark.to.x, mark.to.y);
    }
  ImGui::EndTable();
}

void PlannerView::draw(const Frame& frame) {
  if (!frame.now.simulation) return ImGui::TextUnformatted("Nothing is open.");
  const Simulation& s = *frame.now.simulation;
  draw_state(frame, s);
  ImGui::Separator();
  draw_senses(s);
  ImGui::Separator();
  draw_bumpers(frame, s);
  ImGui::Separator();
  draw_marks(s);
}

}  // namespace

std::unique_ptr<View> make_planner_view() { return std::make_unique<PlannerView>(); }

}  // namespace thicket::gui
