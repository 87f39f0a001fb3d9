#include "picture.hpp"

#include <fmt/format.h>
#include <spng.h>

#include <cstdlib>
#include <memory>

#include "thicket/base/files.hpp"

namespace thicket::gui {

Result<Done> write_picture(const std::filesystem::path& file, const Picture& picture) {
  const std::unique_ptr<spng_ctx, decltype(&spng_ctx_free)> png(spng_ctx_new(SPNG_CTX_ENCODER), &spng_ctx_free);
  const auto fault = [&](int code) { return Error{fmt::format("{}: no PNG can be made: {}", file.string(), spng_strerror(code))}; };
  spng_set_option(png.get(), SPNG_ENCODE_TO_BUFFER, 1);
  spng_ihdr header{};
  header.width = static_cast<std::uint32_t>(picture.width);
  header.height = static_cast<std::uint32_t>(picture.height);
  header.bit_depth = 8;
  header.color_type = SPNG_COLOR_TYPE_TRUECOLOR;
  spng_set_ihdr(png.get(), &header);
  if (const int code = spng_encode_image(png.get(), picture.rgb.data(), picture.rgb.size(), SPNG_FMT_PNG, SPNG_ENCODE_FINALIZE)) return fault(code);
  std::size_t size = 0;
  int code = SPNG_OK;
  const std::unique_ptr<void, decltype(&std::free)> encoded(spng_get_png_buffer(png.get(), &size, &code), &std::free);
  if (!encoded) return fault(code);
  return write_file(file, {static_cast<const char*>(encoded.get()), size});
}

}  // namespace thicket::gui
