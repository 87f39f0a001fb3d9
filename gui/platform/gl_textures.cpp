#include "gl_textures.hpp"

#define GL_GLEXT_PROTOTYPES
#include <GL/gl.h>
#include <GL/glext.h>

#include <algorithm>

namespace thicket::gui {
namespace {

/// Binds a texture for a while, and what was bound before after it.
class Bound {
 public:
  explicit Bound(unsigned id) {
    glGetIntegerv(GL_TEXTURE_BINDING_2D, &before_);
    glBindTexture(GL_TEXTURE_2D, id);
  }
  Bound(const Bound&) = delete;
  Bound& operator=(const Bound&) = delete;
  ~Bound() { glBindTexture(GL_TEXTURE_2D, static_cast<unsigned>(before_)); }

 private:
  int before_ = 0;
};

}  // namespace

GlTextures::~GlTextures() {
  for (const auto& [name, texture] : textures_) glDeleteTextures(1, &texture.id);
}

ImTextureID GlTextures::get(const std::string& name, int width, int height, bool& fresh) {
  width = std::max(width, 1);
  height = std::max(height, 1);
  Texture& texture = textures_[name];
  fresh = texture.id == 0 || texture.width != width || texture.height != height;
  if (fresh) {
    if (texture.id == 0) glGenTextures(1, &texture.id);
    texture.width = width;
    texture.height = height;
    const Bound bound(texture.id);
    // Cells stay cells when they are seen from near.
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, width, height, 0, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
  }
  return reinterpret_cast<ImTextureID>(static_cast<std::uintptr_t>(texture.id));
}

void GlTextures::update(const std::string& name, int x, int y, int width, int height, const std::uint32_t* pixels) {
  const auto found = textures_.find(name);
  if (found == textures_.end() || width <= 0 || height <= 0) return;
  const Bound bound(found->second.id);
  glPixelStorei(GL_UNPACK_ROW_LENGTH, 0);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
  glTexSubImage2D(GL_TEXTURE_2D, 0, x, y, width, height, GL_RGBA, GL_UNSIGNED_BYTE, pixels);
}

void clear(int width, int height, ImU32 colour) {
  const ImVec4 c = ImGui::ColorConvertU32ToFloat4(colour);
  glViewport(0, 0, width, height);
  glClearColor(c.x, c.y, c.z, 1.0f);
  glClear(GL_COLOR_BUFFER_BIT);
}

Picture read_pixels(int width, int height) {
  Picture upside_down{width, height, std::vector<std::uint8_t>(3 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height))};
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glReadPixels(0, 0, width, height, GL_RGB, GL_UNSIGNED_BYTE, upside_down.rgb.data());
  const std::ptrdiff_t row = 3 * width;
  for (int top = 0, bottom = height - 1; top < bottom; ++top, --bottom)
    std::swap_ranges(upside_down.rgb.begin() + top * row, upside_down.rgb.begin() + (top + 1) * row, upside_down.rgb.begin() + bottom * row);
  return upside_down;
}

unsigned count_faults() {
  unsigned count = 0;
  // (Without a context some drivers report errors for ever.)
  while (glGetError() != GL_NO_ERROR && count < 1000) ++count;
  return count;
}

}  // namespace thicket::gui
