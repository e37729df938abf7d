#include <png.h>

#include <stdexcept>

#include "pipeline/picture/image.h"

namespace blockrand::picture {
namespace {

void append(png_structp png, png_bytep data, png_size_t size) {
  static_cast<std::string*>(png_get_io_ptr(png))->append(reinterpret_cast<const char*>(data), size);
}

/// libpng must not return from this; an exception passes through its C frames, which hold nothing to free but what
/// png_destroy_write_struct frees (Debian builds libpng with unwind tables, as every amd64 library).
[[noreturn]] void fail(png_structp, png_const_charp message) { throw std::runtime_error(std::string("PNG: ") + message); }

struct Writer {
  png_structp png = nullptr;
  png_infop info = nullptr;
  ~Writer() { png_destroy_write_struct(&png, &info); }
};

}  // namespace

std::string png(const Image& image) {
  const auto row = static_cast<std::size_t>(image.width) * 3;
  if (image.width <= 0 || image.height <= 0 || image.rgb.size() != row * static_cast<std::size_t>(image.height))
    throw std::runtime_error("PNG: the image has no pixels, or not as many as its size says");
  std::string bytes;
  Writer w;
  w.png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, fail, nullptr);
  if (w.png) w.info = png_create_info_struct(w.png);
  if (!w.info) throw std::runtime_error("PNG: no memory");
  png_set_write_fn(w.png, &bytes, append, nullptr);
  png_set_compression_level(w.png, 6);
  // Chosen row by row: rendered surfaces are smooth, lines and background are not.
  png_set_filter(w.png, PNG_FILTER_TYPE_BASE, PNG_ALL_FILTERS);
  png_set_IHDR(w.png, w.info, static_cast<png_uint_32>(image.width), static_cast<png_uint_32>(image.height), 8,
               PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_BASE, PNG_FILTER_TYPE_BASE);
  png_set_sRGB(w.png, w.info, PNG_sRGB_INTENT_PERCEPTUAL);
  png_write_info(w.png, w.info);
  for (int y = 0; y < image.height; ++y) png_write_row(w.png, image.rgb.data() + static_cast<std::size_t>(y) * row);
  png_write_end(w.png, nullptr);
  return bytes;
}

}  // namespace blockrand::picture
