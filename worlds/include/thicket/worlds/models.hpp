// Models that Thicket makes itself, as OBJ files: the hold of a river barge, and the things of a cluttered room. `thicket generate` writes them.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "thicket/worlds/mesh.hpp"

namespace thicket {

/// What of a model is of one material: closed meshes, which may overlap.
struct ModelPart {
  std::string name;      ///< "left front wheel"
  std::string material;  ///< as in `usemtl`
  std::shared_ptr<const Mesh> mesh;  ///< closed, facing outward
};

/// A model in its own frame: metres, z up, x forward, standing on z = 0 with its middle over the origin.
struct Model {
  std::string name;         ///< "car"
  std::string description;  ///< a sentence: what it is, and how large
  std::vector<ModelPart> parts;
};

/// The hold of a river barge: tank top, side walls and end bulkheads of plate, web frames with flanges on the sides, longitudinal stiffeners between them, upright ones on the bulkheads, a strip of deck
/// outside. Metres, > 0; the sizes are ours (the source took a CAD model of a ship that it does not describe). Frames, flanges and stiffeners stand inward of the given length and breadth.
struct HoldSpec {
  double length = 30.0, breadth = 10.0, depth = 4.0;  ///< inside, between the plates; `depth` from the tank top up to the open deck
  double plate = 0.010;                               ///< thickness of all plates
  double frame_spacing = 2.5, frame_depth = 0.30, flange_width = 0.15;
  double stiffener_spacing = 0.65, stiffener_depth = 0.12;
  double deck_width = 0.6;                            ///< outside of the hold
};

/// What is wrong with a spec, with the sentence that tells what was expected: a size that is not finite or not > 0, frames that meet in the middle or that are closer than their flanges are wide, more than 10^4
/// frames or stiffeners. Nothing if all is well.
std::optional<std::string> hold_fault(const HoldSpec& spec);

/// The hold, its tank top's upper face on z = 0. `spec` has no fault.
Model make_hold(const HoldSpec& spec);

/// Names of the models, in order: hold, car, control_panel, dumpster, human, postbox, robot, stop_sign.
const std::vector<std::string>& model_names();
/// One of them, the hold with the default spec; nothing if there is none of this name. Everything is ours: forms and sizes as such things have in the street, materials by name.
std::optional<Model> make_model(const std::string& name);

/// An OBJ file, with the vertices to a tenth of a millimetre; `read_obj` makes a volume of each material. `library` is the name of the MTL file beside it.
std::string model_obj(const Model& model, const std::string& library);
/// The MTL file: colours for other programs, the dissolve of glass.
std::string model_mtl(const Model& model);

}  // namespace thicket
