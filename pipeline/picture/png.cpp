#include <png.h>

#include <algorithm>
#include <array>
#include <stdexcept>

#include "pipeline/picture/image.h"
#include "pipeline/picture/palette.h"

namespace blockrand::picture {
namespace {

void append(png_structp png, png_bytep data, png_size_t size) {
  static_cast<std::string*>(png_get_io_ptr(png))->append(reinterpret_cast<const char*>(data), size);
}

/// libpng must not return from this; an exception passes through its C frames, which hold nothing to free but what
/// png_destroy_write_struct frees (Debian builds libpng with unwind tables, as every amd64 library).
[[noreturn]] void fail(png_structp, png_const_charp message) {
  throw std::runtime_error(std::string("PNG: ") + message);
}

struct Writer {
  png_structp png = nullptr;
  png_infop info = nullptr;

  Writer(std::string& bytes, int compression) {
    png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, fail, nullptr);
    if (png) info = png_create_info_struct(png);
    if (!info) {
      png_destroy_write_struct(&png, &info);
      throw std::runtime_error("PNG: no memory");
    }
    png_set_write_fn(png, &bytes, append, nullptr);
    png_set_compression_level(png, compression);
  }
  ~Writer() { png_destroy_write_struct(&png, &info); }
  Writer(const Writer&) = delete;
  Writer& operator=(const Writer&) = delete;

  void header(const Image& image, int bits, int colour_type) const {
    png_set_IHDR(png, info, static_cast<png_uint_32>(image.width), static_cast<png_uint_32>(image.height), bits,
                 colour_type, PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_BASE, PNG_FILTER_TYPE_BASE);
    png_set_sRGB(png, info, PNG_sRGB_INTENT_PERCEPTUAL);
  }
};

/// Bytes of a row.
std::size_t checked_row(const Image& image) {
  const auto row = static_cast<std::size_t>(image.width) * 3;
  if (image.width <= 0 || image.height <= 0 || image.rgb.size() != row * static_cast<std::size_t>(image.height))
    throw std::runtime_error("PNG: the image has no pixels, or not as many as its size says");
  return row;
}

}  // namespace

std::string png(const Image& image) {
  const std::size_t row = checked_row(image);
  std::string bytes;
  Writer w(bytes, 6);
  // Chosen row by row: rendered surfaces are smooth, lines and background are not.
  png_set_filter(w.png, PNG_FILTER_TYPE_BASE, PNG_ALL_FILTERS);
  w.header(image, 8, PNG_COLOR_TYPE_RGB);
  png_write_info(w.png, w.info);
  for (int y = 0; y < image.height; ++y) png_write_row(w.png, image.rgb.data() + static_cast<std::size_t>(y) * row);
  png_write_end(w.png, nullptr);
  return bytes;
}

std::string palette_png(const Image& image, int colours) {
  checked_row(image);
  const PaletteImage reduced = reduce_colours(image, colours);
  std::array<png_color, 256> palette{};
  for (std::size_t i = 0; i < reduced.palette.size(); ++i)
    palette[i] = {reduced.palette[i].r, reduced.palette[i].g, reduced.palette[i].b};
  std::string bytes;
  Writer w(bytes, 9);
  // Neighbours in a palette are no neighbours in colour: differences say nothing.
  png_set_filter(w.png, PNG_FILTER_TYPE_BASE, PNG_FILTER_NONE);
  w.header(image, reduced.palette.size() <= 16 ? 4 : 8, PNG_COLOR_TYPE_PALETTE);
  png_set_PLTE(w.png, w.info, palette.data(), static_cast<int>(reduced.palette.size()));
  png_write_info(w.png, w.info);
  png_set_packing(w.png);
  const auto row = static_cast<std::size_t>(image.width);
  for (int y = 0; y < image.height; ++y)
    png_write_row(w.png, reduced.pixels.data() + static_cast<std::size_t>(y) * row);
  png_write_end(w.png, nullptr);
  return bytes;
}

namespace {

/// Of a picture that is read: more would be no picture of ours.
constexpr png_uint_32 kMostPixels = 100'000'000;

struct Reader {
  png_structp png = nullptr;
  png_infop info = nullptr;
  std::string_view left;

  explicit Reader(std::string_view bytes) : left(bytes) {
    png = png_create_read_struct(PNG_LIBPNG_VER_STRING, nullptr, fail, [](png_structp, png_const_charp) {});
    if (png) info = png_create_info_struct(png);
    if (!info) {
      png_destroy_read_struct(&png, &info, nullptr);
      throw std::runtime_error("PNG: no memory");
    }
    png_set_read_fn(png, this, take);
  }
  ~Reader() { png_destroy_read_struct(&png, &info, nullptr); }
  Reader(const Reader&) = delete;
  Reader& operator=(const Reader&) = delete;

  static void take(png_structp png, png_bytep to, png_size_t size) {
    std::string_view& left = static_cast<Reader*>(png_get_io_ptr(png))->left;
    if (left.size() < size) png_error(png, "it ends too early");
    std::copy_n(left.begin(), size, reinterpret_cast<char*>(to));
    left.remove_prefix(size);
  }
};

}  // namespace

Image read_png(std::string_view bytes) {
  Reader r(bytes);
  png_read_info(r.png, r.info);
  const png_uint_32 width = png_get_image_width(r.png, r.info), height = png_get_image_height(r.png, r.info);
  if (width > kMostPixels / height) throw std::runtime_error("PNG: it has too many pixels");
  png_set_expand(r.png);
  png_set_strip_16(r.png);
  png_set_strip_alpha(r.png);
  png_set_gray_to_rgb(r.png);
  const int passes = png_set_interlace_handling(r.png);
  png_read_update_info(r.png, r.info);
  const std::size_t row = static_cast<std::size_t>(width) * 3;
  if (png_get_rowbytes(r.png, r.info) != row) throw std::runtime_error("PNG: its rows are no RGB");
  Image image{static_cast<int>(width), static_cast<int>(height), std::vector<std::uint8_t>(row * height)};
  for (int pass = 0; pass < passes; ++pass)
    for (png_uint_32 y = 0; y < height; ++y) png_read_row(r.png, image.rgb.data() + y * row, nullptr);
  png_read_end(r.png, nullptr);
  return image;
}

Image cut(const Image& image, int column, int row, int width, int height) {
  const int first = std::clamp(column, 0, image.width), last = std::clamp(column + width, first, image.width),
            top = std::clamp(row, 0, image.height), bottom = std::clamp(row + height, top, image.height);
  Image out{last - first, bottom - top, {}};
  if (out.width <= 0) return {};
  for (int y = top; y < bottom; ++y) {
    const std::uint8_t* from = image.pixel(first, y);
    out.rgb.insert(out.rgb.end(), from, from + 3 * static_cast<std::ptrdiff_t>(out.width));
  }
  return out;
}

}  // namespace blockrand::picture
