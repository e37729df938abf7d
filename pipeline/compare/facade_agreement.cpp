#include "pipeline/compare/facade_agreement.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <tuple>

#include "pipeline/base/portable_math.h"
#include "pipeline/compare/facade_planes.h"
#include "pipeline/compare/opening_grid.h"
#include "pipeline/compare/union_area.h"
#include "pipeline/model/vector.h"

namespace blockrand::compare {
namespace {

constexpr double kReveal = 0.6;  // m behind the walls: deep reveals and doors in niches
constexpr double kBay = 1.5;     // m before the plane: bays that are too narrow for a facade of their own
constexpr double kMargin = 0.3;  // m beyond the facade's extent: frames before its edge
constexpr double kFacing = 0.5;  // cosine: polygons of an opening that are steeper to the facade are sides of reveals
constexpr double kSameOpening = 0.9;  // IoU
constexpr double kInfinite = std::numeric_limits<double>::infinity();

long long rounded(double v) { return std::llround(v * 1e6); }

/// An opening of a building, before it is known which facade it is in.
struct LooseOpening {
  std::uint32_t building = 0, opening = 0;
  std::vector<Flat> flats;  // one for each polygon
  std::size_t largest = 0;  // index into flats
};

/// What of an opening a facade sees.
struct View {
  double left = kInfinite, right = -kInfinite, bottom = kInfinite, top = -kInfinite,
         across = 0;  // along, z, from plane
  std::vector<FlatPolygon> polygons;
};

FlatPolygon project(const Rings3& rings, const WallGroup& group) {
  const Point2 along = group.along();
  FlatPolygon out;
  for (const auto& ring : rings) {
    auto& points = out.emplace_back();
    points.reserve(ring.size());
    for (const Point3& p : ring) points.push_back({dot(along, p.xy()) - group.left, p.z});
  }
  return out;
}

View view_of(const LooseOpening& opening, const City& city, const WallGroup& group) {
  View view;
  double near = kInfinite, far = -kInfinite;
  const auto& polygons = city.buildings[opening.building].openings[opening.opening].polygons;
  for (std::size_t i = 0; i < polygons.size(); ++i) {
    const Flat& flat = opening.flats[i];
    if (flat.area == 0 || std::fabs(dot(flat.normal.xy(), group.normal)) < kFacing) continue;
    view.polygons.push_back(project(polygons[i], group));
    const Box box = box_of(view.polygons.back());
    view.left = std::min(view.left, box.left);
    view.right = std::max(view.right, box.right);
    view.bottom = std::min(view.bottom, box.bottom);
    view.top = std::max(view.top, box.top);
    const double across = dot(group.normal, flat.centre.xy()) - group.offset;
    near = std::min(near, across);
    far = std::max(far, across);
  }
  view.across = 0.5 * (near + far);
  return view;
}

/// A facade in the making.
struct Draft {
  WallGroup group;
  std::vector<LooseOpening> openings;
};

/// Index of the draft that the opening belongs to; drafts.size() for none.
std::size_t facade_for(const LooseOpening& opening, const City& city, const std::vector<Draft>& drafts,
                       const FacadeOptions& options) {
  std::size_t best = drafts.size();
  if (opening.flats.empty()) return best;
  const Point3 normal = opening.flats[opening.largest].normal;
  if (opening.flats[opening.largest].area == 0 || std::fabs(normal.z) > base::sin(options.max_tilt)) return best;
  const double least = base::cos(options.pair_angle);
  double nearest = kInfinite;
  for (std::size_t d = 0; d < drafts.size(); ++d) {
    const WallGroup& group = drafts[d].group;
    if (std::fabs(dot(normal.xy(), group.normal)) < least) continue;
    const Point3 middle = opening.flats[opening.largest].centre;
    const double roughly = dot(group.normal, middle.xy()) - group.offset;
    if (std::fabs(roughly) > nearest + 5) continue;
    const View view = view_of(opening, city, group);
    const double x = 0.5 * (view.left + view.right), z = 0.5 * (view.bottom + view.top);
    if (x < -kMargin || x > group.right - group.left + kMargin || z < group.bottom - kMargin || z > group.top + kMargin)
      continue;
    if (view.across > kBay || view.across < -(options.plane_distance + kReveal)) continue;
    if (std::fabs(view.across) < nearest - 1e-6) {
      nearest = std::fabs(view.across);
      best = d;
    }
  }
  return best;
}

double rectangle_iou(const FacadeOpening& a, const FacadeOpening& b) {
  const double width = std::min(a.right, b.right) - std::max(a.left, b.left);
  const double height = std::min(a.top, b.top) - std::max(a.bottom, b.bottom);
  if (width <= 0 || height <= 0) return 0;
  const double both = width * height;
  return both / ((a.right - a.left) * (a.top - a.bottom) + (b.right - b.left) * (b.top - b.bottom) - both);
}

/// Takes openings that are drawn twice as one.
/// \return for each that stays its index into `seen`
std::vector<std::size_t> without_doubles(std::vector<FacadeOpening>& seen) {
  std::vector<std::size_t> order(seen.size()), kept;
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    const auto key = [&](std::size_t i) {
      return std::tuple(-rounded(seen[i].area), rounded(seen[i].left), rounded(seen[i].bottom), rounded(seen[i].right),
                        rounded(seen[i].top), seen[i].building, seen[i].opening);
    };
    return key(a) < key(b);
  });
  for (const std::size_t i : order) {
    const auto same = std::find_if(kept.begin(), kept.end(),
                                   [&](std::size_t k) { return rectangle_iou(seen[i], seen[k]) > kSameOpening; });
    if (same == kept.end()) {
      kept.push_back(i);
    } else {
      seen[*same].door = seen[*same].door || seen[i].door;
    }
  }
  return kept;
}

/// Area of walls and openings together. Each opening adds what it covers that walls and openings before it leave free.
double area_of(const std::vector<FlatPolygon>& walls, const std::vector<std::vector<FlatPolygon>>& openings) {
  double area = union_area(walls);
  std::vector<std::pair<FlatPolygon, Box>> all;
  for (const FlatPolygon& wall : walls) all.emplace_back(wall, box_of(wall));
  std::vector<FlatPolygon> near;
  for (const auto& opening : openings) {
    Box box{kInfinite, -kInfinite, kInfinite, -kInfinite};
    for (const FlatPolygon& polygon : opening) {
      const Box b = box_of(polygon);
      box = {std::min(box.left, b.left), std::max(box.right, b.right), std::min(box.bottom, b.bottom),
             std::max(box.top, b.top)};
    }
    near.clear();
    for (const auto& [polygon, b] : all)
      if (b.meets(box)) near.push_back(polygon);
    const double before = union_area(near, box);
    near.insert(near.end(), opening.begin(), opening.end());
    area += std::max(0.0, union_area(near, box) - before);
    for (const FlatPolygon& polygon : opening) all.emplace_back(polygon, box_of(polygon));
  }
  return area;
}

void add_openings(const Draft& draft, const City& city, double zero, Facade& facade,
                  std::vector<std::vector<FlatPolygon>>& polygons) {
  std::vector<FacadeOpening> seen;
  std::vector<View> views;
  for (const LooseOpening& opening : draft.openings) {
    View view = view_of(opening, city, draft.group);
    FacadeOpening o;
    o.left = view.left;
    o.right = view.right;
    o.bottom = view.bottom - zero;
    o.top = view.top - zero;
    o.area = union_area(view.polygons);
    o.door = city.buildings[opening.building].openings[opening.opening].door;
    o.building = opening.building;
    o.opening = opening.opening;
    seen.push_back(o);
    views.push_back(std::move(view));
  }
  std::vector<std::size_t> kept = without_doubles(seen);
  std::sort(kept.begin(), kept.end(), [&](std::size_t a, std::size_t b) {
    const auto key = [&](std::size_t i) {
      return std::tuple(rounded(seen[i].left), rounded(seen[i].bottom), rounded(seen[i].right), rounded(seen[i].top),
                        seen[i].building, seen[i].opening);
    };
    return key(a) < key(b);
  });
  for (const std::size_t i : kept) {
    facade.openings.push_back(seen[i]);
    polygons.push_back(std::move(views[i].polygons));
  }
}

Facade finish(const Draft& draft, const City& city, double zero, const FacadeOptions& options) {
  const WallGroup& group = draft.group;
  Facade facade;
  std::map<std::uint32_t, double> area_in;
  for (const WallPiece& piece : group.pieces) {
    facade.faces.emplace_back(piece.building, piece.face);
    area_in[piece.building] += piece.area;
  }
  double most = -1;
  for (const auto& [building, area] : area_in) {
    if (area > most + 1e-6) {
      most = area;
      facade.building = building;
    }
  }
  const Point2 along = group.along();
  const auto place = [&](double at) {
    return Point2{group.offset * group.normal.x + at * along.x, group.offset * group.normal.y + at * along.y};
  };
  facade.left = place(group.left);
  facade.right = place(group.right);
  facade.bottom = group.bottom - zero;
  facade.top = group.top - zero;

  std::vector<FlatPolygon> walls, covered;
  for (const WallPiece& piece : group.pieces) {
    const Face& face = city.buildings[piece.building].faces[piece.face];
    walls.push_back(project(face.rings, group));
    if (face.left_out == LeftOut::covered) covered.push_back(walls.back());
    Rings3& outline = facade.outline.emplace_back();
    for (const auto& ring : walls.back()) {
      auto& points = outline.emplace_back();
      for (const Point2& p : ring) points.push_back({p.x, p.y - zero, 0});
    }
  }
  std::vector<std::vector<FlatPolygon>> openings;
  add_openings(draft, city, zero, facade, openings);
  facade.area = area_of(walls, openings);
  std::vector<FlatPolygon> all_openings;
  for (const auto& polygons : openings) all_openings.insert(all_openings.end(), polygons.begin(), polygons.end());
  facade.opening_area = std::min(facade.area, union_area(all_openings));
  facade.covered = covered.empty() ? 0 : std::min(facade.area, union_area(covered));
  find_rows_and_columns(facade, options);
  return facade;
}

}  // namespace

double Facade::width() const {
  const Point2 d{right.x - left.x, right.y - left.y};
  return std::sqrt(dot(d, d));
}

std::vector<Facade> facades_of(const City& city, std::span<const std::uint32_t> buildings, double zero,
                               const FacadeOptions& options, std::size_t* loose) {
  std::vector<Draft> drafts;
  for (WallGroup& group : wall_groups(city, buildings, options)) drafts.push_back({std::move(group), {}});
  std::size_t without = 0;
  for (const std::uint32_t b : buildings) {
    for (std::size_t i = 0; i < city.buildings[b].openings.size(); ++i) {
      LooseOpening opening{b, static_cast<std::uint32_t>(i), {}, 0};
      for (const Rings3& rings : city.buildings[b].openings[i].polygons) {
        opening.flats.push_back(flat_of(rings));
        if (opening.flats.back().area > opening.flats[opening.largest].area) opening.largest = opening.flats.size() - 1;
      }
      const std::size_t at = facade_for(opening, city, drafts, options);
      if (at < drafts.size()) {
        drafts[at].openings.push_back(std::move(opening));
      } else {
        ++without;
      }
    }
  }
  if (loose != nullptr) *loose = without;

  std::vector<Facade> facades;
  for (const Draft& draft : drafts) facades.push_back(finish(draft, city, zero, options));
  const bool any_openings =
      std::any_of(facades.begin(), facades.end(), [](const Facade& f) { return !f.openings.empty(); });
  for (Facade& f : facades)
    f.blank = any_openings && f.openings.empty() && f.width() >= options.blank_width - 1e-9 && !f.is_covered();
  std::sort(facades.begin(), facades.end(), [](const Facade& a, const Facade& b) {
    const auto key = [](const Facade& f) {
      return std::tuple(-rounded(f.area), rounded(f.left.x), rounded(f.left.y), rounded(f.bottom), rounded(f.right.x),
                        rounded(f.right.y), f.faces);
    };
    return key(a) < key(b);
  });
  return facades;
}

std::size_t mark_blank(City& reference, std::span<const std::vector<std::uint32_t>> groups,
                       const FacadeOptions& options) {
  std::size_t blank = 0;
  for (const auto& group : groups) {
    for (const Facade& facade : facades_of(reference, group, 0, options)) {
      if (!facade.blank) continue;
      ++blank;
      for (const auto& [building, index] : facade.faces) {
        Face& face = reference.buildings[building].faces[index];
        if (face.left_out == LeftOut::no) face.left_out = LeftOut::blank;
      }
    }
  }
  return blank;
}

}  // namespace blockrand::compare
