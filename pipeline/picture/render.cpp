#include "pipeline/picture/render.h"

#include <algorithm>
#include <array>
#include <limits>
#include <optional>
#include <stdexcept>
#include <vector>

#include "pipeline/base/portable_math.h"
#include "pipeline/picture/lighting.h"
#include "pipeline/picture/view.h"

namespace blockrand::picture {
namespace {

struct Rgb {
  float r = 0, g = 0, b = 0;
};
Rgb operator*(Rgb a, float s) { return {a.r * s, a.g * s, a.b * s}; }
Rgb operator*(Rgb a, Rgb b) { return {a.r * b.r, a.g * b.g, a.b * b.b}; }
Rgb operator+(Rgb a, Rgb b) { return {a.r + b.r, a.g + b.g, a.b + b.b}; }
Rgb mix(Rgb a, Rgb b, float share) { return a * (1 - share) + b * share; }

/// sRGB (IEC 61966-2-1) to linear light and back, from tables made with portable pow.
class Tones {
 public:
  Tones() {
    for (int i = 0; i < 256; ++i) {
      const double c = i / 255.0;
      linear_[static_cast<std::size_t>(i)] =
          static_cast<float>(c <= 0.04045 ? c / 12.92 : base::pow((c + 0.055) / 1.055, 2.4));
    }
    for (int i = 0; i <= kSteps; ++i) {
      const double c = static_cast<double>(i) / kSteps;
      encoded_[static_cast<std::size_t>(i)] =
          static_cast<std::uint8_t>((c <= 0.0031308 ? c * 12.92 : 1.055 * base::pow(c, 1 / 2.4) - 0.055) * 255 + 0.5);
    }
  }
  Rgb linear(Colour c) const { return {linear_[c.r], linear_[c.g], linear_[c.b]}; }
  std::uint8_t encoded(float v) const {
    return encoded_[static_cast<std::size_t>(std::clamp(v, 0.0f, 1.0f) * kSteps + 0.5f)];
  }

 private:
  static constexpr int kSteps = 8191;
  std::array<float, 256> linear_;
  std::array<std::uint8_t, kSteps + 1> encoded_;
};

/// Bright light is compressed towards white instead of cut off. x up to 0.6 stays; slopes meet there; 1 is reached at
/// infinity.
float compressed(float x) {
  constexpr float knee = 0.6f, room = 1 - knee;
  if (!(x > knee)) return x;
  return 1 - room * room / (x - knee + room);
}

constexpr std::uint32_t kNothing = 0xffffffff, kGroundPlane = 0xfffffffe;

/// What the samples of some rows see, with a row above them and two below for the lines between them.
class Samples {
 public:
  Samples(const View& view, int rows) : view_(view) {
    const std::size_t count = static_cast<std::size_t>(view.width()) * static_cast<std::size_t>(rows + 3);
    nearness_.resize(count);
    what_.resize(count);
  }

  void begin(int first, int end) {
    rows_ = {view_.width(), std::max(0, first - 1), std::min(view_.height(), end + 2)};
    const std::size_t count = static_cast<std::size_t>(rows_.width) * static_cast<std::size_t>(rows_.end - rows_.first);
    std::fill_n(nearness_.begin(), count, view_.perspective() ? 0.0f : -std::numeric_limits<float>::max());
    std::fill_n(what_.begin(), count, kNothing);
  }
  const Rows& rows() const { return rows_; }
  void put(std::size_t index, float nearness, std::uint32_t what) {
    if (!(nearness > nearness_[index])) return;
    nearness_[index] = nearness;
    what_[index] = what;
  }
  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y - rows_.first) * static_cast<std::size_t>(rows_.width) +
           static_cast<std::size_t>(x);
  }
  float nearness(std::size_t index) const { return nearness_[index]; }
  std::uint32_t what(std::size_t index) const { return what_[index]; }  ///< face, kGroundPlane or kNothing

 private:
  const View& view_;
  Rows rows_;
  std::vector<float> nearness_;
  std::vector<std::uint32_t> what_;
};

/// Which triangles can be seen in which rows: in clusters, as they follow each other in the scene.
class Clusters {
 public:
  Clusters(const Scene& scene, const View& view) : scene_(scene) {
    const auto triangles = scene.triangles();
    for (std::size_t begin = 0; begin < triangles.size(); begin += kSize) {
      const std::size_t end = std::min(begin + kSize, triangles.size());
      Box box;
      for (std::size_t i = begin; i < end; ++i)
        for (const Scene::Vector& v : triangles[i].corners) box.include({v.x, v.y, v.z});
      Cluster cluster{begin, end, 0, view.height()};
      double left = 1e300, right = -1e300, top = 1e300, bottom = -1e300;
      bool all = true;
      for (const Point3& corner : box.corners()) {
        const Point3 c = view.to_camera(corner);
        all = all && view.in_front(c);
        if (!all) break;
        const Projected p = view.project(c);
        left = std::min(left, p.x);
        right = std::max(right, p.x);
        top = std::min(top, p.y);
        bottom = std::max(bottom, p.y);
      }
      if (all) {
        if (right < -1 || left > view.width() + 1 || bottom < -1 || top > view.height() + 1) continue;
        cluster.first_row = static_cast<int>(std::max(0.0, top - 1));
        cluster.end_row = static_cast<int>(std::min<double>(view.height(), bottom + 2));
      }
      clusters_.push_back(cluster);
    }
  }

  void draw(const View& view, Samples& samples) const {
    const auto triangles = scene_.triangles();
    const auto faces = scene_.faces();
    const Point3 eye = view.eye();
    for (const Cluster& cluster : clusters_) {
      if (cluster.end_row <= samples.rows().first || cluster.first_row >= samples.rows().end) continue;
      for (std::size_t i = cluster.begin; i < cluster.end; ++i) {
        const Scene::Triangle& triangle = triangles[i];
        const Scene::Face& face = faces[triangle.face];
        if (face.closed) {
          const Scene::Vector& c = triangle.corners[0];
          const Point3 sight = view.perspective() ? Point3{c.x, c.y, c.z} - eye : view.forward();
          if (face.normal.x * sight.x + face.normal.y * sight.y + face.normal.z * sight.z >= 0) continue;
        }
        picture::draw(view, triangle, samples.rows(), [&](std::size_t at, double nearness) {
          samples.put(at, static_cast<float>(nearness), triangle.face);
        });
      }
    }
  }

 private:
  static constexpr std::size_t kSize = 128;  // triangles
  struct Cluster {
    std::size_t begin = 0, end = 0;
    int first_row = 0, end_row = 0;
  };
  const Scene& scene_;
  std::vector<Cluster> clusters_;
};

void draw_ground(const Scene& scene, const View& view, Samples& samples) {
  if (!scene.ground()) return;
  const double z = scene.ground()->z;
  const View::Linear plane = view.plane({0, 0, 1}, z);
  const bool from_above = view.perspective() ? view.eye().z > z : view.forward().z < 0;
  if (!plane.valid || !from_above) return;
  std::size_t i = 0;
  for (int y = samples.rows().first; y < samples.rows().end; ++y)
    for (int x = 0; x < view.width(); ++x, ++i)
      samples.put(i, static_cast<float>(plane(x + 0.5, y + 0.5)), kGroundPlane);
}

/// m. Samples up to this size get lines of full strength.
constexpr double kFineSample = 0.35;

/// Decides where faces meet, end, or pass from one object to the next.
class Edges {
 public:
  Edges(const Scene& scene, const View& view, const Samples& samples, const RenderOptions& options)
      : scene_(scene),
        view_(view),
        samples_(samples),
        crease_(static_cast<float>(base::cos(options.crease_angle * base::kRadiansPerDegree))) {}

  /// True when a line runs between a sample and the one `step` further right or down, and belongs on this sample.
  bool at(int x, int y) const {
    const std::size_t i = samples_.index(x, y), row = static_cast<std::size_t>(view_.width());
    return (x + 1 < view_.width() && between(i, i + 1, x > 0 ? i - 1 : i, x + 2 < view_.width() ? i + 2 : i + 1)) ||
           (y + 1 < view_.height() &&
            between(i, i + row, y > 0 ? i - row : i, y + 2 < view_.height() ? i + 2 * row : i + row));
  }

 private:
  /// `before`, i, j, `after` lie in a row.
  bool between(std::size_t i, std::size_t j, std::size_t before, std::size_t after) const {
    const std::uint32_t a = samples_.what(i), b = samples_.what(j);
    // Where a wall meets the ground, shade tells them apart; a line there is drawn on the wall only.
    if (a == b || a >= kGroundPlane) return false;
    if (b >= kGroundPlane) return true;
    const Scene::Face &s = scene_.faces()[a], &t = scene_.faces()[b];
    if (s.object != t.object) return true;
    const float cosine = s.normal.x * t.normal.x + s.normal.y * t.normal.y + s.normal.z * t.normal.z;
    if (cosine < crease_) return true;
    // Parallel faces at different depths: both sides' own slopes miss the other side.
    const float n = samples_.nearness(i), m = samples_.nearness(j);
    const float here = n + (n - samples_.nearness(before)) - m, there = m + (m - samples_.nearness(after)) - n;
    const float limit = view_.perspective() ? 0.5f * n * n : 0.5f;  // half a metre
    return (here > limit || here < -limit) && (there > limit || there < -limit);
  }
  const Scene& scene_;
  const View& view_;
  const Samples& samples_;
  float crease_;
};

/// Colours of pixels.
class Shader {
 public:
  Shader(const Scene& scene, const View& view, const Samples& samples, const RenderOptions& options,
         const Lighting& lighting)
      : scene_(scene),
        view_(view),
        samples_(samples),
        options_(options),
        lighting_(lighting),
        edges_(scene, view, samples, options),
        background_(tones_.linear(options.background)) {
    const Point3 sun = lighting.to_sun();
    sun_ = {static_cast<float>(sun.x), static_cast<float>(sun.y), static_cast<float>(sun.z)};
    if (scene.ground()) {
      ground_.normal = {0, 0, 1};
      ground_.albedo = tones_.linear(scene.ground()->colour);
      prepare(ground_);
    }
    const Box box = scene.bounds();
    if (!box.empty) {
      centre_ = box.centre() - scene.origin();
      const double dx = box.max.x - box.min.x, dy = box.max.y - box.min.y;
      radius_ = std::max(1.0, std::sqrt(dx * dx + dy * dy) / 2);
    }
  }

  /// The mean of a pixel's samples.
  Rgb pixel(int x, int y, int supersampling) {
    const int left = x * supersampling, top = y * supersampling;
    const std::uint32_t what = samples_.what(samples_.index(left, top));
    if (plain(left, top, supersampling, what)) {
      if (what == kNothing) return background_;
      const int middle = supersampling / 2;
      // The light of the sky changes slowly along a face.
      if (x == 0 || what != held_.what || ++held_.uses == kHeld) held_ = {.what = what, .uses = 0, .open = -1};
      return coloured(what, left + middle, top + middle, nullptr, &held_.open);
    }
    Rgb sum;
    std::optional<Lit> lit;  // the last sample's
    for (int j = 0; j < supersampling; ++j)
      for (int i = 0; i < supersampling; ++i) sum = sum + sample(left + i, top + j, lit);
    return sum * (1.0f / static_cast<float>(supersampling * supersampling));
  }

  std::uint8_t encoded(float v) const { return tones_.encoded(v); }

 private:
  /// What all samples of a face have in common.
  struct Surface {
    std::uint32_t what = kNothing;
    Scene::Vector normal;
    Rgb albedo;
    float facing = 0;  ///< cosine between the sun and the normal, at least 0
    SkyField::Asker sky;
    bool blended = false, two_sided = false;
  };
  /// The light that one of a pixel's samples gets, for others beside it that look the same way.
  struct Lit {
    Scene::Vector normal;
    float nearness = 0;
    Rgb arriving;
  };

  /// All samples of the pixel see one face, and no line runs between them or behind them.
  bool plain(int left, int top, int supersampling, std::uint32_t what) const {
    // Lines lie on the left or upper of two samples: those right of and below the pixel count as well.
    const int right = std::min(left + supersampling, view_.width() - 1),
              bottom = std::min(top + supersampling, view_.height() - 1);
    for (int y = top; y <= bottom; ++y) {
      const std::size_t row = samples_.index(left, y);
      for (int x = 0; x <= right - left; ++x)
        if (samples_.what(row + static_cast<std::size_t>(x)) != what) return false;
    }
    return true;
  }

  Rgb sample(int x, int y, std::optional<Lit>& lit) {
    const std::size_t i = samples_.index(x, y);
    const std::uint32_t what = samples_.what(i);
    Rgb colour = what == kNothing ? background_ : coloured(what, x, y, &lit, nullptr);
    if (options_.lines && edges_.at(x, y)) {
      // Far away, where houses are a few samples wide, full lines would be all that is left of them.
      const double size = what < kGroundPlane ? view_.sample_size(samples_.nearness(i)) : kFineSample;
      const double strength = options_.line_strength * std::clamp(kFineSample / size, 0.12, 1.0);
      colour = mix(colour, Rgb{0.05f, 0.05f, 0.06f}, static_cast<float>(strength));
    }
    return colour;
  }

  /// \param lit   the light of a sample beside it, and then of this one; null: of none
  /// \param open  the share of the sky that is open; negative: it is looked up, and told here; null: it is looked up
  Rgb coloured(std::uint32_t what, int x, int y, std::optional<Lit>* lit, float* open) {
    const float nearness = samples_.nearness(samples_.index(x, y));
    const Surface& surface = what == kGroundPlane ? ground_ : surface_of(what);
    const bool known_light = !options_.lit || (lit && *lit && same_light(**lit, surface.normal, nearness));
    Point3 place;
    if (!known_light || surface.blended || what == kGroundPlane) place = view_.position(x + 0.5, y + 0.5, nearness);
    Rgb colour = surface.blended ? blend_at(scene_.blends()[scene_.faces()[what].blend], place) : surface.albedo;
    if (options_.lit) {
      const Rgb arriving = known_light ? (*lit)->arriving : light_at(surface, place, open);
      if (lit && !known_light) *lit = Lit{surface.normal, nearness, arriving};
      colour = colour * arriving * 0.45f;
      colour = {compressed(colour.r), compressed(colour.g), compressed(colour.b)};
    }
    if (what == kGroundPlane)
      if (const float share = faded(place); share > 0) colour = mix(colour, background_, share);
    return colour;
  }

  bool same_light(const Lit& lit, const Scene::Vector& n, float nearness) const {
    if (!(lit.normal.x * n.x + lit.normal.y * n.y + lit.normal.z * n.z > 0.999f)) return false;
    const float away = nearness - lit.nearness, limit = view_.perspective() ? nearness * nearness : 1.0f;  // a metre
    return away < limit && away > -limit;
  }

  Rgb light_at(const Surface& surface, Point3 place, float* known_open) const {
    const Scene::Vector p{static_cast<float>(place.x), static_cast<float>(place.y), static_cast<float>(place.z)};
    Surface turned;
    const Surface* s = &surface;
    if (surface.two_sided) {
      const Point3 d = view_.perspective() ? place - view_.eye() : view_.forward();
      const Scene::Vector& n = surface.normal;
      if (n.x * d.x + n.y * d.y + n.z * d.z > 0) {
        turned.normal = {-n.x, -n.y, -n.z};
        prepare(turned);
        s = &turned;
      }
    }
    // Warm sun, cool sky, and a little light from the ground for what faces down.
    const float facing = s->facing > 0 ? s->facing * lighting_.sun(p, s->normal) : 0.0f;
    float open = known_open ? *known_open : -1;
    if (open < 0) open = lighting_.sky() ? lighting_.sky()->open(s->sky, p.x, p.y, p.z) : 1.0f;
    if (known_open) *known_open = open;
    const auto strength = static_cast<float>(options_.sky_strength);
    const float sky = strength * (0.5f + 0.5f * s->normal.z) * open;
    const float bounce = strength * (0.10f + 0.14f * (0.5f - 0.5f * s->normal.z));
    return Rgb{1.0f, 0.95f, 0.87f} * (static_cast<float>(options_.sun_strength) * facing) +
           Rgb{0.86f, 0.93f, 1.0f} * sky + Rgb{1.0f, 0.97f, 0.92f} * (bounce * (0.4f + 0.6f * open));
  }

  void prepare(Surface& s) const {
    s.facing = std::max(0.0f, s.normal.x * sun_.x + s.normal.y * sun_.y + s.normal.z * sun_.z);
    if (lighting_.sky()) s.sky = lighting_.sky()->asker(s.normal);
  }
  const Surface& surface_of(std::uint32_t face) {
    Surface& s = surfaces_[face % kKept];
    if (s.what == face) return s;
    const Scene::Face& f = scene_.faces()[face];
    s = {};
    s.what = face;
    s.normal = f.normal;
    s.albedo = tones_.linear(f.colour);
    s.blended = f.blend != Scene::kNoBlend;
    s.two_sided = !f.closed;
    prepare(s);
    return s;
  }

  Rgb blend_at(const Scene::Blend& blend, Point3 p) const {
    // Barycentric coordinates of the place, as shares of the triangle's area.
    const auto corner = [&](std::size_t k) {
      return Point3{blend.corners[k].x, blend.corners[k].y, blend.corners[k].z};
    };
    const Point3 a = corner(0), b = corner(1), c = corner(2);
    const Point3 n = cross(b - a, c - a);
    const double whole = dot(n, n);
    const double wb = std::clamp(dot(cross(p - a, c - a), n) / whole, 0.0, 1.0);
    const double wc = std::clamp(dot(cross(b - a, p - a), n) / whole, 0.0, 1.0 - wb);
    return tones_.linear(blend.colours[0]) * static_cast<float>(1 - wb - wc) +
           tones_.linear(blend.colours[1]) * static_cast<float>(wb) +
           tones_.linear(blend.colours[2]) * static_cast<float>(wc);
  }
  /// How far a place of the ground has faded into the background.
  float faded(Point3 place) const {
    const Point3 d = place - centre_;
    const double near = options_.ground_fade * radius_;
    if (d.x * d.x + d.y * d.y <= near * near) return 0;
    const double distance = std::sqrt(d.x * d.x + d.y * d.y) / radius_ - options_.ground_fade;
    const double share = std::clamp(distance / (0.6 * options_.ground_fade), 0.0, 1.0);
    return static_cast<float>(share * share * (3 - 2 * share));
  }

  static constexpr std::size_t kKept = 256;  // surfaces
  static constexpr int kHeld = 4;            // pixels
  struct {
    std::uint32_t what = kNothing;
    int uses = 0;
    float open = -1;
  } held_;
  const Scene& scene_;
  const View& view_;
  const Samples& samples_;
  const RenderOptions& options_;
  const Lighting& lighting_;
  Tones tones_;
  Edges edges_;
  Rgb background_;
  Scene::Vector sun_;
  Surface ground_;
  std::array<Surface, kKept> surfaces_;
  Point3 centre_;
  double radius_ = 1;
};

/// Samples that are held at a time: with nearness and face 2 MB, as a core's cache.
constexpr int kBandSamples = 250'000;

}  // namespace

Image render(const Scene& scene, const Camera& camera, const RenderOptions& options, const Lighting* lighting) {
  const auto check = [](int value, int most, const char* what) {
    if (value < 1 || value > most) throw std::invalid_argument(std::string("picture: ") + what + " out of range");
  };
  check(options.width, 8192, "width");
  check(options.height, 8192, "height");
  check(options.supersampling, 4, "supersampling");
  check(options.shadow_map, 16384, "shadow_map");
  check(options.sky_map, 4096, "sky_map");

  std::optional<Lighting> own;
  if (!lighting) lighting = &own.emplace(scene, options);
  const int ss = options.supersampling;
  const View view(camera, scene.origin(), options.width * ss, options.height * ss);
  const Clusters clusters(scene, view);
  const int band = std::clamp(kBandSamples / (view.width() * ss), 1, options.height);  // pixels
  Samples samples(view, band * ss);
  Shader shader(scene, view, samples, options, *lighting);

  Image image{options.width, options.height, {}};
  image.rgb.resize(static_cast<std::size_t>(options.width) * static_cast<std::size_t>(options.height) * 3);
  std::uint8_t* out = image.rgb.data();
  for (int first = 0; first < options.height; first += band) {
    const int end = std::min(first + band, options.height);
    samples.begin(first * ss, end * ss);
    clusters.draw(view, samples);
    draw_ground(scene, view, samples);
    for (int y = first; y < end; ++y)
      for (int x = 0; x < options.width; ++x) {
        const Rgb mean = shader.pixel(x, y, ss);
        *out++ = shader.encoded(mean.r);
        *out++ = shader.encoded(mean.g);
        *out++ = shader.encoded(mean.b);
      }
  }
  return image;
}

}  // namespace blockrand::picture
