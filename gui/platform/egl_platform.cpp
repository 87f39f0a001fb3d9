// Pictures without a screen: EGL without a surface, into a framebuffer object.
#define GL_GLEXT_PROTOTYPES
#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <GL/gl.h>
#include <GL/glext.h>
#include <backends/imgui_impl_opengl3.h>
#include <fmt/format.h>

#include <optional>

#include "gl_textures.hpp"
#include "platform.hpp"

namespace thicket::gui {
namespace {

class Offscreen final : public Platform {
 public:
  Offscreen(const Size& size, double scale) : size_(size), scale_(scale) {}
  ~Offscreen() override {
    if (ImGui::GetCurrentContext()) {
      ImGui_ImplOpenGL3_Shutdown();
      ImGui::DestroyContext();
    }
    textures_.reset();
    if (context_ == EGL_NO_CONTEXT) return;
    glDeleteFramebuffers(1, &framebuffer_);
    glDeleteRenderbuffers(1, &colours_);
    eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    eglDestroyContext(display_, context_);
    // (The display stays: terminating it would take it from others in this process.)
  }

  std::optional<Error> open() {
    if (auto fault = make_current()) return fault;
    glGenRenderbuffers(1, &colours_);
    glBindRenderbuffer(GL_RENDERBUFFER, colours_);
    glRenderbufferStorage(GL_RENDERBUFFER, GL_RGBA8, size_.width, size_.height);
    glGenFramebuffers(1, &framebuffer_);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, colours_);
    if (glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE) return Error{fmt::format("OpenGL makes no picture of {} x {} pixels", size_.width, size_.height)};
    make_context(scale_);
    if (!ImGui_ImplOpenGL3_Init("#version 330 core")) {
      ImGui::DestroyContext();
      return Error{"OpenGL's functions cannot be loaded (libGL.so.1; on Debian: apt-get install libgl1)"};
    }
    textures_.emplace();
    return std::nullopt;
  }

  bool poll(double) override { return false; }
  bool closing() const override { return false; }
  void begin() override {
    ImGuiIO& io = ImGui::GetIO();
    io.DisplaySize = {static_cast<float>(size_.width), static_cast<float>(size_.height)};
    io.DeltaTime = 1.0f / 60.0f;
    ImGui_ImplOpenGL3_NewFrame();
    ImGui::NewFrame();
  }
  void draw(ImU32 background) override {
    ImGui::Render();
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
    clear(size_.width, size_.height, background);
    ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
  }
  void show() override {}
  Picture pixels() override { return read_pixels(size_.width, size_.height); }
  Textures& textures() override { return *textures_; }
  double scale() const override { return scale_; }
  unsigned faults() override { return count_faults(); }

 private:
  std::optional<Error> make_current() {
    const auto get_display = reinterpret_cast<PFNEGLGETPLATFORMDISPLAYEXTPROC>(eglGetProcAddress("eglGetPlatformDisplayEXT"));
    if (get_display) display_ = get_display(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
    if (display_ == EGL_NO_DISPLAY) display_ = eglGetDisplay(EGL_DEFAULT_DISPLAY);
    const char* what_to_do = "; on Debian: apt-get install libegl1 libgl1 libgl1-mesa-dri";
    if (display_ == EGL_NO_DISPLAY || !eglInitialize(display_, nullptr, nullptr)) return Error{fmt::format("no picture can be drawn: EGL does not start (error {:#x}){}", eglGetError(), what_to_do)};
    eglBindAPI(EGL_OPENGL_API);
    const EGLint wanted[] = {EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_SURFACE_TYPE, EGL_PBUFFER_BIT, EGL_NONE};
    EGLConfig config = nullptr;
    EGLint count = 0;
    eglChooseConfig(display_, wanted, &config, 1, &count);
    const EGLint version[] = {EGL_CONTEXT_MAJOR_VERSION, 3, EGL_CONTEXT_MINOR_VERSION, 3, EGL_CONTEXT_OPENGL_PROFILE_MASK, EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT, EGL_NONE};
    context_ = eglCreateContext(display_, count > 0 ? config : nullptr, EGL_NO_CONTEXT, version);
    if (context_ == EGL_NO_CONTEXT || !eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_))
      return Error{fmt::format("no picture can be drawn: EGL has no OpenGL 3.3 without a screen (error {:#x}){}", eglGetError(), what_to_do)};
    return std::nullopt;
  }

  Size size_;
  double scale_;
  EGLDisplay display_ = EGL_NO_DISPLAY;
  EGLContext context_ = EGL_NO_CONTEXT;
  unsigned framebuffer_ = 0, colours_ = 0;
  std::optional<GlTextures> textures_;
};

}  // namespace

Result<std::unique_ptr<Platform>> open_offscreen(const Size& size, double scale) {
  auto platform = std::make_unique<Offscreen>(size, scale);
  if (auto fault = platform->open()) return *fault;
  return std::unique_ptr<Platform>(std::move(platform));
}

}  // namespace thicket::gui
