// Roofs over faces (docs/rule_language.md §2.2).
#include <algorithm>
#include <cmath>

#include "pipeline/base/portable_math.h"
#include "styles/grammar/shapes/mesh_cut.h"
#include "styles/grammar/shapes/operation_list.h"
#include "styles/grammar/shapes/plan_skeleton.h"

namespace blockrand::grammar {

namespace {

constexpr double kJoin = 1e-5;  ///< m: points of a skeleton and corners on one edge agree to less

struct RoofMeasure {
  bool by_height = false;
  double value = 0;
  double slope() const { return base::tan(std::clamp(value, -89.9, 89.9) * base::kRadiansPerDegree); }
};

/// Reads `angle` or `byAngle|byHeight, value`; `next` is the argument after it.
tl::expected<RoofMeasure, std::string> measure_of(Arguments arguments, std::size_t& next) {
  RoofMeasure out;
  next = 1;
  if (is_word(arguments, 0)) {
    out.by_height = word(arguments, 0) == "byHeight";
    if (!out.by_height && word(arguments, 0) != "byAngle")
      return failure(unknown_word(word(arguments, 0), "byAngle, byHeight"));
    next = 2;
  }
  if (!is_number(arguments, next - 1)) return failure("the angle or height must be a number");
  out.value = number(arguments, next - 1);
  if (auto ok = wants_numbers(arguments, next); !ok) return failure(ok.error());
  return out;
}

/// Collects the faces of a roof in the coordinates of the old mesh.
class RoofBuilder {
 public:
  explicit RoofBuilder(const Mesh& old) : old_(old) { mesh_.tag_sets = old.tag_sets; }

  std::uint32_t vertex(Vector3 p) {
    mesh_.vertices.push_back(p);
    return static_cast<std::uint32_t>(mesh_.vertices.size() - 1);
  }
  void add(const MeshFace& source, std::vector<std::vector<std::uint32_t>> loops, std::string_view tag,
           std::uint16_t edge_tags = 0) {
    MeshFace face;
    face.material = source.material;
    face.tags = add_tag(mesh_, tag == "roof.bottom" ? source.tags : std::uint16_t{0}, tag);
    for (auto& ring : loops) {
      face.loops.emplace_back();
      for (const std::uint32_t v : ring) face.loops.back().push_back({v, 0});
    }
    if (!face.loops.empty() && !face.loops[0].empty()) face.loops[0][0].edge_tags = edge_tags;
    mesh_.faces.push_back(std::move(face));
  }
  /// The old face, looking the other way.
  void bottom(std::size_t f, const std::vector<std::uint32_t>& corners) {
    MeshFace face = old_.faces[f];
    std::size_t at = 0;
    for (Loop& loop : face.loops)
      for (Corner& c : loop) c.vertex = corners[at++];
    reverse_face(face);
    face.tags = add_tag(mesh_, face.tags, "roof.bottom");
    mesh_.faces.push_back(std::move(face));
  }
  Mesh& mesh() { return mesh_; }

  void finish(Shape& shape, bool downwards) {
    if (mesh_.faces.empty()) return;
    weld(mesh_, 1e-7);
    if (!is_closed(mesh_)) join_borders(mesh_, kJoin);
    const Vector3 normal = face_normal(old_, old_.faces[0]);
    shape.size = {0, downwards ? -1.0 : 0.0, 0};
    Mesh mesh = std::move(mesh_);
    take_mesh_in_frame(shape, std::move(mesh), frame_with_y({}, normal, {1, 0, 0}));
  }

 private:
  const Mesh& old_;
  Mesh mesh_;
};

/// Which edges become gables: ends of ridges, that is faces of three corners in the hip roof, no two side by side;
/// short ones first, of equal ones the later, so that on a square the ridge runs along the first edge.
std::vector<bool> automatic_gables(const FlatFace& flat, const SweptPlan& hip) {
  const auto edges = edges_of(flat);
  std::vector<bool> gable(edges.size(), false);
  struct Candidate {
    std::int64_t length;
    std::int32_t edge;
  };
  std::vector<Candidate> candidates;
  for (const SweptFace& face : hip.faces) {
    if (face.edge < 0 || face.loops.size() != 1 || face.loops[0].size() != 3) continue;
    const Vector3 a = hip.points[edges[static_cast<std::size_t>(face.edge)].first];
    const Vector3 b = hip.points[edges[static_cast<std::size_t>(face.edge)].second];
    constexpr double kSameLength = 100;  // steps per metre: houses are not built more exactly
    candidates.push_back({std::llround(length(b - a) * kSameLength), face.edge});
  }
  std::sort(candidates.begin(), candidates.end(), [](const Candidate& a, const Candidate& b) {
    return a.length != b.length ? a.length < b.length : a.edge > b.edge;
  });
  for (const Candidate& c : candidates) {
    const auto e = static_cast<std::uint32_t>(c.edge);
    bool beside = false;
    for (std::uint32_t k = 0; k < edges.size(); ++k)
      if (gable[k] && (edges[k].second == edges[e].first || edges[k].first == edges[e].second)) beside = true;
    if (!beside) gable[e] = true;
  }
  return gable;
}

/// Edges more across than along the direction of edge `index`.
std::vector<bool> gables_across(const FlatFace& flat, std::size_t index) {
  const auto edges = edges_of(flat);
  const auto& ring = flat.polygon.outer.points;
  const auto way = [&](std::size_t e) {
    const auto a = ring[edges[e].first], b = ring[edges[e].second];
    const double n = std::sqrt((b.x - a.x) * (b.x - a.x) + (b.y - a.y) * (b.y - a.y));
    return Vector2{(b.x - a.x) / n, (b.y - a.y) / n};
  };
  const Vector2 ridge = way(index);
  std::vector<bool> out(edges.size(), false);
  for (std::size_t e = 0; e < edges.size() && e < ring.size(); ++e) {
    const Vector2 w = way(e);
    out[e] = std::fabs(w.x * ridge.x + w.y * ridge.y) < 0.70710678118654752440;
  }
  return out;
}

struct SkeletonRoof {
  RoofMeasure measure;
  bool gabled = false, even = false;
  double across = 0, along = 0;      ///< overhangs
  std::optional<double> ridge_edge;  ///< gable: index of the edge that the ridge follows
};

bool convex(const FlatFace& flat) {
  if (!flat.polygon.holes.empty()) return false;
  const auto& ring = flat.polygon.outer.points;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const auto a = ring[i], b = ring[(i + 1) % ring.size()], c = ring[(i + 2) % ring.size()];
    if ((b.x - a.x) * (c.y - b.y) - (b.y - a.y) * (c.x - b.x) < 0) return false;
  }
  return true;
}

void build_skeleton_roof(Shape& shape, const SkeletonRoof& roof) {
  const Mesh& old = mesh_of(shape);
  RoofBuilder builder(old);
  bool downwards = false;
  for (std::size_t f = 0; f < old.faces.size(); ++f) {
    const auto flat = flat_face(old, f);
    if (!flat) continue;
    const std::size_t corners = flat->corners.size();
    // In unit slopes: all planes are alike, so heights scale.
    std::vector<double> slopes(corners, 1.0);
    auto plan = sweep_plan(*flat, slopes);
    if (!plan || plan->height() <= 0) continue;
    std::vector<bool> gable(corners, false);
    if (roof.gabled) {
      const auto n = static_cast<double>(flat->polygon.outer.points.size());
      if (roof.ridge_edge && convex(*flat)) {
        const double turned = std::fmod(std::floor(*roof.ridge_edge), n);
        gable = gables_across(*flat, static_cast<std::size_t>(turned < 0 ? turned + n : turned));
      } else {
        gable = automatic_gables(*flat, *plan);
      }
      for (std::size_t i = 0; i < corners; ++i)
        if (gable[i]) slopes[i] = geometry::kUpright;
      if (auto gabled = sweep_plan(*flat, slopes); gabled && gabled->height() > 0)
        plan = std::move(gabled);
      else
        std::fill(gable.begin(), gable.end(), false), std::fill(slopes.begin(), slopes.end(), 1.0);
    }
    const double rise = roof.measure.by_height ? roof.measure.value / plan->height() : roof.measure.slope();
    if (rise == 0) continue;
    downwards = rise < 0;
    std::vector<std::uint32_t> corner_vertices;
    for (std::size_t i = 0; i < corners; ++i)
      corner_vertices.push_back(builder.vertex(old.vertices[flat->vertices[i]]));
    const MeshFace& source = old.faces[f];
    const auto place_faces = [&](const FlatFace& base, const SweptPlan& swept, double drop, bool slopes_too,
                                 bool gables_too) {
      double mean = 0;
      int count = 0;
      double top = swept.height();
      if (roof.even && !roof.ridge_edge) {
        for (std::size_t i = corners; i < swept.points.size(); ++i) mean += swept.points[i].z, ++count;
        top = count > 0 ? mean / count : top;
      }
      std::vector<std::uint32_t> ids(swept.points.size());
      for (std::size_t i = 0; i < swept.points.size(); ++i) {
        Vector3 p = swept.points[i];
        if (i >= corners && roof.even && count > 0) p.z = top;
        p.z = p.z * rise - drop;
        ids[i] =
            i < corners && drop == 0 && &base == &*flat ? corner_vertices[i] : builder.vertex(place(base.plane, p));
      }
      for (const SweptFace& face : swept.faces) {
        if (face.upright ? !gables_too : !slopes_too) continue;
        auto loops = face.loops;
        for (auto& loop : loops)
          for (auto& v : loop) v = ids[v];
        if (rise < 0)
          for (auto& loop : loops) std::reverse(loop.begin() + 1, loop.end());
        const std::uint16_t tags =
            face.edge >= 0 ? flat->corners[static_cast<std::size_t>(face.edge)].edge_tags : std::uint16_t{0};
        builder.add(source, std::move(loops), face.upright ? "roof.side" : "roof.top",
                    rise < 0 ? std::uint16_t{0} : tags);
      }
    };
    std::optional<FlatFace> wider;
    double drop = 0;
    if (roof.across != 0 || (roof.gabled && roof.along != 0)) {
      // The overhang is measured on the slope; over gables it is level.
      const double cosine = 1 / std::sqrt(1 + rise * rise);
      std::vector<double> distances(corners);
      for (std::size_t i = 0; i < corners; ++i) distances[i] = gable[i] ? roof.along : roof.across * cosine;
      wider = expanded(*flat, distances);
      drop = roof.across * cosine * rise;
    }
    std::optional<SweptPlan> wide_plan;
    if (wider) wide_plan = sweep_plan(*wider, slopes);
    if (rise > 0)
      builder.bottom(f, corner_vertices);
    else {
      MeshFace top = source;
      std::size_t at = 0;
      for (Loop& loop : top.loops)
        for (Corner& c : loop) c.vertex = corner_vertices[at++];
      top.tags = add_tag(builder.mesh(), top.tags, "roof.bottom");
      builder.mesh().faces.push_back(std::move(top));
    }
    place_faces(*flat, *plan, 0, !wide_plan, true);
    if (wide_plan) place_faces(*wider, *wide_plan, drop, true, false);
  }
  builder.finish(shape, downwards);
}

/// A solid between the face and its vertices raised by `heights` (by corner, all of one sign): sheds and ridges.
void raise_corners(RoofBuilder& builder, const Mesh& old, std::size_t f, const FlatFace& flat,
                   const std::vector<double>& heights, std::size_t first_edge) {
  const MeshFace& source = old.faces[f];
  bool down = false;
  for (const double h : heights) down |= h < 0;
  std::vector<std::uint32_t> low, high;
  for (std::size_t i = 0; i < heights.size(); ++i) {
    const Vector3 p = old.vertices[flat.vertices[i]];
    low.push_back(builder.vertex(p));
    high.push_back(std::fabs(heights[i]) < 1e-9 ? low.back() : builder.vertex(p + flat.plane.axes[2] * heights[i]));
  }
  const std::size_t begin = builder.mesh().faces.size();
  builder.bottom(f, low);
  std::vector<std::vector<std::uint32_t>> tops;
  const auto edges = edges_of(flat);
  std::size_t at = 0;
  for (const Loop& loop : source.loops) {
    tops.emplace_back(high.begin() + static_cast<std::ptrdiff_t>(at),
                      high.begin() + static_cast<std::ptrdiff_t>(at + loop.size()));
    at += loop.size();
  }
  std::rotate(tops[0].begin(), tops[0].begin() + static_cast<std::ptrdiff_t>(first_edge % tops[0].size()),
              tops[0].end());
  builder.add(source, std::move(tops), "roof.top");
  for (std::size_t e = 0; e < edges.size(); ++e) {
    const auto [a, b] = edges[e];
    std::vector<std::uint32_t> ring{low[a], low[b]};
    if (high[b] != low[b]) ring.push_back(high[b]);
    if (high[a] != low[a]) ring.push_back(high[a]);
    if (ring.size() >= 3)
      builder.add(source, {std::move(ring)}, e < source.loops[0].size() ? "roof.side.outer" : "roof.side.inner",
                  flat.corners[a].edge_tags);
  }
  if (down)
    for (std::size_t i = begin; i < builder.mesh().faces.size(); ++i) reverse_face(builder.mesh().faces[i]);
}

}  // namespace

Result run_roof_hip(Shape& shape, const OperationInput&, Arguments arguments) {
  std::size_t next = 0;
  const auto measure = measure_of(arguments, next);
  if (!measure) return failure(measure.error());
  SkeletonRoof roof{*measure, false, number(arguments, next + 1) != 0, number(arguments, next), 0, {}};
  build_skeleton_roof(shape, roof);
  return {};
}

Result run_roof_gable(Shape& shape, const OperationInput&, Arguments arguments) {
  std::size_t next = 0;
  const auto measure = measure_of(arguments, next);
  if (!measure) return failure(measure.error());
  SkeletonRoof roof{
      *measure, true, number(arguments, next + 2) != 0, number(arguments, next), number(arguments, next + 1), {}};
  if (next + 3 < arguments.size()) roof.ridge_edge = number(arguments, next + 3);
  if (roof.ridge_edge) roof.even = false;
  build_skeleton_roof(shape, roof);
  return {};
}

Result run_roof_shed(Shape& shape, const OperationInput&, Arguments arguments) {
  std::size_t next = 0;
  const auto measure = measure_of(arguments, next);
  if (!measure) return failure(measure.error());
  const Mesh& old = mesh_of(shape);
  RoofBuilder builder(old);
  bool downwards = false;
  for (std::size_t f = 0; f < old.faces.size(); ++f) {
    const auto flat = flat_face(old, f);
    if (!flat) continue;
    const auto n = static_cast<double>(flat->polygon.outer.points.size());
    const double turned = std::fmod(std::floor(number(arguments, next)), n);
    const auto edge = static_cast<std::size_t>(turned < 0 ? turned + n : turned);
    const Vector3 a = old.vertices[flat->vertices[edge]];
    const Vector3 b = old.vertices[flat->vertices[(edge + 1) % flat->polygon.outer.points.size()]];
    const Vector3 inwards = normalized(cross(flat->plane.axes[2], b - a));
    std::vector<double> heights;
    double least = 0, most = 0;
    for (const std::uint32_t v : flat->vertices) {
      heights.push_back(dot(inwards, old.vertices[v] - a));
      least = std::min(least, heights.back());
      most = std::max(most, heights.back());
    }
    if (!(most - least > 0)) continue;
    const double rise = measure->by_height ? measure->value / (most - least) : measure->slope();
    if (rise == 0) continue;
    downwards = rise < 0;
    for (double& h : heights) h = std::fabs(h - least) < 1e-9 ? 0 : (h - least) * rise;
    raise_corners(builder, old, f, *flat, heights, edge);
  }
  builder.finish(shape, downwards);
  return {};
}

Result run_roof_pyramid(Shape& shape, const OperationInput&, Arguments arguments) {
  std::size_t next = 0;
  const auto measure = measure_of(arguments, next);
  if (!measure) return failure(measure.error());
  const Mesh& old = mesh_of(shape);
  RoofBuilder builder(old);
  bool downwards = false;
  for (std::size_t f = 0; f < old.faces.size(); ++f) {
    const MeshFace& face = old.faces[f];
    const Vector3 normal = face_normal(old, face);
    if (normal == Vector3{}) continue;
    const Loop& outline = face.loops[0];
    const Vector3 a = old.vertices[outline[0].vertex], b = old.vertices[outline[1].vertex];
    const Vector3 middle = face_middle(old, face);
    const double run_in = dot(normalized(cross(normal, b - a)), middle - a);
    const double height = measure->by_height ? measure->value : measure->slope() * std::fabs(run_in);
    if (height == 0) continue;
    downwards = height < 0;
    std::vector<std::uint32_t> corners;
    for (const Loop& loop : face.loops)
      for (const Corner c : loop) corners.push_back(builder.vertex(old.vertices[c.vertex]));
    const std::uint32_t apex = builder.vertex(middle + normal * height);
    const std::size_t begin = builder.mesh().faces.size();
    builder.bottom(f, corners);
    std::uint32_t base = 0;
    for (const Loop& loop : face.loops) {
      const auto n = static_cast<std::uint32_t>(loop.size());
      for (std::uint32_t i = 0; i < n; ++i)
        builder.add(face, {{corners[base + i], corners[base + (i + 1) % n], apex}}, "roof.top", loop[i].edge_tags);
      base += n;
    }
    if (height < 0)
      for (std::size_t i = begin; i < builder.mesh().faces.size(); ++i) reverse_face(builder.mesh().faces[i]);
  }
  builder.finish(shape, downwards);
  return {};
}

Result run_roof_ridge(Shape& shape, const OperationInput&, Arguments arguments) {
  std::size_t next = 0;
  const auto measure = measure_of(arguments, next);
  if (!measure) return failure(measure.error());
  const Mesh& old = mesh_of(shape);
  RoofBuilder builder(old);
  bool downwards = false;
  for (std::uint32_t f = 0; f < old.faces.size(); ++f) {
    const Vector3 normal = face_normal(old, old.faces[f]);
    if (normal == Vector3{}) continue;
    // The ridge runs along the scope's x, in the middle of the face across it.
    const Frame frame = frame_with_y({}, normal, {1, 0, 0});
    double low = 1e300, high = -1e300;
    for (const Loop& loop : old.faces[f].loops)
      for (const Corner c : loop) {
        const double z = dot(frame.axes[2], old.vertices[c.vertex]);
        low = std::min(low, z);
        high = std::max(high, z);
      }
    const double half = (high - low) / 2, ridge = (high + low) / 2;
    const double rise = measure->by_height ? measure->value / half : measure->slope();
    if (!(half > 0) || rise == 0 || !std::isfinite(rise)) continue;
    downwards = rise < 0;
    const auto across = [&](Vector3 p) { return dot(frame.axes[2], p) - ridge; };
    const auto raised = [&](Vector3 p) {
      const double h = (half - std::fabs(across(p))) * rise;
      return std::fabs(h) < 1e-9 ? p : p + normal * h;
    };
    const MeshFace& source = old.faces[f];
    const std::size_t begin = builder.mesh().faces.size();
    std::vector<std::uint32_t> lows;
    for (const Loop& loop : source.loops)
      for (const Corner c : loop) lows.push_back(builder.vertex(old.vertices[c.vertex]));
    builder.bottom(f, lows);
    // Each half of the face rises as one plane. What belongs together is joined by place, in finish().
    Mesh face = extract_faces(old, std::span(&f, 1));
    for (UvSet& set : face.uv) set.clear();
    for (const double side : {1.0, -1.0}) {
      Mesh part = face;
      cut_mesh(part, {frame.axes[2] * side, ridge * side}, false);
      for (const MeshFace& piece : part.faces) {
        std::vector<std::vector<std::uint32_t>> loops;
        for (const Loop& loop : piece.loops) {
          loops.emplace_back();
          for (const Corner c : loop) loops.back().push_back(builder.vertex(raised(part.vertices[c.vertex])));
        }
        builder.add(source, std::move(loops), "roof.top");
      }
    }
    for (const Loop& loop : source.loops)
      for (std::size_t i = 0; i < loop.size(); ++i) {
        const Vector3 a = old.vertices[loop[i].vertex], b = old.vertices[loop[(i + 1) % loop.size()].vertex];
        std::vector<Vector3> ring{a, b};
        if (raised(b) != b) ring.push_back(raised(b));
        if (across(a) * across(b) < 0) {
          const Vector3 top = a + (b - a) * (across(a) / (across(a) - across(b)));
          ring.push_back(raised(top));
        }
        if (raised(a) != a) ring.push_back(raised(a));
        if (ring.size() < 3) continue;
        std::vector<std::uint32_t> ids;
        for (const Vector3 p : ring) ids.push_back(builder.vertex(p));
        builder.add(source, {std::move(ids)}, "roof.side", loop[i].edge_tags);
      }
    if (rise < 0)
      for (std::size_t i = begin; i < builder.mesh().faces.size(); ++i) reverse_face(builder.mesh().faces[i]);
  }
  builder.finish(shape, downwards);
  return {};
}

}  // namespace blockrand::grammar
