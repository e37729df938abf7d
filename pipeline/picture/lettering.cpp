#include "pipeline/picture/lettering.h"

#include <ft2build.h>
#include FT_FREETYPE_H
#include FT_OUTLINE_H

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <stdexcept>

#include "pipeline/picture/assets.h"

namespace blockrand::picture {

using model::Colour;
using model::Point2;

namespace {

constexpr char32_t kReplacement = 0xFFFD;

/// The character at `at`, which moves behind it. What is not UTF-8 is U+FFFD, a byte at a time.
char32_t next(std::string_view text, std::size_t& at) {
  const auto byte = [&](std::size_t i) { return static_cast<std::uint8_t>(text[i]); };
  const std::uint8_t first = byte(at++);
  if (first < 0x80) return first;
  const int more = first >= 0xF0 && first < 0xF5 ? 3 : first >= 0xE0 && first < 0xF0 ? 2 : first >= 0xC2 ? 1 : 0;
  if (more == 0 || first >= 0xF5) return kReplacement;
  char32_t c = first & (0x3F >> more);
  for (int i = 0; i < more; ++i) {
    const std::size_t here = at + static_cast<std::size_t>(i);
    if (here >= text.size() || (byte(here) & 0xC0) != 0x80) return kReplacement;
    c = c << 6 | (byte(here) & 0x3F);
  }
  constexpr char32_t kLeast[] = {0, 0x80, 0x800, 0x10000};
  if (c < kLeast[more] || c > 0x10FFFF || (c >= 0xD800 && c < 0xE000)) return kReplacement;
  at += static_cast<std::size_t>(more);
  return c;
}

/// Marks that order or join letters and show nothing themselves.
bool shows_nothing(char32_t c) {
  return c == 0xAD || (c >= 0x200B && c <= 0x200F) || (c >= 0x202A && c <= 0x202E) || (c >= 0x2060 && c <= 0x206F) ||
         (c >= 0xFE00 && c <= 0xFE0F) || c == 0xFEFF;
}

std::vector<char32_t> characters(std::string_view text) {
  std::vector<char32_t> out;
  for (std::size_t at = 0; at < text.size();) {
    const char32_t c = next(text, at);
    if (c < 0x20 || (c >= 0x7F && c < 0xA0))
      out.push_back(' ');
    else if (!shows_nothing(c))
      out.push_back(c);
  }
  return out;
}

std::uint8_t mixed(std::uint8_t below, std::uint8_t above, int share) {
  return static_cast<std::uint8_t>((below * (255 - share) + above * share + 127) / 255);
}

/// How much of each pixel of a rectangle is covered, in 255ths.
struct Mask {
  int left = 0, top = 0, width = 0, height = 0;
  std::vector<std::uint8_t> covered;

  std::uint8_t* row(int y) { return &covered[static_cast<std::size_t>(y) * static_cast<std::size_t>(width)]; }
  const std::uint8_t* row(int y) const { return const_cast<Mask*>(this)->row(y); }
};

/// A row of pixels from FreeType, whose rows run upwards from 0.
void add_spans(int y, int count, const FT_Span* spans, void* user) {
  Mask& mask = *static_cast<Mask*>(user);
  const int row = -1 - y - mask.top;
  if (row < 0 || row >= mask.height) return;
  std::uint8_t* const out = mask.row(row);
  for (int i = 0; i < count; ++i) {
    const int first = spans[i].x - mask.left, from = std::max(first, 0),
              to = std::min(first + static_cast<int>(spans[i].len), mask.width);
    for (int x = from; x < to; ++x) out[x] = static_cast<std::uint8_t>(std::min(255, out[x] + spans[i].coverage));
  }
}

void paint(Image& image, const Mask& mask, Colour c) {
  for (int y = std::max(0, -mask.top); y < std::min(mask.height, image.height - mask.top); ++y)
    for (int x = std::max(0, -mask.left); x < std::min(mask.width, image.width - mask.left); ++x)
      if (const int share = mask.row(y)[x]; share > 0) {
        std::uint8_t* const rgb =
            &image.rgb[(static_cast<std::size_t>(y + mask.top) * static_cast<std::size_t>(image.width) +
                        static_cast<std::size_t>(x + mask.left)) *
                       3];
        rgb[0] = mixed(rgb[0], c.r, share);
        rgb[1] = mixed(rgb[1], c.g, share);
        rgb[2] = mixed(rgb[2], c.b, share);
      }
}

/// The mask, `reach` px wider on all sides.
Mask grown(const Mask& from, double reach) {
  const int r = static_cast<int>(std::ceil(reach));
  struct Step {
    int x, y, share;
  };
  std::vector<Step> steps;
  for (int y = -r; y <= r; ++y)
    for (int x = -r; x <= r; ++x) {
      const double share = reach + 0.5 - std::sqrt(static_cast<double>(x * x + y * y));
      if (share > 0) steps.push_back({x, y, static_cast<int>(std::min(1.0, share) * 255 + 0.5)});
    }
  Mask to = from;  // which leaves room for it
  // From there nothing outside is nearest.
  const auto surrounded = [&](int x, int y) {
    return x > 0 && y > 0 && x + 1 < from.width && y + 1 < from.height && from.row(y)[x - 1] == 255 &&
           from.row(y)[x + 1] == 255 && from.row(y - 1)[x] == 255 && from.row(y + 1)[x] == 255;
  };
  for (int y = 0; y < from.height; ++y)
    for (int x = 0; x < from.width; ++x) {
      const int covered = from.row(y)[x];
      if (covered == 0 || (covered == 255 && surrounded(x, y))) continue;
      for (const Step& s : steps) {
        const int u = x + s.x, v = y + s.y;
        if (u < 0 || v < 0 || u >= to.width || v >= to.height) continue;
        std::uint8_t& at = to.row(v)[u];
        at = std::max(at, static_cast<std::uint8_t>(covered * s.share / 255));
      }
    }
  return to;
}

}  // namespace

struct Lettering::Face {
  FT_Library library = nullptr;
  FT_Face face = nullptr;

  Face() {
    if (FT_Init_FreeType(&library) != 0) throw std::runtime_error("FreeType cannot be started");
    const std::string_view font = asset("fonts/DejaVuSansCondensed.ttf");
    if (FT_New_Memory_Face(library, reinterpret_cast<const FT_Byte*>(font.data()), static_cast<FT_Long>(font.size()), 0,
                           &face) != 0) {
      FT_Done_FreeType(library);
      throw std::runtime_error("FreeType cannot read the font of this program");
    }
  }
  ~Face() {
    FT_Done_Face(face);
    FT_Done_FreeType(library);
  }
  Face(const Face&) = delete;
  Face& operator=(const Face&) = delete;

  FT_UInt index(char32_t c) const { return FT_Get_Char_Index(face, c); }

  /// Calls use(x, outline) for each letter: where it begins, and its outline, in units of the font.
  /// \returns the whole width
  template <class Use>
  long set(std::string_view text, const Use& use) const {
    long x = 0;
    FT_UInt before = 0;
    for (const char32_t c : characters(text)) {
      const FT_UInt glyph = index(c);
      FT_Vector kerned{0, 0};
      if (before != 0 && glyph != 0 && FT_Get_Kerning(face, before, glyph, FT_KERNING_UNSCALED, &kerned) == 0)
        x += kerned.x;
      before = glyph;
      // Unscaled outlines are neither hinted nor bitmaps.
      if (FT_Load_Glyph(face, glyph, FT_LOAD_NO_SCALE) != 0) continue;
      use(x, face->glyph->outline);
      x += face->glyph->metrics.horiAdvance;
    }
    return x;
  }
};

Lettering::Lettering() : face_(std::make_unique<Face>()) {}
Lettering::~Lettering() = default;
Lettering::Lettering(Lettering&&) noexcept = default;
Lettering& Lettering::operator=(Lettering&&) noexcept = default;

double Lettering::width(std::string_view text, double size) const {
  const long units = face_->set(text, [](long, const FT_Outline&) {});
  return static_cast<double>(units) * size / face_->face->units_per_EM;
}

void Lettering::write(Image& image, Point2 at, std::string_view text, const TextStyle& style, Point2 direction) const {
  if (!(style.size > 0) || image.rgb.empty()) return;
  const double scale = style.size / face_->face->units_per_EM;
  // In 64ths of a pixel, y upwards, as FreeType has it: an outline for each letter.
  struct Letter {
    std::vector<FT_Vector> points;
    std::vector<char> tags;
    std::vector<short> ends;
  };
  std::vector<Letter> letters;
  double left = 1e9, right = -1e9, top = 1e9, bottom = -1e9;
  face_->set(text, [&](long x, const FT_Outline& outline) {
    if (outline.n_points == 0) return;
    Letter& letter = letters.emplace_back();
    letter.tags.assign(outline.tags, outline.tags + outline.n_points);
    letter.ends.assign(outline.contours, outline.contours + outline.n_contours);
    for (int i = 0; i < outline.n_points; ++i) {
      const double along = scale * static_cast<double>(x + outline.points[i].x),
                   up = scale * static_cast<double>(outline.points[i].y);
      const Point2 p{at.x + along * direction.x + up * direction.y, at.y + along * direction.y - up * direction.x};
      left = std::min(left, p.x), right = std::max(right, p.x);
      top = std::min(top, p.y), bottom = std::max(bottom, p.y);
      letter.points.push_back({static_cast<FT_Pos>(std::clamp(std::floor(64 * p.x + 0.5), -1e6, 1e6)),
                               static_cast<FT_Pos>(std::clamp(std::floor(-64 * p.y + 0.5), -1e6, 1e6))});
    }
  });
  // Room for the halo, and no more than it takes to paint the picture.
  const double room = style.halo + 2;
  left = std::max(std::floor(left - room), -room), top = std::max(std::floor(top - room), -room);
  right = std::min(std::ceil(right + room), image.width + room);
  bottom = std::min(std::ceil(bottom + room), image.height + room);
  if (!(left < right && top < bottom)) return;
  Mask mask{static_cast<int>(left),
            static_cast<int>(top),
            static_cast<int>(right - left),
            static_cast<int>(bottom - top),
            {}};
  if (mask.width <= 0 || mask.height <= 0) return;
  mask.covered.assign(static_cast<std::size_t>(mask.width) * static_cast<std::size_t>(mask.height), 0);
  for (Letter& letter : letters) {
    FT_Outline outline{};
    outline.n_points = static_cast<short>(letter.points.size());
    outline.n_contours = static_cast<short>(letter.ends.size());
    outline.points = letter.points.data();
    outline.tags = letter.tags.data();
    outline.contours = letter.ends.data();
    FT_Raster_Params how{};
    how.flags = FT_RASTER_FLAG_AA | FT_RASTER_FLAG_DIRECT | FT_RASTER_FLAG_CLIP;
    how.gray_spans = add_spans;
    how.user = &mask;
    how.clip_box = {mask.left, -(mask.top + mask.height), mask.left + mask.width, -mask.top};
    FT_Outline_Render(face_->library, &outline, &how);  // what cannot be drawn is left out
  }
  if (style.halo > 0) paint(image, grown(mask, style.halo), style.halo_colour);
  paint(image, mask, style.colour);
}

std::string Lettering::fitted(std::string_view text, double size, double width) const {
  if (this->width(text, size) <= width) return std::string(text);
  constexpr std::string_view kDots = "\u2026";
  std::size_t fits = 0;
  for (std::size_t at = 0; at < text.size();) {
    next(text, at);
    if (this->width(std::string(text.substr(0, at)) + std::string(kDots), size) > width) break;
    fits = at;
  }
  while (fits > 0 && text[fits - 1] == ' ') --fits;
  return std::string(text.substr(0, fits)) + std::string(kDots);
}

std::vector<std::string> Lettering::lines(std::string_view text, double size, double width) const {
  std::vector<std::string> out;
  for (std::size_t at = 0; at < text.size();) {
    std::size_t end = std::min(text.find(' ', at), text.size());
    const std::string word(text.substr(at, end - at));
    at = end + 1;
    if (word.empty()) continue;
    if (!out.empty() && this->width(out.back() + " " + word, size) <= width)
      out.back() += " " + word;
    else
      out.push_back(word);
  }
  return out;
}

bool Lettering::can_write(std::string_view text) const {
  const std::vector<char32_t> all = characters(text);
  return std::ranges::all_of(all, [&](char32_t c) { return face_->index(c) != 0; });
}

std::array<Point2, 4> sign(Image& image, std::string_view words) {
  constexpr int kLeastSide = 40;
  if (std::min(image.width, image.height) < kLeastSide || words.empty()) return {};
  const Lettering letters;
  // Readable in a small picture, and in a large one when it is looked at as a whole.
  const double size = std::clamp(image.width / 75.0, 9.0, 28.0), margin = size * 0.35, line = size * 1.25;
  const std::vector<std::string> lines = letters.lines(words, size, image.width - 2 * margin);
  double widest = 0;
  for (const std::string& text : lines) widest = std::max(widest, letters.width(text, size));
  const int left = std::max(0, static_cast<int>(image.width - widest - 2 * margin));
  const int top = std::max(0, static_cast<int>(image.height - line * static_cast<double>(lines.size()) - margin));
  constexpr int kGround = 190;  // in 255ths
  for (int y = top; y < image.height; ++y)
    for (int x = left; x < image.width; ++x)
      for (int c = 0; c < 3; ++c) {
        std::uint8_t& at = image.rgb[(static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) +
                                      static_cast<std::size_t>(x)) *
                                         3 +
                                     static_cast<std::size_t>(c)];
        at = mixed(at, 255, kGround);
      }
  double base = top + margin / 2 + size * kAscent;
  for (const std::string& text : lines) {
    letters.write(image, {image.width - margin - letters.width(text, size), base}, text, {.size = size});
    base += line;
  }
  const auto corner = [](int x, int y) { return Point2{static_cast<double>(x), static_cast<double>(y)}; };
  return {corner(left, top), corner(image.width, top), corner(image.width, image.height), corner(left, image.height)};
}

}  // namespace blockrand::picture
