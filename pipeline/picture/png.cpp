#include <png.h>

#include <algorithm>
#include <stdexcept>
#include <vector>

#include "pipeline/base/deflate.h"
#include "pipeline/picture/image.h"
#include "pipeline/picture/palette.h"

namespace blockrand::picture {
namespace {

/// libpng must not return from this; an exception passes through its C frames, which hold nothing to free but what
/// png_destroy_read_struct frees (Debian builds libpng with unwind tables, as every amd64 library).
[[noreturn]] void fail(png_structp, png_const_charp message) {
  throw std::runtime_error(std::string("PNG: ") + message);
}

void append_number(std::string& out, std::size_t value) {
  for (int shift = 24; shift >= 0; shift -= 8) out += static_cast<char>(value >> shift & 0xff);
}

void append_chunk(std::string& out, std::string_view name, std::string_view content) {
  append_number(out, content.size());
  const std::size_t begin = out.size();
  out += name;
  out += content;
  append_number(out, base::crc32_of(std::string_view(out).substr(begin)));
}

/// The numbers of the format (PNG specification, second edition, 2003).
enum class ColourType : char { rgb = 2, palette = 3 };
enum class Filter : char { none = 0, sub = 1, up = 2, paeth = 4 };

/// A file of these rows, each with its filter before it.
std::string file_of(int width, int height, int bits, ColourType type, std::string_view palette, std::string_view rows,
                    int level) {
  std::string out = "\x89PNG\r\n\x1a\n";
  std::string header;
  append_number(header, static_cast<std::size_t>(width));
  append_number(header, static_cast<std::size_t>(height));
  header += static_cast<char>(bits);
  header += static_cast<char>(type);
  header.append(3, '\0');  // deflate, adaptive filters, not interlaced
  append_chunk(out, "IHDR", header);
  append_chunk(out, "sRGB", std::string(1, '\0'));  // perceptual
  if (!palette.empty()) append_chunk(out, "PLTE", palette);
  append_chunk(out, "IDAT", base::deflated(rows, level, base::DeflateFormat::zlib));
  append_chunk(out, "IEND", {});
  return out;
}

/// What differs from the pixel that the neighbours on the left, above, and on the upper left let expect.
std::uint8_t paeth(std::uint8_t left, std::uint8_t above, std::uint8_t corner) {
  const int to_left = above - corner, to_above = left - corner;
  const int by_left = to_left < 0 ? -to_left : to_left, by_above = to_above < 0 ? -to_above : to_above;
  const int by_corner = to_left + to_above < 0 ? -(to_left + to_above) : to_left + to_above;
  return by_left <= by_above && by_left <= by_corner ? left : by_above <= by_corner ? above : corner;
}

/// Appends rows of three bytes a pixel, each with the filter that leaves the smallest differences: rendered surfaces are smooth, lines
/// and background are not.
class RowFilter {
 public:
  explicit RowFilter(std::size_t row) : row_(row), above_(row), best_(row), tried_(row) {}

  void append(const std::uint8_t* pixels, std::string& out) {
    Filter filter = Filter::none;
    std::size_t least = weight(pixels);
    const auto keep = [&](Filter tried) {
      const std::size_t sum = weight(tried_.data());
      if (sum >= least) return;
      least = sum;
      filter = tried;
      best_.swap(tried_);
    };
    constexpr std::size_t kPixel = 3;
    const std::uint8_t* const above = above_.data();
    for (std::size_t i = 0; i < row_; ++i) tried_[i] = static_cast<std::uint8_t>(pixels[i] - above[i]);
    keep(Filter::up);
    if (least > 0) {
      for (std::size_t i = 0; i < kPixel; ++i) tried_[i] = pixels[i];
      for (std::size_t i = kPixel; i < row_; ++i) tried_[i] = static_cast<std::uint8_t>(pixels[i] - pixels[i - kPixel]);
      keep(Filter::sub);
      for (std::size_t i = 0; i < kPixel; ++i) tried_[i] = static_cast<std::uint8_t>(pixels[i] - above[i]);
      for (std::size_t i = kPixel; i < row_; ++i)
        tried_[i] = static_cast<std::uint8_t>(pixels[i] - paeth(pixels[i - kPixel], above[i], above[i - kPixel]));
      keep(Filter::paeth);
    }
    out += static_cast<char>(filter);
    const std::uint8_t* const from = filter == Filter::none ? pixels : best_.data();
    out.append(reinterpret_cast<const char*>(from), row_);
    std::copy_n(pixels, row_, above_.begin());
  }

 private:
  /// The sum of the bytes, taken as signed ones.
  std::size_t weight(const std::uint8_t* bytes) const {
    std::size_t sum = 0;
    for (std::size_t i = 0; i < row_; ++i) {
      const int v = static_cast<std::int8_t>(bytes[i]);
      sum += static_cast<std::size_t>(v < 0 ? -v : v);
    }
    return sum;
  }
  std::size_t row_;
  std::vector<std::uint8_t> above_, best_, tried_;
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
  constexpr int kLevel = 3;
  const std::size_t row = checked_row(image);
  std::string rows;
  rows.reserve((row + 1) * static_cast<std::size_t>(image.height));
  RowFilter filter(row);
  for (int y = 0; y < image.height; ++y) filter.append(image.rgb.data() + static_cast<std::size_t>(y) * row, rows);
  return file_of(image.width, image.height, 8, ColourType::rgb, {}, rows, kLevel);
}

std::string palette_png(const Image& image, int colours) {
  constexpr int kLevel = 9;
  checked_row(image);
  return png(image.width, reduce_colours(image, colours), kLevel);
}

std::string png(int width, const PaletteImage& image, int level) {
  std::string palette;
  for (const model::Colour& c : image.palette)
    for (const std::uint8_t v : {c.r, c.g, c.b}) palette += static_cast<char>(v);
  const int bits = image.palette.size() <= 16 ? 4 : 8;
  const int height = static_cast<int>(image.pixels.size() / static_cast<std::size_t>(width));
  // Neighbours in a palette are no neighbours in colour: differences say nothing.
  std::string rows;
  rows.reserve((static_cast<std::size_t>(width) + 1) * static_cast<std::size_t>(height));
  const std::uint8_t* pixel = image.pixels.data();
  for (int y = 0; y < height; ++y) {
    rows += static_cast<char>(Filter::none);
    if (bits == 8) {
      rows.append(reinterpret_cast<const char*>(pixel), static_cast<std::size_t>(width));
      pixel += width;
      continue;
    }
    for (int x = 0; x < width; ++x, ++pixel) {
      if (x % 2 == 0)
        rows += static_cast<char>(*pixel << 4);
      else
        rows.back() = static_cast<char>(rows.back() | *pixel);
    }
  }
  return file_of(width, height, bits, ColourType::palette, palette, rows, level);
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

Image blank(int width, int height, model::Colour colour) {
  Image image{width, height, {}};
  image.rgb.resize(static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * 3);
  for (std::size_t i = 0; i < image.rgb.size(); i += 3) {
    image.rgb[i] = colour.r;
    image.rgb[i + 1] = colour.g;
    image.rgb[i + 2] = colour.b;
  }
  return image;
}

void put(Image& on, const Image& picture, int column, int row) {
  const int left = std::max(0, column), right = std::min(on.width, column + picture.width);
  if (left >= right) return;
  for (int y = std::max(0, row); y < std::min(on.height, row + picture.height); ++y)
    std::copy_n(picture.pixel(left - column, y - row), static_cast<std::size_t>(right - left) * 3,
                on.rgb.begin() + (static_cast<std::ptrdiff_t>(y) * on.width + left) * 3);
}

}  // namespace blockrand::picture
