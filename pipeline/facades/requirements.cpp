#include "pipeline/facades/requirements.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

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

/// m. Sills of one row lie within that.
constexpr double kSameRow = 0.3;

/// An opening on its wall; metres.
struct Seen {
  OpeningKind kind = OpeningKind::window;
  std::int32_t storey = 0;
  double left = 0, right = 0, bottom = 0, top = 0;  ///< along the wall; above the height reference
  double width() const { return right - left; }
  double height() const { return top - bottom; }
  double ratio() const { return height() / std::max(width(), 0.01); }
};

/// Of one house: of each kind of miss the worst, once.
class Check {
 public:
  Check(model::Region& region, const Building& building, const districts::Preset& preset)
      : region_(region), building_(building), preset_(preset), asked_(*preset.requirements) {}

  void run(const BuildingPart& part, const masses::BuiltMass* mass) {
    eaves_ = building_.attributes.ground_height.value + part.attributes.eaves_height.value;
    ground_ = building_.attributes.ground_height.value + part.attributes.plinth_height.value;
    if (const double upper = part.attributes.storeys.value - 1;
        !asked_.upper_storeys.empty() && (upper < asked_.upper_storeys[0] || upper > asked_.upper_storeys[1]))
      miss("storeys", 0,
           fmt::format("{:g} storeys above the ground floor, {:g} to {:g} asked", upper, asked_.upper_storeys[0],
                       asked_.upper_storeys[1]));
    std::vector<WallFrame> walls;
    for (std::uint32_t f = 0; f < part.lod2.faces.size(); ++f)
      if (auto wall = wall_frame(part.lod2, f)) walls.push_back(std::move(*wall));
    std::vector<double> upper_areas, gable_areas;
    for (const FacadeSegment& s : facade_segments(building_, walls)) {
      if (s.kind != model::WallSegmentKind::street) continue;
      const std::vector<Seen> all = openings(part, walls[s.wall], s);
      ratios(all);
      if (asked_.windows_in_line) lines(all, s);
      for (const Seen& o : all)
        if (o.kind == OpeningKind::window && (is_upper(o) || above_eaves(o)))
          (above_eaves(o) ? gable_areas : upper_areas).push_back(o.width() * o.height());
    }
    if (asked_.gable_windows_smaller && !upper_areas.empty() && !gable_areas.empty()) {
      const double least = *std::ranges::min_element(upper_areas), most = *std::ranges::max_element(gable_areas);
      if (most > least - kSlack)
        miss("areas", most - least,
             fmt::format("a window above the eaves of {:.2f} m2, smaller asked than {:.2f} m2 below", most, least));
    }
    gables(part, mass);
    if (mass) roof_elements(part, *mass);
    for (const auto& [kind, worst] : misses_)
      region_.report.add(building_.osm, model::IssueCode::requirement_missed,
                         fmt::format("{} (preset {})", worst.second, preset_.name));
  }

 private:
  bool above_eaves(const Seen& o) const { return o.bottom > eaves_ - kSlack; }
  bool is_upper(const Seen& o) const { return o.storey > 0 && !above_eaves(o); }

  /// \param by  how far it is from what is asked, in units of its kind
  void miss(std::string_view kind, double by, std::string what) {
    const auto [place, added] = misses_.try_emplace(kind, by, std::move(what));
    if (!added && by > place->second.first) place->second = {by, std::move(what)};
  }

  /// From left to right.
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
    std::ranges::sort(out, {}, [](const Seen& o) { return std::pair(o.left, o.bottom); });
    return out;
  }

  void ratios(const std::vector<Seen>& all) {
    const auto at_least = [&](const std::optional<double>& asked, double found, double slack, std::string_view kind,
                              const char* what) {
      if (asked && found < *asked - slack) miss(kind, *asked - found, fmt::format(fmt::runtime(what), found, *asked));
    };
    for (const Seen& o : all) {
      if (o.kind == OpeningKind::door) {
        at_least(asked_.door_height, o.height(), kSlack, "door", "a door is {:.2f} m high, at least {:.2f} m asked");
        continue;
      }
      if (above_eaves(o))
        at_least(asked_.gable_window_ratio, o.ratio(), kRatioSlack, "gable ratio",
                 "a window above the eaves is {:.2f} times as high as wide, at least {:.2f} asked");
      else if (o.storey > 0)
        at_least(asked_.window_ratio, o.ratio(), kRatioSlack, "ratio",
                 "an upper window is {:.2f} times as high as wide, at least {:.2f} asked");
      else
        at_least(asked_.ground_window_ratio, o.ratio(), kRatioSlack, "ground ratio",
                 "a window of the ground floor is {:.2f} times as high as wide, at least {:.2f} asked");
      if (is_upper(o))
        at_least(asked_.upper_windows_from, o.bottom - ground_, kSlack, "from",
                 "upper windows begin {:.2f} m above the ground floor, at least {:.2f} m asked");
    }
  }

  /// The upper rows of a front: windows equal and as far from each other, the same places in every row, and farther from the
  /// front's edges than from each other. Rows are told by the height of their sills.
  void lines(const std::vector<Seen>& all, const FacadeSegment& s) {
    std::vector<std::vector<Seen>> rows;
    for (const Seen& o : all) {
      if (o.kind != OpeningKind::window || !is_upper(o)) continue;
      const auto row = std::ranges::find_if(
          rows, [&](const std::vector<Seen>& r) { return std::fabs(r[0].bottom - o.bottom) < kSameRow; });
      if (row == rows.end())
        rows.push_back({o});
      else
        row->push_back(o);
    }
    if (rows.empty()) return;
    std::ranges::sort(rows, {}, [](const std::vector<Seen>& row) { return row[0].bottom; });
    const std::vector<Seen>& first = rows.front();
    const double width = first[0].width(), height = first[0].height();
    const double gap = first.size() > 1 ? first[1].left - first[0].right : -1;
    for (const std::vector<Seen>& row : rows) {
      if (row.size() != first.size()) {
        miss("line", 100,
             fmt::format("rows of {} and {} upper windows above each other: not in line", first.size(), row.size()));
        continue;
      }
      for (std::size_t i = 0; i < row.size(); ++i) {
        if (const double by = std::max(std::fabs(row[i].width() - width), std::fabs(row[i].height() - height));
            by > kSlack)
          miss("equal", by,
               fmt::format("upper windows of {:.2f} x {:.2f} m and {:.2f} x {:.2f} m: equal ones asked", width, height,
                           row[i].width(), row[i].height()));
        if (const double by = std::fabs(row[i].left - first[i].left); by > kSlack)
          miss("line", by, fmt::format("an upper window stands {:.2f} m beside that below it", by));
        if (i == 0) continue;
        if (const double by = std::fabs(row[i].left - row[i - 1].right - gap); by > 2 * kSlack)
          miss("gap", by,
               fmt::format("gaps of {:.2f} and {:.2f} m between windows: equal ones asked", gap,
                           row[i].left - row[i - 1].right));
      }
    }
    const double edge = std::min(first.front().left - s.from, s.to - first.back().right);
    if (gap > 0 && edge <= gap - kSlack)
      miss("edge", gap - edge,
           fmt::format(
               "windows stand {:.2f} m from the front's edge and {:.2f} m from each other: farther from the edge asked",
               edge, gap));
  }

  void gables(const BuildingPart& part, const masses::BuiltMass* mass) {
    if (!asked_.roof_shapes.empty() &&
        std::ranges::find(asked_.roof_shapes, part.built_roof) == asked_.roof_shapes.end())
      miss("roof", 0, fmt::format("the roof is {}", model::name(part.built_roof)));
    bool stands = false;
    for (const model::RoofInstallation& r : part.lod3.roof_installations) {
      if (r.kind != RoofElementKind::gable) continue;
      stands = true;
      if (!asked_.gable_overtop || !mass) continue;
      const double above = top_of(r) - top_behind(r, mass->roof);
      if (above < *asked_.gable_overtop - kSlack)
        miss("overtop", *asked_.gable_overtop - above,
             fmt::format("a gable ends {:.2f} m above the roof behind it, at least {:.2f} m asked", above,
                         *asked_.gable_overtop));
    }
    if (asked_.ornamental_gable && *asked_.ornamental_gable != stands)
      miss("gable", 0, stands ? "an ornamental gable stands, none asked" : "no ornamental gable stands");
  }

  static double top_of(const model::RoofInstallation& gable) {
    double top = -1e300;
    for (const Point3& p : gable.solid.vertices) top = std::max(top, p.z);
    return top;
  }

  /// Highest corner of the roof straight behind a gable, as deep as the gable is wide; -1e300 for none.
  static double top_behind(const model::RoofInstallation& gable, const roofs::Roof& roof) {
    Point2 a{}, b{};
    double width = 0;
    for (const Point3& p : gable.solid.vertices)
      for (const Point3& q : gable.solid.vertices)
        if (const double d = std::hypot(q.x - p.x, q.y - p.y); d > width) a = p.xy(), b = q.xy(), width = d;
    double top = -1e300;
    if (width <= 0) return top;
    for (const roofs::Roof::Surface& surface : roof.surfaces)
      for (const auto& loop : surface.loops)
        for (const Point3& p : loop) {
          const double u = ((p.x - a.x) * (b.x - a.x) + (p.y - a.y) * (b.y - a.y)) / width,
                       v = ((p.x - a.x) * (b.y - a.y) - (p.y - a.y) * (b.x - a.x)) / width;
          if (u > -kSlack && u < width + kSlack && std::fabs(v) <= width) top = std::max(top, p.z);
        }
    return top;
  }

  void roof_elements(const BuildingPart& part, const masses::BuiltMass& mass) {
    const std::vector<model::RoofFront>& fronts = part.lod3.roof_fronts;
    const auto& ring = mass.plan.outer.points;
    const auto too_near = [&](const std::optional<double>& asked, double found, std::string_view kind,
                              const model::RoofFront& f, const std::string& from) {
      if (asked && found < *asked - 2 * kSlack)
        miss(kind, *asked - found,
             fmt::format("a {} stands {:.2f} m from {}, at least {:.2f} m asked", model::name(f.kind), found, from,
                         *asked));
    };
    for (std::size_t i = 0; i < fronts.size(); ++i) {
      const model::RoofFront& f = fronts[i];
      if (asked_.roof_element_width && f.width > *asked_.roof_element_width + kSlack)
        miss("width", f.width,
             fmt::format("a {} is {:.2f} m wide, at most {:.2f} m asked", model::name(f.kind), f.width,
                         *asked_.roof_element_width));
      if (f.edge < 0 || static_cast<std::size_t>(f.edge) >= ring.size()) continue;  // over a yard
      const auto edge = static_cast<std::size_t>(f.edge);
      const Point2 a = ring[edge], b = ring[(edge + 1) % ring.size()];
      const double length = std::max(std::hypot(b.x - a.x, b.y - a.y), 0.01);
      const auto along = [&](Point2 p) { return ((p.x - a.x) * (b.x - a.x) + (p.y - a.y) * (b.y - a.y)) / length; };
      const double at = along(f.middle);
      too_near(asked_.roof_side_distance, std::min(at, length - at) - f.width / 2, "side", f, "the side");
      if (f.kind == RoofElementKind::dormer && edge < mass.roof.wall_tops.size()) {
        double eaves = 1e300;
        for (const Point3& p : mass.roof.wall_tops[edge]) eaves = std::min(eaves, p.z);
        const double in = ((f.middle.x - a.x) * (b.y - a.y) - (f.middle.y - a.y) * (b.x - a.x)) / length;
        too_near(asked_.roof_eaves_distance, std::hypot(in, f.foot - eaves), "eaves", f, "the eaves");
      }
      for (std::size_t j = 0; j < i; ++j)
        if (fronts[j].edge == f.edge)
          too_near(asked_.roof_element_distance,
                   std::fabs(along(fronts[j].middle) - at) - (f.width + fronts[j].width) / 2, "between", f,
                   fmt::format("a {}", model::name(fronts[j].kind)));
    }
  }

  model::Region& region_;
  const Building& building_;
  const districts::Preset& preset_;
  const PresetRequirements& asked_;
  double eaves_ = 0, ground_ = 0;                                      ///< m above the height reference
  std::map<std::string_view, std::pair<double, std::string>> misses_;  ///< by kind: by how much, in words
};

}  // namespace

void check_requirements(model::Region& region, const masses::BuiltMasses& built,
                        std::span<const districts::Preset> presets) {
  for (std::uint32_t b = 0; b < region.buildings.size(); ++b) {
    Building& building = region.buildings[b];
    const BuildingPart* body = main_body(building);
    if (!body || body->lod < 3 || !body->lod3.solid.closed) continue;
    const auto preset = std::ranges::find(presets, body->attributes.preset.value, &districts::Preset::name);
    if (preset == presets.end() || !preset->requirements) continue;
    const auto number = static_cast<std::uint32_t>(body - building.parts.data());
    Check(region, building, *preset).run(*body, built.find({b, number}));
  }
}

}  // namespace blockrand::facades
