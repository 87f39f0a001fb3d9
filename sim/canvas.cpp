#include "canvas.hpp"

#include <cairo-svg.h>
#include <cairo.h>
#include <fmt/format.h>

#include "thicket/base/files.hpp"
#include "thicket/base/pose.hpp"

namespace thicket {
namespace {

void set(cairo_t* c, const Colour& colour) { cairo_set_source_rgba(c, colour.red, colour.green, colour.blue, colour.alpha); }

void font(cairo_t* c, double size) {
  cairo_select_font_face(c, "DejaVu Sans", CAIRO_FONT_SLANT_NORMAL, CAIRO_FONT_WEIGHT_NORMAL);
  cairo_set_font_size(c, size);
}

cairo_status_t append(void* to, const unsigned char* data, unsigned length) {
  static_cast<std::string*>(to)->append(reinterpret_cast<const char*>(data), length);
  return CAIRO_STATUS_SUCCESS;
}

}  // namespace

Canvas::Canvas(int width, int height, const Colour& background, Format format)
    : svg_(format == Format::svg ? std::make_shared<std::string>() : nullptr),
      surface_(svg_ ? cairo_svg_surface_create_for_stream(append, svg_.get(), width, height) : cairo_image_surface_create(CAIRO_FORMAT_RGB24, width, height), cairo_surface_destroy),
      context_(cairo_create(surface_.get()), cairo_destroy) {
  set(context_.get(), background);
  cairo_paint(context_.get());
  cairo_set_line_join(context_.get(), CAIRO_LINE_JOIN_ROUND);
}

void Canvas::rectangle(const glm::dvec2& corner, const glm::dvec2& size, const Colour& fill) {
  set(context_.get(), fill);
  cairo_rectangle(context_.get(), corner.x, corner.y, size.x, size.y);
  cairo_fill(context_.get());
}

void Canvas::frame(const glm::dvec2& corner, const glm::dvec2& size, const Colour& line, double width) {
  set(context_.get(), line);
  cairo_set_line_width(context_.get(), width);
  cairo_rectangle(context_.get(), corner.x, corner.y, size.x, size.y);
  cairo_stroke(context_.get());
}

void Canvas::polyline(const std::vector<glm::dvec2>& points, const Colour& line, double width, bool dashed) {
  if (points.size() < 2) return;
  cairo_t* c = context_.get();
  const double dash[] = {6.0, 5.0};
  cairo_set_dash(c, dash, dashed ? 2 : 0, 0.0);
  set(c, line);
  cairo_set_line_width(c, width);
  cairo_move_to(c, points.front().x, points.front().y);
  for (const glm::dvec2& p : points) cairo_line_to(c, p.x, p.y);
  cairo_stroke(c);
  cairo_set_dash(c, dash, 0, 0.0);
}

void Canvas::disc(const glm::dvec2& centre, double radius, const Colour& fill) {
  set(context_.get(), fill);
  cairo_new_sub_path(context_.get());
  cairo_arc(context_.get(), centre.x, centre.y, radius, 0.0, 2.0 * pi);
  cairo_fill(context_.get());
}

void Canvas::circle(const glm::dvec2& centre, double radius, const Colour& line, double width) {
  set(context_.get(), line);
  cairo_set_line_width(context_.get(), width);
  cairo_new_sub_path(context_.get());
  cairo_arc(context_.get(), centre.x, centre.y, radius, 0.0, 2.0 * pi);
  cairo_stroke(context_.get());
}

void Canvas::cross(const glm::dvec2& centre, double size, const Colour& line, double width) {
  polyline({centre - glm::dvec2(size, size), centre + glm::dvec2(size, size)}, line, width);
  polyline({centre + glm::dvec2(-size, size), centre + glm::dvec2(size, -size)}, line, width);
}

void Canvas::polygon(const std::vector<glm::dvec2>& points, const Colour& fill) {
  if (points.size() < 3) return;
  set(context_.get(), fill);
  cairo_move_to(context_.get(), points.front().x, points.front().y);
  for (const glm::dvec2& p : points) cairo_line_to(context_.get(), p.x, p.y);
  cairo_close_path(context_.get());
  cairo_fill(context_.get());
}

void Canvas::text(const std::string& words, const glm::dvec2& at, double size, const Colour& colour, Align align) {
  const double back = align == Align::left ? 0.0 : text_width(words, size) * (align == Align::middle ? 0.5 : 1.0);
  set(context_.get(), colour);
  font(context_.get(), size);
  cairo_move_to(context_.get(), at.x - back, at.y);
  cairo_show_text(context_.get(), words.c_str());
}

void Canvas::upward_text(const std::string& words, const glm::dvec2& at, double size, const Colour& colour) {
  cairo_save(context_.get());
  cairo_translate(context_.get(), at.x, at.y);
  cairo_rotate(context_.get(), -0.5 * pi);
  text(words, {0.0, 0.0}, size, colour, Align::middle);
  cairo_restore(context_.get());
}

void Canvas::clip(const glm::dvec2& corner, const glm::dvec2& size) {
  cairo_save(context_.get());
  cairo_rectangle(context_.get(), corner.x, corner.y, size.x, size.y);
  cairo_clip(context_.get());
}

void Canvas::unclip() { cairo_restore(context_.get()); }

double Canvas::text_width(const std::string& words, double size) {
  font(context_.get(), size);
  cairo_text_extents_t extents;
  cairo_text_extents(context_.get(), words.c_str(), &extents);
  return extents.x_advance;
}

void Canvas::image(const std::vector<std::uint32_t>& pixels, int columns, int rows, const glm::dvec2& corner, double scale) {
  // Cairo wants rows of its own stride; for 32-bit pixels that is the width.
  std::vector<std::uint32_t> copy = pixels;
  const std::shared_ptr<cairo_surface_t> source(
      cairo_image_surface_create_for_data(reinterpret_cast<unsigned char*>(copy.data()), CAIRO_FORMAT_RGB24, columns, rows, 4 * columns), cairo_surface_destroy);
  cairo_t* c = context_.get();
  cairo_save(c);
  cairo_translate(c, corner.x, corner.y);
  cairo_scale(c, scale, scale);
  cairo_set_source_surface(c, source.get(), 0.0, 0.0);
  cairo_pattern_set_filter(cairo_get_source(c), CAIRO_FILTER_NEAREST);
  cairo_paint(c);
  cairo_restore(c);
}

Result<Done> Canvas::write(const std::filesystem::path& file) const {
  std::string png;
  if (svg_) cairo_surface_finish(surface_.get());
  const cairo_status_t status = svg_ ? cairo_surface_status(surface_.get()) : cairo_surface_write_to_png_stream(surface_.get(), append, &png);
  if (status != CAIRO_STATUS_SUCCESS) return Error{fmt::format("{}: the picture could not be made: {}", file.string(), cairo_status_to_string(status))};
  return write_file(file, svg_ ? *svg_ : png);
}

}  // namespace thicket
