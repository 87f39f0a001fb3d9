// `thicket generate`: models that Thicket makes itself, as OBJ files.
#include <fmt/format.h>

#include <cstdio>

#include "program.hpp"
#include "thicket/base/files.hpp"
#include "thicket/base/text.hpp"

namespace thicket::cli {
namespace {

namespace fs = std::filesystem;

int list_models() {
  for (const std::string& name : model_names()) fmt::print("{:14}  {}\n", name, make_model(name)->description);
  fmt::print("\nthicket generate NAME --out FILE.obj writes one; [[solid]] type = \"mesh\" of a world takes it\n");
  return done;
}

}  // namespace

int generate_model(const GenerateArguments& a) {
  if (a.name.empty()) return list_models();
  if (a.out.empty()) return complain({"--out is missing, expected the OBJ file to write, for example --out hold.obj"});
  const fs::path out = a.out;
  if (out.extension() != ".obj") return complain({fmt::format("'{}': expected a name that ends in .obj", a.out)});
  auto model = make_model(a.name);
  if (!model) return complain({fmt::format("there is no model '{}', expected {}{}", a.name, fmt::join(model_names(), ", "), did_you_mean(a.name, model_names()))});
  if (a.name == "hold") {
    if (const auto fault = hold_fault(a.hold)) return complain({*fault});
    model = make_hold(a.hold);
  } else if (a.hold_changed) {
    return complain({fmt::format("sizes are given, but the model is '{}', expected them only for the hold", a.name)});
  }
  const fs::path mtl = fs::path(out).replace_extension(".mtl");
  std::size_t triangles = 0;
  for (const ModelPart& part : model->parts) triangles += part.mesh->triangles.size();
  if (const auto written = write_file(out, model_obj(*model, mtl.filename().string())); !written) return complain(written.error());
  if (const auto written = write_file(mtl, model_mtl(*model)); !written) return complain(written.error());
  fmt::print("model      {}\ntriangles  {}\nwritten    {}\nwritten    {}\n", model->description, triangles, out.string(), mtl.string());
  return done;
}

}  // namespace thicket::cli
