// The tool of the world view that edits: it selects, drags and draws solids.
#pragma once

#include <memory>
#include <string>

#include "../core/editor.hpp"
#include "../view.hpp"

namespace thicket::gui {

enum class Drawing { nothing, box, sphere, cylinder, wall, prism };

/// What the tool and the edit view share.
struct Editing {
  Editor editor;
  Drawing drawing = Drawing::nothing;  ///< what a click in the plan begins; nothing: it selects
  int escape_frame = -1;               ///< in which the tool used the key Escape for itself
  int keys_frame = -1;                 ///< in which the keys were looked at
};

std::unique_ptr<PlanTool> make_edit_tool(std::shared_ptr<Editing> editing);

/// Ctrl+Z and Ctrl+Y, Del and Ctrl+D, once a frame whoever asks; what was changed is posted.
void use_edit_keys(const Frame& frame, Editing& editing);
/// Posts what was changed, and keeps the selection among the solids that there are.
void post_edits(const Frame& frame, Editing& editing);

}  // namespace thicket::gui
