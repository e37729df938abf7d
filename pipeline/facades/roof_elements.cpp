#include "pipeline/facades/roof_elements.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string_view>

#include "pipeline/facades/bodies_on_roofs.h"
#include "pipeline/geometry/check_solid.h"
#include "pipeline/geometry/grid.h"
#include "pipeline/geometry/polygon_measures.h"
#include "pipeline/geometry/triangulate.h"
#include "pipeline/masses/envelope.h"

namespace blockrand::facades {
namespace {

using model::Point2;
using model::Point3;
using model::RoofElementKind;
using roofs::DormerKind;

/// m that elements keep from other bodies of their building, on the plan: what stands there reaches through the slope.
constexpr double kFromOtherBodies = 0.3;
/// m. Axes of walls on a simpler plan lie beside the slope's own line by less.
constexpr double kSameAxis = 0.05;

/// Reads values of attributes by name.
class Values {
 public:
  Values(std::span<const std::pair<std::string, grammar::Value>> values, std::vector<std::string>& complaints)
      : values_(values), complaints_(complaints) {}

  std::string text(std::string_view name) const {
    const grammar::Value* value = find(name);
    const auto* text = value ? std::get_if<std::string>(value) : nullptr;
    return text ? *text : std::string();
  }
  /// The number within its range; else what is usual, told.
  double number(std::string_view name, double least, double most, double usual) const {
    const grammar::Value* value = find(name);
    const auto* number = value ? std::get_if<double>(value) : nullptr;
    if (!number) return usual;
    if (*number >= least && *number <= most) return *number;
    complaints_.push_back(
        fmt::format("{} = {} is not within {} to {}; {} is taken", name, *number, least, most, usual));
    return usual;
  }
  int count(std::string_view name, int least, int most, int usual) const {
    return static_cast<int>(std::lround(number(name, least, most, usual)));
  }
  /// \param asked_by  the name by which people ask for it
  template <class Kind, std::size_t n>
  std::optional<Kind> kind(std::string_view name, std::string_view asked_by,
                           const std::pair<std::string_view, Kind> (&kinds)[n]) const {
    const std::string asked = text(name);
    if (asked.empty() || asked == "none") return std::nullopt;
    std::string known;
    for (const auto& [word, kind] : kinds) {
      if (word == asked) return kind;
      known += fmt::format("{}, ", word);
    }
    complaints_.push_back(fmt::format("{} = \"{}\" is none of {}none", asked_by, asked, known));
    return std::nullopt;
  }

 private:
  const grammar::Value* find(std::string_view name) const {
    for (const auto& [known, value] : values_)
      if (known == name) return &value;
    return nullptr;
  }
  std::span<const std::pair<std::string, grammar::Value>> values_;
  std::vector<std::string>& complaints_;
};

constexpr std::pair<std::string_view, DormerKind> kDormerNames[] = {
    {"gabled", DormerKind::gabled}, {"hipped", DormerKind::hipped},       {"shed", DormerKind::shed},
    {"flat", DormerKind::flat},     {"segmental", DormerKind::segmental}, {"eyebrow", DormerKind::eyebrow}};
constexpr std::pair<std::string_view, DormerKind> kCrossGableNames[] = {{"gabled", DormerKind::gabled},
                                                                        {"hipped", DormerKind::hipped},
                                                                        {"shed", DormerKind::shed},
                                                                        {"flat", DormerKind::flat},
                                                                        {"segmental", DormerKind::segmental}};
constexpr std::pair<std::string_view, roofs::GableForm> kGableNames[] = {
    {"stepped", roofs::GableForm::stepped}, {"curved", roofs::GableForm::curved}, {"attic", roofs::GableForm::attic}};
constexpr std::pair<std::string_view, RoofSide> kSideNames[] = {
    {"street", RoofSide::street}, {"rear", RoofSide::rear}, {"both", RoofSide::both}};

/// Holds what is built so far.
class Furnisher {
 public:
  Furnisher(const model::Building& building, const model::BuildingPart& body, const masses::BuiltMass& mass,
            std::span<const model::RoofEdge> edges, std::span<const WindowAxes> axes, const RoofOrders& orders)
      : building_(building), body_(body), mass_(mass), edges_(edges), axes_(axes), orders_(orders) {}

  std::optional<FurnishedRoof> run() {
    // Where the solid with everything is not valid, fewer things stand on the roof.
    for (const bool dormers : {true, false}) {
      if (!dormers && !orders_.cross_gables) break;
      out_ = {};
      out_.roof = mass_.roof;
      if (orders_.cross_gables) add_cross_gables(*orders_.cross_gables);
      const int gables = out_.cross_gables;
      if (orders_.dormers && dormers) add_dormers(*orders_.dormers);
      if (out_.dormers + out_.cross_gables == 0) break;
      if (make_solid()) {
        out_.left_out = spoiled_;
        return std::move(out_);
      }
      spoiled_ += dormers ? out_.dormers : gables;
    }
    out_ = {};
    out_.left_out = spoiled_;
    if (spoiled_ == 0) return std::nullopt;
    return std::move(out_);
  }

 private:
  bool on_side(std::int32_t edge, RoofSide side) const {
    // What stands close above a party wall would look at the neighbour's wall, or into his roof.
    if (edge >= 0 && static_cast<std::size_t>(edge) < edges_.size() &&
        edges_[static_cast<std::size_t>(edge)] == model::RoofEdge::party_wall)
      return false;
    if (side == RoofSide::both) return true;
    const bool street = edge >= 0 && static_cast<std::size_t>(edge) < edges_.size() &&
                        edges_[static_cast<std::size_t>(edge)] == model::RoofEdge::street;
    return street == (side == RoofSide::street);
  }

  /// The plan edge that a slope looks over: its own, or, of upper slopes, none.
  std::int32_t edge_of(std::size_t surface) const { return out_.roof.surfaces[surface].edge; }

  /// Window axes of the wall below as places along a slope, rising.
  std::vector<double> axes_on(const roofs::RoofSlope& slope, std::int32_t edge) const {
    std::vector<double> out;
    for (const WindowAxes& wall : axes_)
      if (wall.edge == edge)
        for (const Point2 p : wall.places) out.push_back(slope.in_plane(p).x);
    std::sort(out.begin(), out.end());
    out.erase(std::unique(out.begin(), out.end(), [](double a, double b) { return b - a < kSameAxis; }), out.end());
    return out;
  }

  static std::vector<double> every(const std::vector<double>& axes, int step) {
    if (step <= 1) return axes;
    std::vector<double> out;
    // Symmetric about the middle where the count allows it.
    const std::size_t rest = axes.empty() ? 0 : (axes.size() - 1) % static_cast<std::size_t>(step);
    for (std::size_t i = rest / 2; i < axes.size(); i += static_cast<std::size_t>(step)) out.push_back(axes[i]);
    return out;
  }

  /// Whether another body of the building stands where an element would.
  bool free_of_bodies(const roofs::RoofSlope& slope, std::span<const Point2> outline, Point2 place) const {
    if (building_.parts.size() < 2) return true;
    model::Ring ring;
    double low = 1e300;
    for (const Point2& p : outline) {
      const Point3 at = slope.in_space({p.x + place.x, p.y + place.y});
      ring.points.push_back(at.xy());
      low = std::min(low, at.z);
    }
    for (const model::BuildingPart& other : building_.parts) {
      if (&other == &body_ || other.plan.outer.size() < 3 || extent_of(other).high <= low) continue;
      for (std::size_t i = 0; i < ring.size(); ++i) {
        const Point2 a = ring.points[i], b = ring.points[(i + 1) % ring.size()];
        if (geometry::contains(other.plan, a)) return false;
        for (const Point2 corner : other.plan.outer.points)
          if (geometry::distance_to_segment(corner, a, b) < kFromOtherBodies || geometry::contains(ring.points, corner))
            return false;
      }
    }
    return true;
  }

  std::optional<roofs::RoofSlope> slope_at(const roofs::RoofBorders& borders, std::size_t surface,
                                           RoofSide side) const {
    if (out_.roof.surfaces[surface].element >= 0 || out_.roof.surfaces[surface].upright) return std::nullopt;
    const std::int32_t edge = edge_of(surface);
    if (edge < 0 || !on_side(edge, side)) return std::nullopt;
    auto slope = borders.slope(surface);
    if (!slope || !roofs::takes_elements(*slope)) return std::nullopt;
    return slope;
  }

  void add_cross_gables(const roofs::CrossGableParameters& each) {
    const std::size_t surfaces = out_.roof.surfaces.size();
    for (std::size_t s = 0; s < surfaces; ++s) {
      // One before may have changed what this slope borders on.
      if (out_.roof.surfaces[s].edge < 0 || !on_side(out_.roof.surfaces[s].edge, orders_.cross_gable_side)) continue;
      const auto slope = slope_at(roofs::RoofBorders(out_.roof, edges_), s, orders_.cross_gable_side);
      if (!slope) continue;
      roofs::CrossGableParameters fitted = each;
      roofs::LayoutRequest wanted;
      wanted.outline = roofs::cross_gable_outline(*slope, fitted);
      if (wanted.outline.empty() && fitted.wall_height > 0) {  // the slope is too short for a wall below the head
        fitted.wall_height = 0;
        wanted.outline = roofs::cross_gable_outline(*slope, fitted);
      }
      if (wanted.outline.empty()) continue;
      wanted.up = 0;
      wanted.flush = true;
      if (orders_.cross_gable_count > 0) wanted.count = orders_.cross_gable_count;
      wanted.axes = axes_between(axes_on(*slope, edge_of(s)));
      for (const double along : roofs::lay_out(*slope, wanted, orders_.distances).along) {
        if (!free_of_bodies(*slope, wanted.outline, {along, 0})) {
          ++spoiled_;
          continue;
        }
        if (!roofs::add_cross_gable(out_.roof, s, fitted, {along, 0}, edges_, orders_.distances)) continue;
        ++out_.cross_gables;
        const Point3 foot = slope->in_space({along, 0});
        out_.fronts.push_back({RoofElementKind::cross_gable, 0, edge_of(s), foot.xy(), fitted.width, foot.z});
      }
    }
  }

  /// Cross gables are as wide as two axes: they stand on an axis or in the middle between two.
  static std::vector<double> axes_between(const std::vector<double>& axes) {
    std::vector<double> out;
    for (std::size_t i = 0; i < axes.size(); ++i) {
      out.push_back(axes[i]);
      if (i + 1 < axes.size()) out.push_back((axes[i] + axes[i + 1]) / 2);
    }
    return out;
  }

  /// Whether a slope is as long and as high as an element with its distances, where it is largest.
  bool has_room(const roofs::RoofSlope& slope, std::span<const Point2> outline) const {
    const auto along = geometry::extent_along(outline, {1, 0}), up = geometry::extent_along(outline, {0, 1});
    const auto all_along = slope.along_extent(), all_up = slope.up_extent();
    return all_along.maximum - all_along.minimum >= along.maximum - along.minimum &&
           all_up.maximum >= up.maximum - up.minimum + orders_.distances.eaves;
  }

  void add_dormers(const roofs::DormerParameters& each) {
    const std::size_t surfaces = out_.roof.surfaces.size();
    const roofs::Roof before = out_.roof;
    const roofs::RoofBorders borders(before, edges_);
    for (std::size_t s = 0; s < surfaces; ++s) {
      const auto slope = slope_at(borders, s, orders_.dormer_side);
      if (!slope) continue;
      const roofs::DormerParameters fitted = each;
      roofs::LayoutRequest wanted;
      wanted.outline = roofs::dormer_outline(*slope, fitted);
      if (wanted.outline.empty() || !has_room(*slope, wanted.outline)) continue;
      wanted.up = orders_.distances.eaves;
      if (orders_.dormer_count > 0) wanted.count = orders_.dormer_count;
      wanted.axes = every(axes_on(*slope, edge_of(s)), orders_.dormer_every);
      if (wanted.axes.empty()) wanted.step = kUsualAxis * orders_.dormer_every;
      for (const double along : roofs::lay_out(*slope, wanted, orders_.distances).along) {
        const Point2 place{along, wanted.up};
        if (!free_of_bodies(*slope, wanted.outline, place)) {
          ++spoiled_;
          continue;
        }
        const auto front = static_cast<std::uint32_t>(out_.roof.surfaces.size());
        if (!roofs::add_laid_out_dormer(out_.roof, *slope, fitted, place)) continue;
        ++out_.dormers;
        const Point3 foot = slope->in_space(place);
        out_.fronts.push_back({RoofElementKind::dormer, front, edge_of(s), foot.xy(), fitted.width, foot.z});
      }
    }
  }

  /// The envelope in the looks of the LoD2 solid. Cheeks are clad as the roof is; fronts are walls.
  bool make_solid() {
    masses::EnvelopeMaterials looks;
    for (const model::Face& face : body_.lod2.faces) {
      (face.kind == model::SurfaceKind::roof   ? looks.roof
       : face.kind == model::SurfaceKind::wall ? looks.wall
                                               : looks.under) = face;
    }
    for (model::Face* face : {&looks.roof, &looks.wall, &looks.under}) face->edge = -1;
    out_.solid = masses::envelope(mass_.plan, mass_.bottom, out_.roof, looks);
    const std::size_t first = body_.lod2.faces.size() - mass_.roof.surfaces.size();
    if (out_.solid.faces.size() != first + out_.roof.surfaces.size()) return false;  // a face was too small
    for (RoofFront& front : out_.fronts) {
      if (front.kind == RoofElementKind::dormer)
        front.face += static_cast<std::uint32_t>(first);
      else
        front.face = static_cast<std::uint32_t>(front.edge) + 1;  // after the underside
    }
    for (std::size_t s = mass_.roof.surfaces.size(); s < out_.roof.surfaces.size(); ++s) {
      const roofs::Roof::Surface& surface = out_.roof.surfaces[s];
      model::Face& face = out_.solid.faces[first + s];
      const bool is_front =
          std::any_of(out_.fronts.begin(), out_.fronts.end(), [&](const RoofFront& f) { return f.face == first + s; });
      if (surface.upright && !is_front) face.material = looks.roof.material, face.colour = looks.roof.colour;
    }
    if (!keep_vertices_of_lod2(looks)) return false;
    auto triangles = geometry::triangulate(out_.solid, body_.lod2, body_.lod2_triangles);
    if (!triangles || !geometry::check_solid(out_.solid, *triangles, geometry::kBuilt).valid()) return false;
    out_.triangles = std::move(*triangles);
    return true;
  }

  /// Gives the vertices of LoD2 their numbers and places there, so that faces which stay are the same faces.
  bool keep_vertices_of_lod2(const masses::EnvelopeMaterials& looks) {
    const model::Solid bare = masses::envelope(mass_.plan, mass_.bottom, mass_.roof, looks);
    if (bare.vertices.size() != body_.lod2.vertices.size()) return false;
    std::map<geometry::Grid3, std::uint32_t> number;
    for (std::uint32_t v = 0; v < bare.vertices.size(); ++v) number[geometry::to_grid(bare.vertices[v])] = v;
    std::vector<Point3> vertices = body_.lod2.vertices;
    for (std::uint32_t& index : out_.solid.indices) {
      const Point3& p = out_.solid.vertices[index];
      const auto [known, is_new] = number.emplace(geometry::to_grid(p), static_cast<std::uint32_t>(vertices.size()));
      if (is_new) vertices.push_back(p);
      index = known->second;
    }
    out_.solid.vertices = std::move(vertices);
    return true;
  }

  /// m between axes where the walls below have no windows (docs/style_measures.md §2.7: dormer_step).
  static constexpr double kUsualAxis = 2.4;

  const model::Building& building_;
  const model::BuildingPart& body_;
  const masses::BuiltMass& mass_;
  std::span<const model::RoofEdge> edges_;
  std::span<const WindowAxes> axes_;
  const RoofOrders& orders_;
  FurnishedRoof out_;
  int spoiled_ = 0;
};

}  // namespace

RoofOrders read_roof_orders(std::span<const std::pair<std::string, grammar::Value>> values,
                            std::vector<std::string>& complaints) {
  const Values said(values, complaints);
  RoofOrders out;
  const double widest = roofs::kWidestElement;
  if (const auto kind = said.kind("built_dormers", "dormer_kind", kDormerNames)) {
    roofs::DormerParameters p = roofs::usual_dormer(*kind);
    p.width = said.number("dormer_width", 0.6, widest, p.width);
    p.wall_height = said.number("dormer_height", 0.3, 3, p.wall_height);
    p.roof_pitch = said.number("dormer_pitch", 1, roofs::kSteepestDormerRoof, p.roof_pitch);
    p.rise = p.width / 6;
    out.dormers = p;
  }
  out.dormer_side = said.kind("dormer_side", "dormer_side", kSideNames).value_or(RoofSide::both);
  out.dormer_count = said.count("dormer_count", 0, 100, 0);
  out.dormer_every = said.count("dormer_every", 1, 20, 1);
  if (const auto kind = said.kind("built_cross_gables", "cross_gable_kind", kCrossGableNames)) {
    roofs::CrossGableParameters p;
    p.kind = *kind;
    p.width = said.number("cross_gable_width", 1, widest, p.width);
    p.wall_height = said.number("cross_gable_height", 0, 4, p.wall_height);
    p.roof_pitch = said.number("cross_gable_pitch", 1, roofs::kSteepestDormerRoof, *kind == DormerKind::shed ? 10 : 45);
    p.rise = p.width / 6;
    out.cross_gables = p;
  }
  out.cross_gable_side = said.kind("cross_gable_side", "cross_gable_side", kSideNames).value_or(RoofSide::street);
  out.cross_gable_count = said.count("cross_gable_count", 0, 100, 1);
  if (const auto form = said.kind("built_gable", "gable", kGableNames)) {
    roofs::GableOptions p;
    p.form = *form;
    p.steps = said.count("gable_steps", 3, 5, p.steps);
    p.curves = said.count("gable_curves", 1, 2, p.curves);
    p.overtop = said.number("gable_overtop", 0.1, 2, p.overtop);
    p.attic_height = said.number("gable_attic_height", 0.3, 3, p.attic_height);
    p.pediment = said.number("gable_pediment", 0, 1, p.pediment);
    out.gable = p;
  }
  // Below 0: nothing is said.
  const auto stated = [&](std::string_view name, double most) -> std::optional<double> {
    const double value = said.number(name, -1, most, -1);
    if (value < 0 && value != -1)
      complaints.push_back(fmt::format("{} = {} is neither -1 nor 0 or more; -1 is taken", name, value));
    return value < 0 ? std::nullopt : std::optional(value);
  };
  out.edges.eaves = stated("eaves_overhang", kMostOverhang);
  out.edges.verge = stated("verge_overhang", kMostOverhang);
  out.edges.parapet = stated("parapet_height", 1.5);
  out.edges.caps = said.number("ridge_caps", 0, 1, 1) > 0.5;
  out.edges.gutters = said.number("gutters", 0, 1, 0) > 0.5;
  out.edges.downpipes = said.number("downpipes", 0, 1, 0) > 0.5;
  out.distances.eaves = said.number("roof_eaves_distance", 0.1, 10, out.distances.eaves);
  out.distances.between = said.number("roof_element_distance", 0.1, 10, out.distances.between);
  out.distances.side = said.number("roof_side_distance", 0.1, 10, out.distances.side);
  return out;
}

std::optional<FurnishedRoof> furnish_roof(const model::Building& building, const model::BuildingPart& body,
                                          const masses::BuiltMass& mass, std::span<const model::RoofEdge> edges,
                                          std::span<const WindowAxes> axes, const RoofOrders& orders) {
  if (!orders.any()) return std::nullopt;
  return Furnisher(building, body, mass, edges, axes, orders).run();
}

}  // namespace blockrand::facades
