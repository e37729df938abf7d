#include "pipeline/facades/requirements.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "pipeline/base/portable_math.h"
#include "pipeline/facades/bodies_on_roofs.h"
#include "pipeline/facades/facade_segments.h"
#include "pipeline/facades/wall_frame.h"

namespace blockrand::facades {
namespace {

using districts::PresetRequirements;
using model::Building;
using model::BuildingPart;
using model::OpeningKind;
using model::Point2;
using model::Point3;
using model::RoofElementKind;

/// m. Openings are whole centimetres on a wall and their corners rounded to 1/1024 m.
constexpr double kSlack = 0.012;
/// The same of a ratio of two such lengths around a metre.
constexpr double kRatioSlack = 0.02;

/// An opening on its wall; metres.
struct Seen {
  OpeningKind kind = OpeningKind::window;
  std::int32_t storey = 0;
  double left = 0, right = 0, bottom = 0, top = 0;  ///< along the wall; above the height reference
  double width() const { return right - left; }
  double height() const { return top - bottom; }
  double ratio() const { return height() / std::max(width(), 0.01); }
};

/// Of one house: the worst of each kind is told, once.
class Check {
 public:
  Check(model::Region& region, const Building& building, const districts::Preset& preset)
      : region_(region), building_(building), preset_(preset), asked_(*preset.requirements) {}

  void run(const BuildingPart& part, const masses::BuiltMass* mass) {
    eaves_ = building_.attributes.ground_height.value + part.attributes.eaves_height.value;
    ground_ = building_.attributes.ground_height.value + part.attributes.plinth_height.value;
    if (const double upper = part.attributes.storeys.value - 1;
        !asked_.upper_storeys.empty() && (upper < asked_.upper_storeys[0] || upper > asked_.upper_storeys[1]))
      miss(fmt::format("{:g} storeys above the ground floor, {:g} to {:g} asked", upper, asked_.upper_storeys[0],
                       asked_.upper_storeys[1]));
    std::vector<WallFrame> walls;
    for (std::uint32_t f = 0; f < part.lod2.faces.size(); ++f)
      if (auto wall = wall_frame(part.lod2, f)) walls.push_back(std::move(*wall));
    std::vector<double> upper_areas, gable_areas;
    for (const FacadeSegment& s : facade_segments(building_, walls)) {
      if (s.kind != model::WallSegmentKind::street) continue;
      const WallFrame& wall = walls[s.wall];
      std::vector<Seen> all = openings(part, wall, s);
      ratios(all);
      if (asked_.windows_in_line) lines(all, s);
      for (const Seen& o : all)
        if (o.kind == OpeningKind::window && (is_upper(o) || above_eaves(o)))
          (above_eaves(o) ? gable_areas : upper_areas).push_back(o.width() * o.height());
    }
    if (asked_.gable_windows_smaller && !upper_areas.empty() && !gable_areas.empty()) {
      const double least = *std::ranges::min_element(upper_areas), most = *std::ranges::max_element(gable_areas);
      if (most > least - kSlack)
        miss(fmt::format("a window above the eaves of {:.2f} m2, smaller asked than {:.2f} m2 below", most, least));
    }
    gables(part, mass);
    if (mass) roof_elements(part, *mass);
  }

 private:
  bool above_eaves(const Seen& o) const { return o.bottom > eaves_ - kSlack; }
  bool is_upper(const Seen& o) const { return o.storey > 0 && !above_eaves(o); }

  void miss(std::string what) {
    region_.report.add(building_.osm, model::IssueCode::requirement_missed,
                       fmt::format("{} (preset {})", std::move(what), preset_.name));
  }

  std::vector<Seen> openings(const BuildingPart& part, const WallFrame& wall, const FacadeSegment& s) const {
    std::vector<Seen> out;
    const model::Solid& solid = part.lod3.solid;
    for (const model::Opening& o : part.lod3.openings) {
      if (o.wall != wall.face || o.kind == OpeningKind::passage) continue;
      Seen seen{o.kind, o.storey, 1e9, -1e9, 1e9, -1e9};
      for (const model::Solid::Loop& loop : solid.loops_of(solid.faces[o.polygon]))
        for (const std::uint32_t i : solid.indices_of(loop)) {
          const Point3& p = solid.vertices[i];
          const double u = (p.x - wall.start.x) * wall.along.x + (p.y - wall.start.y) * wall.along.y;
          seen.left = std::min(seen.left, u), seen.right = std::max(seen.right, u);
          seen.bottom = std::min(seen.bottom, p.z), seen.top = std::max(seen.top, p.z);
        }
      const double middle = (seen.left + seen.right) / 2;
      if (middle >= s.from && middle <= s.to) out.push_back(seen);
    }
    std::ranges::sort(out, {}, [](const Seen& o) { return std::pair(o.storey, o.left); });
    return out;
  }

  void ratios(const std::vector<Seen>& all) {
    struct Worst {
      const char* what;
      const std::optional<double>& asked;
      double found = 1e9;
    };
    Worst upper{"an upper window is {:.2f} times as high as wide, at least {:.2f} asked", asked_.window_ratio},
        ground{"a window of the ground floor is {:.2f} times as high as wide, at least {:.2f} asked",
               asked_.ground_window_ratio},
        gable{"a window above the eaves is {:.2f} times as high as wide, at least {:.2f} asked",
              asked_.gable_window_ratio},
        from{"upper windows begin {:.2f} m above the ground floor, at least {:.2f} m asked", asked_.upper_windows_from},
        door{"a door is {:.2f} m high, at least {:.2f} m asked", asked_.door_height};
    for (const Seen& o : all) {
      if (o.kind == OpeningKind::door) {
        door.found = std::min(door.found, o.height());
        continue;
      }
      Worst& w = above_eaves(o) ? gable : o.storey > 0 ? upper : ground;
      w.found = std::min(w.found, o.ratio());
      if (is_upper(o)) from.found = std::min(from.found, o.bottom - ground_);
    }
    for (const Worst& w : {upper, ground, gable, from, door}) {
      const double slack =
          &w.asked == &asked_.upper_windows_from || &w.asked == &asked_.door_height ? kSlack : kRatioSlack;
      if (w.asked && w.found < 1e9 && w.found < *w.asked - slack)
        miss(fmt::format(fmt::runtime(w.what), w.found, *w.asked));
    }
  }

  /// The upper storeys of a front: windows equal and as far from each other, the same places in every storey, and farther from
  /// the front's edges than from each other.
  void lines(const std::vector<Seen>& all, const FacadeSegment& s) {
    std::vector<std::vector<Seen>> rows;
    for (const Seen& o : all) {
      if (o.kind != OpeningKind::window || !is_upper(o)) continue;
      if (rows.empty() || rows.back().back().storey != o.storey) rows.emplace_back();
      rows.back().push_back(o);
    }
    if (rows.empty()) return;
    const std::vector<Seen>& first = rows.front();
    const double width = first[0].width(), height = first[0].height();
    const double gap = first.size() > 1 ? first[1].left - first[0].right : -1;
    for (const std::vector<Seen>& row : rows) {
      if (row.size() != first.size())
        return miss(fmt::format("storey {} has {} windows, storey {} {}: not in line", row[0].storey, row.size(),
                                first[0].storey, first.size()));
      for (std::size_t i = 0; i < row.size(); ++i) {
        if (std::fabs(row[i].width() - width) > kSlack || std::fabs(row[i].height() - height) > kSlack)
          return miss(fmt::format("upper windows of {:.2f} x {:.2f} m and {:.2f} x {:.2f} m: equal ones asked", width,
                                  height, row[i].width(), row[i].height()));
        if (std::fabs(row[i].left - first[i].left) > kSlack)
          return miss(fmt::format("a window of storey {} stands {:.2f} m beside that below it", row[i].storey,
                                  std::fabs(row[i].left - first[i].left)));
        if (i > 0 && std::fabs(row[i].left - row[i - 1].right - gap) > 2 * kSlack)
          return miss(fmt::format("gaps of {:.2f} and {:.2f} m between windows: equal ones asked", gap,
                                  row[i].left - row[i - 1].right));
      }
    }
    const double edge = std::min(first.front().left - s.from, s.to - first.back().right);
    if (gap > 0 && edge <= gap - kSlack)
      miss(fmt::format(
          "windows stand {:.2f} m from the front's edge and {:.2f} m from each other: farther from the edge asked",
          edge, gap));
  }

  void gables(const BuildingPart& part, const masses::BuiltMass* mass) {
    if (!asked_.roof_shapes.empty() &&
        std::ranges::find(asked_.roof_shapes, part.built_roof) == asked_.roof_shapes.end())
      miss(fmt::format("the roof is {}", model::name(part.built_roof)));
    double top = -1e9;
    for (const model::RoofInstallation& r : part.lod3.roof_installations)
      if (r.kind == RoofElementKind::gable)
        for (const Point3& p : r.solid.vertices) top = std::max(top, p.z);
    const bool stands = top > -1e9;
    if (asked_.ornamental_gable && *asked_.ornamental_gable != stands)
      return miss(stands ? "an ornamental gable stands, none asked" : "no ornamental gable stands");
    if (!asked_.gable_overtop || !stands || !mass) return;
    double ridge = -1e9;
    for (const roofs::Roof::Surface& surface : mass->roof.surfaces)
      for (const auto& loop : surface.loops)
        for (const Point3& p : loop) ridge = std::max(ridge, p.z);
    if (top - ridge < *asked_.gable_overtop - kSlack)
      miss(fmt::format("the gable ends {:.2f} m above the ridge, at least {:.2f} m asked", top - ridge,
                       *asked_.gable_overtop));
  }

  void roof_elements(const BuildingPart& part, const masses::BuiltMass& mass) {
    const std::vector<model::RoofFront>& fronts = part.lod3.roof_fronts;
    const auto& ring = mass.plan.outer.points;
    const double slope = base::sin_cos(part.attributes.roof_pitch.value * base::kRadiansPerDegree).sin;
    for (std::size_t i = 0; i < fronts.size(); ++i) {
      const model::RoofFront& f = fronts[i];
      const std::string what(model::name(f.kind));
      if (asked_.roof_element_width && f.width > *asked_.roof_element_width + kSlack)
        return miss(
            fmt::format("a {} is {:.2f} m wide, at most {:.2f} m asked", what, f.width, *asked_.roof_element_width));
      if (f.edge < 0 || static_cast<std::size_t>(f.edge) >= ring.size()) continue;  // over a yard
      const Point2 a = ring[static_cast<std::size_t>(f.edge)],
                   b = ring[(static_cast<std::size_t>(f.edge) + 1) % ring.size()];
      const double length = std::max(std::hypot(b.x - a.x, b.y - a.y), 0.01);
      const auto along = [&](Point2 p) { return ((p.x - a.x) * (b.x - a.x) + (p.y - a.y) * (b.y - a.y)) / length; };
      const double at = along(f.middle);
      const double side = std::min(at, length - at) - f.width / 2;
      if (asked_.roof_side_distance && side < *asked_.roof_side_distance - kSlack)
        return miss(fmt::format("a {} stands {:.2f} m from the side, at least {:.2f} m asked", what, side,
                                *asked_.roof_side_distance));
      if (asked_.roof_eaves_distance && f.kind == RoofElementKind::dormer && model::traits(part.built_roof).one_pitch &&
          slope > 0.1) {
        const double up = (f.foot - eaves_) / slope;
        if (up < *asked_.roof_eaves_distance - 2 * kSlack)
          return miss(fmt::format("a dormer stands {:.2f} m above the eaves, at least {:.2f} m asked", up,
                                  *asked_.roof_eaves_distance));
      }
      if (!asked_.roof_element_distance) continue;
      for (std::size_t j = 0; j < i; ++j) {
        if (fronts[j].edge != f.edge) continue;
        const double gap = std::fabs(along(fronts[j].middle) - at) - (f.width + fronts[j].width) / 2;
        if (gap < *asked_.roof_element_distance - kSlack)
          return miss(fmt::format("a {} stands {:.2f} m from a {}, at least {:.2f} m asked", what, gap,
                                  model::name(fronts[j].kind), *asked_.roof_element_distance));
      }
    }
  }

  model::Region& region_;
  const Building& building_;
  const districts::Preset& preset_;
  const PresetRequirements& asked_;
  double eaves_ = 0, ground_ = 0;  ///< m above the height reference
};

}  // namespace

void check_requirements(model::Region& region, const masses::BuiltMasses& built,
                        std::span<const districts::Preset> presets) {
  for (std::uint32_t b = 0; b < region.buildings.size(); ++b) {
    Building& building = region.buildings[b];
    const auto preset = std::ranges::find(presets, building.attributes.preset.value, &districts::Preset::name);
    if (preset == presets.end() || !preset->requirements) continue;
    const BuildingPart* body = main_body(building);
    if (!body || body->lod < 3) continue;
    const auto number = static_cast<std::uint32_t>(body - building.parts.data());
    Check(region, building, *preset).run(*body, built.find({b, number}));
  }
}

}  // namespace blockrand::facades
