// Textures on the graphics card, and the few other calls to OpenGL that the platforms share.
#pragma once

#include <map>
#include <string>

#include "picture.hpp"
#include "view.hpp"

namespace thicket::gui {

/// Needs the context in which it was made to be current, to its end.
class GlTextures final : public Textures {
 public:
  ~GlTextures() override;
  ImTextureID get(const std::string& name, int width, int height, bool& fresh) override;
  void update(const std::string& name, int x, int y, int width, int height, const std::uint32_t* pixels) override;

 private:
  struct Texture {
    unsigned id = 0;
    int width = 0, height = 0;
  };
  std::map<std::string, Texture> textures_;
};

void clear(int width, int height, ImU32 colour);
/// Of the framebuffer that is bound.
Picture read_pixels(int width, int height);
/// The number of errors since the last call.
unsigned count_faults();

}  // namespace thicket::gui
