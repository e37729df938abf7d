#include "pipeline/picture/render.h"

#include <algorithm>
#include <array>
#include <limits>
#include <stdexcept>

#include "pipeline/base/portable_math.h"
#include "pipeline/picture/light.h"
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
  const float over = (x - knee) / room;
  return knee + room * over / (1 + over);
}

Samples see(const Scene& scene, const View& view) {
  Samples s;
  const std::size_t count = static_cast<std::size_t>(view.width()) * static_cast<std::size_t>(view.height());
  s.nearness.assign(count, view.perspective() ? 0.0f : -std::numeric_limits<float>::max());
  s.what.assign(count, kNothing);
  const std::span<const Scene::Triangle> triangles = scene.triangles();
  const Point3 eye = view.eye();
  for (std::uint32_t t = 0; t < triangles.size(); ++t) {
    const Scene::Triangle& triangle = triangles[t];
    if (triangle.closed) {
      const Scene::Vector& c = triangle.corners[0];
      const Point3 sight = view.perspective() ? Point3{c.x, c.y, c.z} - eye : view.forward();
      if (triangle.normal.x * sight.x + triangle.normal.y * sight.y + triangle.normal.z * sight.z >= 0) continue;
    }
    draw(view, triangle, [&](std::size_t i, double nearness) {
      const auto n = static_cast<float>(nearness);
      if (n > s.nearness[i]) {
        s.nearness[i] = n;
        s.what[i] = t;
      }
    });
  }
  if (scene.ground()) {
    const double z = scene.ground()->z;
    const View::Linear plane = view.plane({0, 0, 1}, z);
    const bool from_above = view.perspective() ? eye.z > z : view.forward().z < 0;
    if (plane.valid && from_above) {
      std::size_t i = 0;
      for (int y = 0; y < view.height(); ++y)
        for (int x = 0; x < view.width(); ++x, ++i) {
          const auto n = static_cast<float>(plane(x + 0.5, y + 0.5));
          if (n > s.nearness[i]) {
            s.nearness[i] = n;
            s.what[i] = kGroundPlane;
          }
        }
    }
  }
  return s;
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
    const std::size_t i = index(x, y);
    return (x + 1 < view_.width() && between(i, i + 1, x > 0 ? i - 1 : i, x + 2 < view_.width() ? i + 2 : i + 1)) ||
           (y + 1 < view_.height() && between(i, index(x, y + 1), y > 0 ? index(x, y - 1) : i,
                                              y + 2 < view_.height() ? index(x, y + 2) : index(x, y + 1)));
  }

 private:
  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(view_.width()) + static_cast<std::size_t>(x);
  }
  /// `before`, i, j, `after` lie in a row.
  bool between(std::size_t i, std::size_t j, std::size_t before, std::size_t after) const {
    const std::uint32_t a = samples_.what[i], b = samples_.what[j];
    // Where a wall meets the ground, shade tells them apart; a line there is drawn on the wall only.
    if (a == b || a >= kGroundPlane) return false;
    if (b >= kGroundPlane) return true;
    const Scene::Triangle &s = scene_.triangles()[a], &t = scene_.triangles()[b];
    if (s.object != t.object) return true;
    const float cosine = s.normal.x * t.normal.x + s.normal.y * t.normal.y + s.normal.z * t.normal.z;
    if (cosine < crease_) return true;
    // Parallel faces at different depths: both sides' own slopes miss the other side.
    const float n = samples_.nearness[i], m = samples_.nearness[j];
    const float here = n + (n - samples_.nearness[before]) - m, there = m + (m - samples_.nearness[after]) - n;
    const float limit = view_.perspective() ? 0.5f * n * n : 0.5f;  // half a metre
    return (here > limit || here < -limit) && (there > limit || there < -limit);
  }
  const Scene& scene_;
  const View& view_;
  const Samples& samples_;
  float crease_;
};

/// Colours of samples.
class Shader {
 public:
  Shader(const Scene& scene, const View& view, const Samples& samples, const RenderOptions& options,
         const Scene& occluders)
      : scene_(scene),
        view_(view),
        samples_(samples),
        options_(options),
        light_(options.lit ? light_of(scene, view, samples, options, occluders) : Light{}),
        edges_(scene, view, samples, options),
        background_(tones_.linear(options.background)) {
    const Point3 sun = to_sun(options);
    sun_ = {static_cast<float>(sun.x), static_cast<float>(sun.y), static_cast<float>(sun.z)};
    const Box box = scene.bounds();
    if (!box.empty) {
      centre_ = box.centre() - scene.origin();
      const double dx = box.max.x - box.min.x, dy = box.max.y - box.min.y;
      radius_ = std::max(1.0, std::sqrt(dx * dx + dy * dy) / 2);
    }
  }

  Rgb shade(int x, int y) const {
    const std::size_t i =
        static_cast<std::size_t>(y) * static_cast<std::size_t>(view_.width()) + static_cast<std::size_t>(x);
    const std::uint32_t what = samples_.what[i];
    Rgb colour = background_;
    if (what != kNothing && !options_.lit) {
      colour = albedo(what, i, x, y);
      if (what == kGroundPlane) colour = mix(colour, background_, faded(i, x, y));
    } else if (what != kNothing) {
      const Scene::Vector n = normal_towards(scene_, what, view_, x, y);
      // Warm sun, cool sky, and a little light from the ground for what faces down.
      const float facing =
          std::max(0.0f, n.x * sun_.x + n.y * sun_.y + n.z * sun_.z) * static_cast<float>(light_.sun[i]) / 255.0f;
      const float open = light_.sky.empty() ? 1.0f : light_.sky[i];
      const auto sky = static_cast<float>(options_.sky_strength) * (0.5f + 0.5f * n.z) * open;
      const auto bounce = static_cast<float>(options_.sky_strength) * (0.10f + 0.14f * (0.5f - 0.5f * n.z));
      const Rgb arriving = Rgb{1.0f, 0.95f, 0.87f} * (static_cast<float>(options_.sun_strength) * facing) +
                           Rgb{0.86f, 0.93f, 1.0f} * sky + Rgb{1.0f, 0.97f, 0.92f} * (bounce * (0.4f + 0.6f * open));
      colour = albedo(what, i, x, y) * arriving * 0.45f;
      colour = {compressed(colour.r), compressed(colour.g), compressed(colour.b)};
      if (what == kGroundPlane) colour = mix(colour, background_, faded(i, x, y));
    }
    if (options_.lines && edges_.at(x, y)) {
      // Far away, where houses are a few samples wide, full lines would be all that is left of them.
      const double size = what < kGroundPlane ? view_.sample_size(samples_.nearness[i]) : kFineSample;
      const double strength = options_.line_strength * std::clamp(kFineSample / size, 0.12, 1.0);
      colour = mix(colour, Rgb{0.05f, 0.05f, 0.06f}, static_cast<float>(strength));
    }
    return colour;
  }

  std::uint8_t encoded(float v) const { return tones_.encoded(v); }

 private:
  Rgb albedo(std::uint32_t what, std::size_t i, int x, int y) const {
    if (what == kGroundPlane) return tones_.linear(scene_.ground()->colour);
    const Scene::Triangle& t = scene_.triangles()[what];
    if (!t.blended) return tones_.linear(t.colours[0]);
    // Barycentric coordinates of the place, as shares of the triangle's area.
    const auto corner = [&](std::size_t k) { return Point3{t.corners[k].x, t.corners[k].y, t.corners[k].z}; };
    const Point3 p = view_.position(x + 0.5, y + 0.5, samples_.nearness[i]), a = corner(0), b = corner(1),
                 c = corner(2);
    const Point3 n = cross(b - a, c - a);
    const double whole = dot(n, n);
    const double wb = std::clamp(dot(cross(p - a, c - a), n) / whole, 0.0, 1.0);
    const double wc = std::clamp(dot(cross(b - a, p - a), n) / whole, 0.0, 1.0 - wb);
    return tones_.linear(t.colours[0]) * static_cast<float>(1 - wb - wc) +
           tones_.linear(t.colours[1]) * static_cast<float>(wb) + tones_.linear(t.colours[2]) * static_cast<float>(wc);
  }
  /// How far a place of the ground has faded into the background.
  float faded(std::size_t i, int x, int y) const {
    const Point3 d = view_.position(x + 0.5, y + 0.5, samples_.nearness[i]) - centre_;
    const double distance = std::sqrt(d.x * d.x + d.y * d.y) / radius_ - options_.ground_fade;
    const double share = std::clamp(distance / (0.6 * options_.ground_fade), 0.0, 1.0);
    return static_cast<float>(share * share * (3 - 2 * share));
  }

  const Scene& scene_;
  const View& view_;
  const Samples& samples_;
  const RenderOptions& options_;
  Tones tones_;
  Light light_;
  Edges edges_;
  Rgb background_;
  Scene::Vector sun_;
  Point3 centre_;
  double radius_ = 1;
};

}  // namespace

Image render(const Scene& scene, const Camera& camera, const RenderOptions& options, const Scene* occluders) {
  const auto check = [](int value, int most, const char* what) {
    if (value < 1 || value > most) throw std::invalid_argument(std::string("picture: ") + what + " out of range");
  };
  check(options.width, 8192, "width");
  check(options.height, 8192, "height");
  check(options.supersampling, 4, "supersampling");
  check(options.sky_directions, 1024, "sky_directions");
  check(options.shadow_map, 16384, "shadow_map");
  check(options.sky_map, 16384, "sky_map");

  const int ss = options.supersampling;
  const View view(camera, scene.origin(), options.width * ss, options.height * ss);
  const Samples samples = see(scene, view);
  const Shader shader(scene, view, samples, options, occluders ? *occluders : scene);

  Image image{options.width, options.height, {}};
  image.rgb.resize(static_cast<std::size_t>(options.width) * static_cast<std::size_t>(options.height) * 3);
  std::vector<Rgb> row(static_cast<std::size_t>(options.width));
  const float share = 1.0f / static_cast<float>(ss * ss);
  for (int y = 0; y < options.height; ++y) {
    std::fill(row.begin(), row.end(), Rgb{});
    for (int j = 0; j < ss; ++j)
      for (int x = 0; x < options.width; ++x)
        for (int i = 0; i < ss; ++i) {
          Rgb& sum = row[static_cast<std::size_t>(x)];
          sum = sum + shader.shade(x * ss + i, y * ss + j);
        }
    for (int x = 0; x < options.width; ++x) {
      const Rgb mean = row[static_cast<std::size_t>(x)] * share;
      std::uint8_t* out = &image.rgb[(static_cast<std::size_t>(y) * static_cast<std::size_t>(options.width) +
                                      static_cast<std::size_t>(x)) *
                                     3];
      out[0] = shader.encoded(mean.r);
      out[1] = shader.encoded(mean.g);
      out[2] = shader.encoded(mean.b);
    }
  }
  return image;
}

}  // namespace blockrand::picture
