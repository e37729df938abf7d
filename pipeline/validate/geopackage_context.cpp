// Rules of what repair and context left in the file.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <unordered_map>
#include <unordered_set>

#include "pipeline/base/text.h"
#include "pipeline/model/building.h"
#include "pipeline/validate/geopackage_state.h"
#include "pipeline/validate/ids.h"

namespace blockrand::validate {
namespace {

using model::Point2;

/// m. Lengths have three decimals, and both ends of a stretch were rounded to the grid (0.7 mm each at most).
constexpr double kLengthTolerance = 0.003;
/// m. Ends of a stretch within an edge were rounded to the grid.
constexpr double kOnOutline = 0.002;
/// degrees: directions are written with one decimal.
constexpr double kDirectionTolerance = 0.051;
/// Of shares that are sums: a ten-thousandth is the last decimal, and overlaps of neighbours may add to it.
constexpr double kShareSlack = 0.001;
constexpr double kMinCovered = 0.95;  // of a cell that gives ratios by its area
constexpr double kOnGrid = 1e-6;      // m: corners of cells are whole numbers

template <class Names>
bool is_one_of(std::string_view text, const Names& names) {
  return std::find(std::begin(names), std::end(names), text) != std::end(names);
}
constexpr std::string_view kBlockKinds[] = {"ordinary", "between_carriageways", "between_tracks", "street_space",
                                            "water"};

bool is_wall_segment_kind(std::string_view text) {
  for (int k = 0; k < model::kWallSegmentKindCount; ++k)
    if (model::name(static_cast<model::WallSegmentKind>(k)) == text) return true;
  return false;
}
bool is_position(std::string_view text) {
  for (int k = 0; k < model::kBuildingPositionCount; ++k)
    if (model::name(static_cast<model::BuildingPosition>(k)) == text) return true;
  return false;
}

std::vector<std::string_view> words(std::string_view text) {
  std::vector<std::string_view> out;
  while (!text.empty()) {
    const std::size_t end = text.find(' ');
    out.push_back(text.substr(0, end));
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
  }
  return out;
}

/// Reads columns by name, in the order of `names`, and tells what is no value of its kind.
class Fields {
 public:
  Fields(const SqliteRow& row, const std::vector<std::string>& names) : row_(row), names_(names) {}
  std::vector<std::string> errors;

  int at(std::string_view name) const {
    return static_cast<int>(std::find(names_.begin(), names_.end(), name) - names_.begin());
  }
  bool null(std::string_view name) const { return row_.null(at(name)); }
  std::string_view text(std::string_view name) const { return row_.text(at(name)); }
  double real(std::string_view name) const { return row_.real(at(name)); }
  std::int64_t integer(std::string_view name) const { return row_.integer(at(name)); }

  void error(std::string what) { errors.push_back(std::move(what)); }
  void number(std::string_view name, double least, double most, bool may_be_null = true) {
    const int i = at(name);
    if (row_.null(i) && may_be_null) return;
    if (!row_.is_real(i) || !(row_.real(i) >= least) || !(row_.real(i) <= most))
      error(fmt::format("{} \"{}\" is no number from {} to {}", name, row_.text(i), least, most));
  }
  void count(std::string_view name, std::int64_t most = INT64_MAX, bool may_be_null = false) {
    const int i = at(name);
    if (row_.null(i) && may_be_null) return;
    if (!row_.is_integer(i) || row_.integer(i) < 0 || row_.integer(i) > most)
      error(most == 1 ? fmt::format("{} \"{}\" is neither 0 nor 1", name, row_.text(i))
                      : fmt::format("{} \"{}\" is no count", name, row_.text(i)));
  }
  void flag(std::string_view name) { count(name, 1); }
  void object(std::string_view name) {
    if (!null(name) && !is_osm_id(text(name))) error(fmt::format("{} \"{}\" is no id", name, text(name)));
  }

 private:
  const SqliteRow& row_;
  const std::vector<std::string>& names_;
};

class ContextRules {
 public:
  using State = GeoPackageReader::State;
  ContextRules(State& s, FindingLog& log) : s_(s), log_(log), srs_id_(s.srs_id()) {}

  void run() {
    blocks();
    courtyards();
    buildings();
    wall_segments();
    cells();
  }

 private:
  void rule(std::string_view object, std::string detail) {
    log_.add(Check::geopackage_rule, s_.name, std::string(object), std::move(detail));
  }

  /// Calls `look(fields, geometry)` for each row of `table`; columns `id`, then `names`. Geometries that cannot be read
  /// are told elsewhere; `look` gets them empty.
  template <class F>
  void each(std::string_view table, WkbType type, const F& look) {
    std::vector<std::string> names = context_columns(table);
    if (table == "buildings") names.insert(names.begin(), "id");
    std::string sql = "SELECT ";
    for (const std::string& name : names) sql += '"' + name + "\", ";
    const int geometry = static_cast<int>(names.size());
    const bool done = s_.db.each(fmt::format("{}geom FROM \"{}\" ORDER BY fid", sql, table), [&](const SqliteRow& row) {
      Fields fields(row, names);
      look(fields, type == WkbType::multi_polygon ? GeoPackageGeometry()
                                                  : read_geopackage_geometry(row.text(geometry), type, srs_id_));
      for (std::string& error : fields.errors) rule(fields.text("id"), fmt::format("layer {}: {}", table, error));
    });
    if (!done) rule(table, s_.db.error());
  }

  static void check_area(Fields& f, const GeoPackageGeometry& g) {
    if (g.polygons.empty()) return;
    const double found = area_of(g.polygons);
    // Areas of blocks were summed in another order than here.
    if (!(std::fabs(f.real("area") - found) <= area_tolerance(found) + 1e-9 * std::fabs(found)))
      f.error(fmt::format("area is {}, its polygon has {:.3f}", f.text("area"), found));
  }

  void blocks() {
    each("blocks", WkbType::polygon, [&](Fields& f, const GeoPackageGeometry& g) {
      blocks_.emplace(f.text("id"));
      check_area(f, g);
      if (!is_one_of(f.text("kind"), kBlockKinds)) f.error(fmt::format("kind \"{}\" is unknown", f.text("kind")));
      f.flag("cut_by_extract_edge");
      f.flag("too_large");
      f.count("buildings");
      f.count("courtyards");
      for (const char* share : {"built_share", "tagged_share", "closure"}) f.number(share, 0, 1 + kShareSlack);
      f.number("floor_area_ratio", 0, 1000);
      f.number("front_length", 0, 1e7);
      f.number("courtyard_area", 0, f.real("area") * (1 + kShareSlack) + kShareSlack);
      const bool whole =
          f.text("kind") == "ordinary" && f.integer("cut_by_extract_edge") == 0 && f.integer("too_large") == 0;
      for (const char* ratio : {"built_share", "tagged_share", "floor_area_ratio", "closure"})
        if (!whole && !f.null(ratio)) f.error(fmt::format("{} of a block that gives no ratios", ratio));
    });
  }

  void courtyards() {
    each("courtyards", WkbType::polygon, [&](Fields& f, const GeoPackageGeometry& g) {
      courtyards_.emplace(f.text("id"));
      check_area(f, g);
      f.flag("closed");
      f.number("opening", 0, 1e6, false);
      if (f.integer("closed") == 1 && f.real("opening") > 0) f.error("closed, with an opening");
      if (!f.null("block") && !blocks_.contains(std::string(f.text("block"))))
        f.error(fmt::format("its block {} is not in the layer blocks", f.text("block")));
      const auto ids = words(f.text("building_ids"));
      if (ids.empty() || f.integer("buildings") != static_cast<std::int64_t>(ids.size()))
        f.error(fmt::format("{} buildings around it, {} ids", f.text("buildings"), ids.size()));
      for (const std::string_view id : ids)
        if (!is_osm_id(id)) f.error(fmt::format("building_ids \"{}\" is no list of ids", f.text("building_ids")));
    });
  }

  void buildings() {
    each("buildings", WkbType::multi_polygon, [&](Fields& f, const GeoPackageGeometry&) {
      style(f);
      if (!is_position(f.text("position"))) f.error(fmt::format("position \"{}\" is unknown", f.text("position")));
      for (const char* direction : {"front_orientation", "squared_direction"}) f.number(direction, 0, 360);
      for (const char* length : {"depth", "width", "setback", "party_wall_length"}) f.number(length, 0, 1e6);
      if (!f.null("block") && !blocks_.contains(std::string(f.text("block"))))
        f.error(fmt::format("its block {} is not in the layer blocks", f.text("block")));
      for (const std::string_view id : words(f.text("courtyards")))
        if (!courtyards_.contains(std::string(id)))
          f.error(fmt::format("its courtyard {} is not in the layer courtyards", id));
      for (const char* number : {"moved", "shared_walls", "gaps_closed", "overlaps_resolved"})
        f.count(number, INT64_MAX, true);
      for (const char* measure : {"mean_shift", "max_shift", "mapped_area", "overlap_left"}) f.number(measure, 0, 1e12);
      if (f.real("mean_shift") > f.real("max_shift"))
        f.error(fmt::format("mean_shift {} is more than max_shift {}", f.text("mean_shift"), f.text("max_shift")));
      if (f.integer("gaps_closed") > f.integer("shared_walls"))
        f.error(fmt::format("{} gaps closed, but {} shared walls", f.text("gaps_closed"), f.text("shared_walls")));
    });
  }

  /// What classification says: all of it or nothing.
  static void style(Fields& f) {
    constexpr const char* kProbabilities[] = {"p_gruenderzeit", "p_tenement", "p_modern", "p_other"};
    f.number("style_p", 0, 1);
    double sum = 0, most = 0;
    std::size_t nulls = f.null("style_p") + f.null("morphology");
    for (const char* p : kProbabilities) {
      f.number(p, 0, 1);
      nulls += f.null(p);
      sum += f.real(p);
      most = std::max(most, f.real(p));
    }
    if (nulls == std::size(kProbabilities) + 2) return;
    if (nulls > 0) return f.error("some probabilities of its style are missing");
    if (!(std::fabs(sum - 1) <= kShareSlack)) f.error(fmt::format("the probabilities of its style sum to {:.4f}", sum));
    if (f.real("style_p") != most)
      f.error(fmt::format("style_p is {}, the likeliest class has {}", f.text("style_p"), base::shortest(most)));
    if (!is_one_of(f.text("morphology"), model::kMorphologyNames))
      f.error(fmt::format("morphology \"{}\" is unknown", f.text("morphology")));
  }

  // ---- edges: building by building, against its footprint

  struct Outline {
    std::string building;
    std::vector<ReadPolygon> footprint;
    std::set<std::string> ids;
    double perimeter = 0, length = 0;
    std::size_t rows = 0;
  };

  void wall_segments() {
    std::vector<std::string> names = context_columns("facade_edges");
    std::string sql = "SELECT ";
    for (const std::string& name : names) sql += "e.\"" + name + "\", ";
    const int geometry = static_cast<int>(names.size());
    std::unordered_set<std::string> seen;
    Outline outline;
    const bool done =
        s_.db.each(sql + "e.geom, b.geom FROM facade_edges e LEFT JOIN buildings b ON b.id = e.building ORDER BY e.fid",
                   [&](const SqliteRow& row) {
                     Fields f(row, names);
                     const std::string_view building = f.text("building");
                     if (building != outline.building) {
                       finish(outline);
                       begin(outline, building, row, geometry + 1);
                       if (!seen.insert(outline.building).second)
                         rule(building, "its rows of facade_edges do not stand together");
                     }
                     edge(f, read_geopackage_geometry(row.text(geometry), WkbType::line_string, srs_id_), outline);
                     for (std::string& error : f.errors) rule(f.text("id"), "layer facade_edges: " + error);
                   });
    finish(outline);
    if (!done) rule("facade_edges", s_.db.error());
  }

  void begin(Outline& outline, std::string_view building, const SqliteRow& row, int geometry) {
    outline = {};
    outline.building = building;
    if (row.null(geometry)) {
      rule(building, "rows of facade_edges belong to it, and the layer buildings has it not");
      return;
    }
    outline.footprint = read_geopackage_geometry(row.text(geometry), WkbType::multi_polygon, srs_id_).polygons;
    for_each_wall(outline, [&](Point2 a, Point2 b) { outline.perimeter += std::hypot(b.x - a.x, b.y - a.y); });
  }

  void finish(const Outline& outline) {
    if (outline.footprint.empty()) return;
    const double tolerance = kLengthTolerance * static_cast<double>(outline.rows + 1);
    if (!(std::fabs(outline.length - outline.perimeter) <= tolerance))
      rule(outline.building, fmt::format("its rows of facade_edges are {:.3f} m long together, its outline {:.3f} m",
                                         outline.length, outline.perimeter));
  }

  template <class F>
  static void for_each_wall(const Outline& outline, const F& f) {
    for (const ReadPolygon& polygon : outline.footprint)
      for (const auto& ring : polygon.rings)
        for (std::size_t i = 0; i < ring.size(); ++i) f(ring[i].xy(), ring[(i + 1) % ring.size()].xy());
  }

  void edge(Fields& f, const GeoPackageGeometry& g, Outline& outline) {
    ++outline.rows;
    const std::string id(f.text("id"));
    if (!outline.ids.insert(id).second)
      log_.add(Check::object_doubled, s_.name, id, "stands twice in the layer facade_edges");
    if (!id.starts_with(outline.building + ".e")) f.error("the id does not begin with that of its building");
    const std::string_view kind = f.text("kind");
    if (!is_wall_segment_kind(kind)) f.error(fmt::format("kind \"{}\" is unknown", kind));
    f.number("confidence", 0, 1, false);
    f.number("visibility", 0, 1, false);
    f.number("orientation", 0, 360, false);
    f.number("street_angle", 0, 90);
    f.number("street_distance", 0, 1e5);
    f.number("covered_height", 0, 2000);
    f.number("arc_radius", 0, 1e6);
    for (const char* flag : {"front", "corner_start", "corner_end", "chamfer"}) f.flag(flag);
    f.count("entrances");
    f.count("trees");
    points_on_walls(f);
    f.object("neighbour");
    f.object("street");
    if (kind != "party_wall" && (!f.null("neighbour") || !f.null("covered_height")))
      f.error(fmt::format("a neighbour behind a wall of kind {}", kind));
    if (f.text("neighbour") == outline.building) f.error("it is its own neighbour");
    if (f.null("street") != f.null("street_distance")) f.error("a street without distance, or a distance to none");
    if (f.null("arc_radius") != f.null("arc_bulge")) f.error("a curve without radius or bulge");
    if (!f.null("arc_bulge") && f.text("arc_bulge") != "outward" && f.text("arc_bulge") != "inward")
      f.error(fmt::format("arc_bulge \"{}\" is unknown", f.text("arc_bulge")));
    outline.length += f.real("length");
    if (g.line.size() != 2 || !g.errors.empty()) {
      if (g.errors.empty()) f.error(fmt::format("a line of {} points", g.line.size()));
      return;
    }
    const Point2 from = g.line[0], to = g.line[1];
    if (from != model::snap(from) || to != model::snap(to))
      log_.add(Check::off_grid, s_.name, id, "an end of the stretch is not on the grid");
    const double length = std::hypot(to.x - from.x, to.y - from.y);
    if (!(std::fabs(f.real("length") - length) <= kLengthTolerance))
      f.error(fmt::format("length is {}, its line has {:.3f}", f.text("length"), length));
    double looks = std::atan2(to.y - from.y, from.x - to.x) * (180 / 3.14159265358979323846);
    const double turn = std::fabs(std::remainder(f.real("orientation") - looks, 360));
    if (!(turn <= kDirectionTolerance))
      f.error(fmt::format("orientation is {}, its line looks to {:.1f}", f.text("orientation"),
                          looks < 0 ? looks + 360 : looks));
    if (!outline.footprint.empty() && !lies_on(outline, from, to)) f.error("the stretch is no piece of the outline");
  }

  /// Entrances and addresses: each at one stretch of one building.
  void points_on_walls(Fields& f) {
    const auto ids = words(f.text("points"));
    if (f.integer("entrances") > static_cast<std::int64_t>(ids.size()))
      f.error(fmt::format("{} entrances among {} points", f.text("entrances"), ids.size()));
    if (ids.empty() && !f.null("house_numbers")) f.error("house numbers without a point that has them");
    for (const std::string_view id : ids) {
      if (!is_osm_id(id) || id.front() != 'n')
        f.error(fmt::format("points \"{}\" is no list of nodes", f.text("points")));
      if (!points_.emplace(id).second) f.error(fmt::format("its point {} stands at another stretch, too", id));
    }
  }

  static bool lies_on(const Outline& outline, Point2 from, Point2 to) {
    bool found = false;
    for_each_wall(outline, [&](Point2 a, Point2 b) {
      if (found) return;
      const double dx = b.x - a.x, dy = b.y - a.y, length = std::hypot(dx, dy);
      const auto near = [&](Point2 p) {
        const double along = ((p.x - a.x) * dx + (p.y - a.y) * dy) / length;
        const double across = ((p.y - a.y) * dx - (p.x - a.x) * dy) / length;
        return std::fabs(across) <= kOnOutline && along >= -kOnOutline && along <= length + kOnOutline;
      };
      found = length > 0 && (to.x - from.x) * dx + (to.y - from.y) * dy > 0 && near(from) && near(to);
    });
    return found;
  }

  void cells() {
    each("cells", WkbType::polygon, [&](Fields& f, const GeoPackageGeometry& g) {
      f.number("size", 1, 1e5, false);
      f.count("buildings");
      f.number("covered_share", 0, 1, false);
      f.number("density", 0, 1e6);
      f.number("built_share", 0, 1e4);  // a large building may reach out of its cell
      for (const char* ratio : {"density", "built_share", "floor_area_ratio"})
        if (f.real("covered_share") < kMinCovered && !f.null(ratio))
          f.error(fmt::format("{} of a cell that the data does not cover", ratio));
      for (const char* share : {"tagged_share", "dated_share"}) f.number(share, 0, 1, false);
      f.number("party_wall_share", 0, 1);
      for (const char* value : {"storeys_mean", "storeys_spread", "floor_area_ratio", "year_mean", "year_spread",
                                "footprint_quartile", "footprint_median", "footprint_upper_quartile"})
        f.number(value, 0, 1e7);
      if (f.integer("buildings") <= 0) f.error("a cell without buildings");
      if (!(f.real("footprint_quartile") <= f.real("footprint_median") &&
            f.real("footprint_median") <= f.real("footprint_upper_quartile")))
        f.error("its quartiles of footprints are not in order");
      if (g.polygons.empty()) return;
      const double size = f.real("size"), x = std::nearbyint(g.min_x / size), y = std::nearbyint(g.min_y / size);
      const double off = std::max({std::fabs(g.min_x - x * size), std::fabs(g.min_y - y * size),
                                   std::fabs(g.max_x - (x + 1) * size), std::fabs(g.max_y - (y + 1) * size)});
      if (!(off <= kOnGrid) || g.polygons[0].rings.size() != 1 || g.polygons[0].rings[0].size() != 4)
        f.error(fmt::format("it is no square of {} m on the grid", f.text("size")));
      if (const std::string name = fmt::format("c{:.0f}_{:.0f}", x, y); f.text("id") != name)
        f.error("the id does not fit its place, which is " + name);
    });
  }

  State& s_;
  FindingLog& log_;
  std::int64_t srs_id_;
  std::unordered_set<std::string> blocks_, courtyards_, points_;
};

}  // namespace

std::vector<std::string> context_columns(std::string_view table) {
  if (table == "buildings")
    return {"style_p",      "p_gruenderzeit",    "p_tenement",
            "p_modern",     "p_other",           "morphology",
            "position",     "front_orientation", "depth",
            "width",        "setback",           "party_wall_length",
            "block",        "courtyards",        "moved",
            "mean_shift",   "max_shift",         "mapped_area",
            "shared_walls", "gaps_closed",       "overlaps_resolved",
            "overlap_left", "squared_direction"};
  if (table == "facade_edges")
    return {
        "id",         "building",       "kind",       "confidence",  "length",       "orientation",     "front",
        "neighbour",  "covered_height", "street",     "street_name", "street_class", "street_distance", "street_angle",
        "visibility", "corner_start",   "corner_end", "chamfer",     "entrances",    "house_numbers",   "points",
        "trees",      "arc_radius",     "arc_bulge",  "from_node",   "to_node"};
  if (table == "blocks")
    return {"id",
            "kind",
            "area",
            "cut_by_extract_edge",
            "too_large",
            "buildings",
            "built_share",
            "tagged_share",
            "floor_area_ratio",
            "closure",
            "front_length",
            "courtyard_area",
            "courtyards",
            "streets"};
  if (table == "courtyards") return {"id", "block", "area", "closed", "opening", "buildings", "building_ids"};
  if (table == "cells")
    return {"id",
            "size",
            "buildings",
            "density",
            "built_share",
            "tagged_share",
            "covered_share",
            "storeys_mean",
            "storeys_spread",
            "floor_area_ratio",
            "party_wall_share",
            "dated_share",
            "year_mean",
            "year_spread",
            "footprint_quartile",
            "footprint_median",
            "footprint_upper_quartile"};
  return {};
}

void check_context(GeoPackageReader::State& state, FindingLog& log) { ContextRules(state, log).run(); }

}  // namespace blockrand::validate
