#include "pipeline/outputs/gltf/surface_textures.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <utility>

#include "pipeline/model/building.h"
#include "pipeline/model/vector.h"
#include "pipeline/outputs/gltf/linear_light.h"

namespace blockrand::outputs {
namespace {

using model::Point2;
using model::Point3;
using textures::Surface;

/// Normals in 1/127. Steeper than 80 degrees a face is a wall; below the horizon it is seen by nobody.
constexpr int kWallNormal = 22;
/// Flatter than 2 degrees a roof has no slope that its rows could follow.
constexpr double kFlatNormal = 0.9994;
/// Directions that differ by less than 8 degrees are parallel: a wall and the edge of the outline that it stands on.
constexpr double kParallel = 0.99;
/// m. A wall farther from every parallel edge is none of the outline, as that of a dormer: its courses start by themselves.
constexpr double kBeside = 3;
/// Texture coordinates of 16 bits reach so many repeats: of one of 2.5 m 160 m in steps of 2.5 mm, and for what is longer
/// ten times as far.
constexpr double kReach = 64, kFarReach = 640;
/// Whole repeats by which ground is counted from the origin of the CRS: neighbours mostly share their vertices then.
constexpr double kGroundBlock = 8;

double dot(const Point2& a, double x, double y) { return a.x * x + a.y * y; }

/// In 1/127: a direction as it lies in a face.
std::array<std::int8_t, 3> tangent_of(const Point3& along, const Point3& normal) {
  const double off = model::dot(along, normal);
  const Point3 t{along.x - off * normal.x, along.y - off * normal.y, along.z - off * normal.z};
  const double length = model::length(t);
  const auto byte = [&](double v) { return static_cast<std::int8_t>(std::lround(v / length * 127)); };
  return {byte(t.x), byte(t.y), byte(t.z)};
}

/// Faces of a primitive: vertices that triangles join.
std::vector<std::uint32_t> faces_of(const MeshPrimitive& p) {
  std::vector<std::uint32_t> face(p.vertices.size());
  std::iota(face.begin(), face.end(), 0u);
  const auto root = [&](std::uint32_t v) {
    while (face[v] != v) v = face[v] = face[face[v]];
    return v;
  };
  for (std::size_t t = 0; t + 2 < p.indices.size(); t += 3)
    for (std::size_t k = 1; k < 3; ++k) {
      const std::uint32_t a = root(p.indices[t]), b = root(p.indices[t + k]);
      face[std::max(a, b)] = std::min(a, b);
    }
  for (std::uint32_t v = 0; v < face.size(); ++v) face[v] = root(v);
  return face;
}

/// Cosine and sine of the direction along which the ground of a vertex is laid.
std::array<double, 2> course_of(const Mesh& mesh, const MeshVertex& vertex) {
  return vertex.feature < mesh.courses.size() ? mesh.courses[vertex.feature] : std::array<double, 2>{1, 0};
}

/// Repeats of a texture of the ground, from the origin of the build CRS.
std::array<double, 2> on_ground(const Mesh& mesh, const MeshVertex& vertex, const textures::TextureRow& texture) {
  const auto [cosine, sine] = course_of(mesh, vertex);
  const model::Point2& p = mesh.plan[vertex.position];
  return {(cosine * p.x + sine * p.y) / texture.width, (cosine * p.y - sine * p.x) / texture.height};
}

}  // namespace

/// How a texture lies on a face: two directions and where they count from, in repeats.
struct SurfaceTextures::Layout {
  Point3 right, up;  ///< repeats a metre
  double right_from = 0, up_from = 0;
  std::array<double, 2> at(const Point3& p) const {
    return {right.x * p.x + right.y * p.y + right.z * p.z + right_from, up.x * p.x + up.y * p.y + up.z * p.z + up_from};
  }
};

std::vector<CourseOutline> course_outlines(const model::Region& region, const Frame& frame) {
  std::vector<CourseOutline> out;
  std::vector<Point3> source;
  for (const model::Building& building : region.buildings) {
    if (!building.owned) continue;
    for (const model::BuildingPart& part : building.parts) {
      for (const Point2& p : part.plan.outer.points) source.push_back({p.x, p.y, part.attributes.ground_height.value});
      out.emplace_back().points.resize(part.plan.outer.points.size());
    }
  }
  std::vector<Point3> local = source;
  if (frame.to_enu) frame.to_enu(source, local);
  auto next = local.begin();
  for (CourseOutline& o : out) {
    if (o.points.empty()) continue;
    o.ground = next->z;
    for (Point2& p : o.points) p = (next++)->xy();
    o.along.push_back(0);
    for (std::size_t i = 0; i < o.points.size(); ++i) {
      const Point2 &a = o.points[i], &b = o.points[(i + 1) % o.points.size()];
      o.along.push_back(o.along.back() + std::hypot(b.x - a.x, b.y - a.y));
    }
  }
  return out;
}

SurfaceTextures::SurfaceTextures(const TextureSet& set, Of of, std::span<const model::MaterialClass> classes,
                                 std::span<const CourseOutline> outlines, std::string folder)
    : set_(set), of_(of), classes_(classes), outlines_(outlines), folder_(std::move(folder)) {
  for (const model::MaterialClass& c : classes)
    rows_.push_back(
        {set.find(Surface::wall, c.name), set.find(Surface::roof, c.name), set.find(Surface::ground, c.name)});
}

int SurfaceTextures::row_of(const MeshVertex& vertex) const {
  const std::array<int, 3>& rows = rows_.at(vertex.look.material);
  const int up = vertex.normal[2];
  if (of_ == Of::ground) return up > 63 ? rows[static_cast<std::size_t>(Surface::ground)] : -1;
  if (up < -kWallNormal) return -1;
  return rows[static_cast<std::size_t>(up > kWallNormal ? Surface::roof : Surface::wall)];
}

SurfaceTextures::Layout SurfaceTextures::layout_of(int row, const MeshVertex& vertex, const Point3& n,
                                                   const Point3& middle) const {
  const textures::TextureRow& texture = set_.row(row);
  const double per_width = 1 / texture.width, per_height = 1 / texture.height;
  static const CourseOutline kNone;
  const CourseOutline& outline = vertex.feature < outlines_.size() ? outlines_[vertex.feature] : kNone;
  const std::size_t edges = outline.points.size();
  const auto edge = [&](std::size_t i) {
    const Point2 &a = outline.points[i], &b = outline.points[(i + 1) % edges];
    const double length = outline.along[i + 1] - outline.along[i];
    return length > 0 ? Point2{(b.x - a.x) / length, (b.y - a.y) / length} : Point2{0, 0};
  };
  Layout out;
  if (n.z > kFlatNormal) {
    Point2 d{1, 0};
    double longest = 0;
    for (std::size_t i = 0; i < edges; ++i)
      if (outline.along[i + 1] - outline.along[i] > longest) {
        longest = outline.along[i + 1] - outline.along[i];
        d = edge(i);
      }
    out.right = {d.x * per_width, d.y * per_width, 0};
    out.up = {-d.y * per_height, d.x * per_height, 0};
    return out;
  }
  const double flat = std::hypot(n.x, n.y);
  const Point2 d{-n.y / flat, n.x / flat};  // to the right as seen from outside
  out.right = {d.x * per_width, d.y * per_width, 0};
  if (vertex.normal[2] > kWallNormal) {
    out.up = {-n.z * d.y * per_height, n.z * d.x * per_height, flat * per_height};
    return out;
  }
  out.up = {0, 0, per_height};
  out.up_from = -outline.ground * per_height;
  // The nearest edge that this wall runs along.
  double nearest = kBeside;
  for (std::size_t i = 0; i < edges; ++i) {
    const Point2 e = edge(i), &a = outline.points[i];
    if (dot(d, e.x, e.y) < kParallel) continue;
    const double t = dot(e, middle.x - a.x, middle.y - a.y), length = outline.along[i + 1] - outline.along[i];
    const double beyond = std::max({0.0, -t, t - length});
    const double distance = std::hypot(-e.y * (middle.x - a.x) + e.x * (middle.y - a.y), beyond);
    if (!(distance < nearest)) continue;
    nearest = distance;
    // Whole stones around the building.
    const double stone = texture.stone_width > 0 ? texture.stone_width : texture.width;
    const double whole = outline.along.back(), stones = std::nearbyint(whole / stone);
    const double stretch = stones >= 1 ? stones * stone / whole : 1;
    const double scale = stretch * per_width;
    out.right = {d.x * scale, d.y * scale, 0};
    out.right_from = (outline.along[i] - dot(d, a.x, a.y)) * scale;
  }
  return out;
}

std::vector<MeshPrimitive> SurfaceTextures::split(const MeshPrimitive& all, const Mesh& mesh) {
  struct Face {
    double area = 0;  ///< of its largest triangle, twice
    Point3 normal;
    std::size_t triangles = 0;
    int row = -1;
    bool far = false;
    Layout layout;
    std::array<double, 2> low{}, high{};
  };
  const std::vector<std::uint32_t> face_of = faces_of(all);
  std::vector<Face> faces(all.vertices.size());
  const auto position = [&](std::uint32_t v) -> const Point3& { return mesh.positions[all.vertices[v].position]; };
  for (std::size_t t = 0; t + 2 < all.indices.size(); t += 3) {
    const Point3 &a = position(all.indices[t]), &b = position(all.indices[t + 1]), &c = position(all.indices[t + 2]);
    const Point3 n = model::cross(b - a, c - a);
    const double area = std::sqrt(model::dot(n, n));
    Face& face = faces[face_of[all.indices[t]]];
    ++face.triangles;
    if (area > face.area) face.area = area, face.normal = {n.x / area, n.y / area, n.z / area};
  }
  // Which texture, and how it lies.
  for (std::uint32_t v = 0; v < faces.size(); ++v) {
    Face& face = faces[v];
    if (face_of[v] != v || !(face.area > 0)) continue;
    const MeshVertex& vertex = all.vertices[v];
    if (vertex.position < mesh.solid_positions) face.row = row_of(vertex);
    if (face.row < 0) continue;
    const model::Colour& c = vertex.look.colour;
    const std::array<double, 3>& mean = set_.mean(face.row);
    if (kLinearLight[c.r] > 65535 * mean[0] || kLinearLight[c.g] > 65535 * mean[1] ||
        kLinearLight[c.b] > 65535 * mean[2]) {
      face.row = -1;
      too_light_ += face.triangles;
      continue;
    }
    if (of_ == Of::ground) {
      const auto [cosine, sine] = course_of(mesh, vertex);
      face.layout.right = {cosine, sine, 0};
    } else {
      face.layout = layout_of(face.row, vertex, face.normal, position(v));
    }
    face.low = {std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
    face.high = {-face.low[0], -face.low[1]};
  }
  std::vector<std::array<double, 2>> repeats(all.vertices.size());
  for (std::uint32_t v = 0; v < all.vertices.size(); ++v) {
    Face& face = faces[face_of[v]];
    if (face.row < 0) continue;
    const textures::TextureRow& texture = set_.row(face.row);
    const std::uint32_t at = all.vertices[v].position;
    repeats[v] = of_ == Of::ground ? on_ground(mesh, all.vertices[v], texture) : face.layout.at(mesh.positions[at]);
    for (std::size_t k = 0; k < 2; ++k) {
      face.low[k] = std::min(face.low[k], repeats[v][k]);
      face.high[k] = std::max(face.high[k], repeats[v][k]);
    }
  }
  const double block = of_ == Of::ground ? kGroundBlock : 1;
  for (std::uint32_t v = 0; v < faces.size(); ++v) {
    Face& face = faces[v];
    if (face_of[v] != v || face.row < 0) continue;
    // Rows of a roof begin at its lowest point; else whole repeats change nothing.
    const bool roof = of_ == Of::buildings && all.vertices[v].normal[2] > kWallNormal;
    double reach = 0;
    for (std::size_t k = 0; k < 2; ++k) {
      if (!roof || k == 0) face.low[k] = std::floor(face.low[k] / block) * block;
      reach = std::max(reach, face.high[k] - face.low[k]);
    }
    face.far = reach > kReach - 1;
    if (reach > kFarReach - 1) face.row = -1;
  }
  // A primitive for each texture, class and reach.
  std::map<std::array<int, 3>, std::size_t> known;
  std::vector<MeshPrimitive> out(1);
  out[0].look = all.look;
  std::vector<std::uint32_t> number(all.vertices.size(), ~0u);
  for (const std::uint16_t v : all.indices) {
    const Face& face = faces[face_of[v]];
    std::size_t to = 0;
    if (face.row >= 0) {
      const auto [place, added] =
          known.try_emplace({face.row, all.vertices[v].look.material, face.far ? 1 : 0}, out.size());
      to = place->second;
      if (added) {
        out.emplace_back().look = all.vertices[v].look;
        out.back().texture = face.row;
        out.back().reach = static_cast<float>(face.far ? kFarReach : kReach);
        used_.insert(set_.row(face.row).name);
      }
    }
    MeshPrimitive& primitive = out[to];
    if (number[v] == ~0u) {
      number[v] = static_cast<std::uint32_t>(primitive.vertices.size());
      primitive.vertices.push_back(all.vertices[v]);
      // glTF counts from the top of a picture, whose lower border is the ground: one repeat above it is 0.
      if (face.row >= 0) {
        primitive.repeats.push_back(
            {static_cast<float>(repeats[v][0] - face.low[0]),
             static_cast<float>(std::ceil(face.high[1] - face.low[1]) - (repeats[v][1] - face.low[1]))});
        primitive.tangents.push_back(tangent_of(face.layout.right, face.normal));
      }
    }
    primitive.indices.push_back(static_cast<std::uint16_t>(number[v]));
  }
  return out;
}

int SurfaceTextures::material(GlbDocument& document, const MeshPrimitive& primitive) const {
  return set_.add_material(document, primitive.texture, classes_[primitive.look.material].name, folder_,
                           static_cast<double>(primitive.reach), std::nullopt);
}

int SurfaceTextures::material(GlbDocument& document, const MeshPrimitive& primitive,
                              const model::Colour& colour) const {
  const std::array<double, 3>& mean = set_.mean(primitive.texture);
  const std::array<std::uint8_t, 3> parts = {colour.r, colour.g, colour.b};
  std::array<double, 3> tint{};
  // Five decimals, as those of plain materials.
  for (std::size_t k = 0; k < 3; ++k)
    tint[k] = std::min(1.0, std::nearbyint(kLinearLight[parts[k]] / mean[k] / 0.65535) / 1e5);
  return set_.add_material(document, primitive.texture,
                           classes_[primitive.look.material].name + " " + model::text(colour), folder_, 1, tint);
}

}  // namespace blockrand::outputs
